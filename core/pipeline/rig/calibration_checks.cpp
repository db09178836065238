#include "core/pipeline/rig/calibration_checks.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/base/time.h"
#include "core/data/quality_warning.h"
#include "core/frontend/detection_options.h"
#include "core/initialisation/agreement_check.h"
#include "core/initialisation/initialisation_options.h"
#include "core/numerics/robust.h"
#include "core/pipeline/detection/board_size_check.h"
#include "core/pipeline/detection/camera_views.h"
#include "core/pipeline/detection/view_rejection.h"
#include "core/pipeline/rig/detected_recording.h"
#include "core/pipeline/rig/wrong_inputs.h"
#include "core/recording/inspection.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace evical {
namespace {

// Gravity in the rates: most of their norms are near it, and the accelerations' is not.
void checkNotExchanged(const ImuData& imu, double force_norm, const InitialisationOptions& options) {
  if (force_norm > options.exchanged_force_share * options.gravity_m_s2) return;
  std::vector<double> deviations;
  for (const ImuSample& sample : imu.samples)
    if (measuresRate(sample))
      deviations.push_back(std::abs(sample.angular_rate_rad_s.norm() / options.gravity_m_s2 - 1.0));
  if (deviations.empty() || medianOf(std::move(deviations)) >= options.gravity_rate_tolerance) return;
  throw badInput(
      imu.name,
      fmt::format("the angular rates have the norm of gravity, and the accelerations one of {:.2g}: the "
                  "columns or streams of gyroscope and accelerometer seem to be exchanged",
                  force_norm),
      "Exchange them in the session, or in the file's header");
}

// Checks units: of accelerations by their median norm, with bounds that allow shaking at several g; of
// angular rates only by implausible values.
void checkUnits(const ImuData& imu, const SessionImu* session, const InitialisationOptions& options) {
  std::vector<double> norms;
  double rate2 = 0.0;
  for (const ImuSample& sample : imu.samples) {
    norms.push_back(sample.specific_force_m_s2.norm());
    rate2 += sample.angular_rate_rad_s.squaredNorm();
  }
  const double norm = medianOf(std::move(norms));
  checkNotExchanged(imu, norm, options);
  if (norm < options.min_acceleration_m_s2 || norm > options.max_acceleration_m_s2) {
    const LikelyUnit unit =
        likelyUnitOfForces(session, norm / options.gravity_m_s2, 2.0 * options.force_unit_tolerance);
    throw badInput(
        imu.name,
        fmt::format("the median norm of the accelerations is {:.3g} m/s^2 instead of about 9.81{}{}", norm,
                    unit.words.empty() ? "" : ": the unit seems to be ", unit.words),
        !unit.words.empty() ? fmt::format("Set acceleration_unit: {} for this IMU", unit.setting)
        : norm < options.min_acceleration_m_s2 ? "Record accelerations with gravity (not linear or user "
                                                 "accelerations), or check acceleration_unit "
                                                 "(m/s^2, g, -g) of this IMU"
                                               : "Set acceleration_unit for this IMU: m/s^2, g, -g, or for "
                                                 "raw counts the size of a count as its "
                                                 "data sheet states it, such as 1/16384 g")
        .repairedBy(unit.only ? std::optional(Repair{"imus." + imu.name + ".acceleration_unit", unit.setting})
                              : std::nullopt);
  }
  const double rms = std::sqrt(rate2 / static_cast<double>(imu.samples.size()));
  if (rms > options.max_rotation_rate_rad_s) {
    throw badInput(imu.name,
                   fmt::format("the angular rates are {:.0f} rad/s RMS: the unit seems to be deg/s", rms),
                   "Set angular_rate_unit: deg/s for this IMU")
        .repairedBy(Repair{"imus." + imu.name + ".angular_rate_unit", "deg/s"});
  }
}

// Separate streams: they may be swapped, empty, or from different times.
void checkSeparateSensors(const ImuData& imu, const SessionImu& session) {
  const auto spanOf = [&](const std::string& stream, const char* sensor, auto measures,
                          Eigen::Vector3d ImuSample::*value) {
    std::optional<std::pair<std::int64_t, std::int64_t>> span_ns;
    for (const ImuSample& sample : imu.samples)
      if (measures(sample) && !(sample.*value).isZero(0.0))
        span_ns = {span_ns ? span_ns->first : sample.time_ns, sample.time_ns};
    if (!span_ns)
      throw badInput(imu.name, fmt::format("the stream {} has no measurements of the {}", stream, sensor),
                     "Check gyroscope: and accelerometer: in the session: they may be swapped");
    return *span_ns;
  };
  const auto rates =
      spanOf(session.stream, "gyroscope", measuresRate<ImuSample>, &ImuSample::angular_rate_rad_s);
  const auto forces = spanOf(session.accelerometer_stream, "accelerometer", measuresForce<ImuSample>,
                             &ImuSample::specific_force_m_s2);
  constexpr double kMinShared = 0.5;  // of the longer one's time
  const double shared_s =
      secondsSince(std::max(rates.first, forces.first), std::min(rates.second, forces.second));
  const double whole_s =
      std::max(secondsSince(rates.first, rates.second), secondsSince(forces.first, forces.second));
  if (shared_s < kMinShared * whole_s)
    throw badInput(imu.name,
                   fmt::format("{} and {} overlap for only {:.2f} s of {:.2f} s", session.stream,
                               session.accelerometer_stream, std::max(shared_s, 0.0), whole_s),
                   "Check the timestamps of the two streams, or set " + howTo(HowTo::LimitTime) +
                       " to a part in which both have samples");
}

// Detects drivers that publish both sensors separately and set the other sensor's values to 0.
void checkBothSensors(const ImuData& imu, const SessionImu& session) {
  if (!session.accelerometer_stream.empty()) return checkSeparateSensors(imu, session);
  const ImuStreamKind kind = imuStreamKind(imu.samples);
  if (kind == ImuStreamKind::Whole) return;
  const bool gyroscope = kind != ImuStreamKind::Accelerometer,
             accelerometer = kind != ImuStreamKind::Gyroscope;
  throw badInput(
      imu.name,
      gyroscope && accelerometer
          ? fmt::format(
                "each message of {} has either angular rates or accelerations, the other values are 0",
                session.stream)
          : fmt::format("the messages of {} have only {}, the other values are 0", session.stream,
                        gyroscope ? "angular rates" : "accelerations"),
      howTo(HowTo::NameSeparateStreams,
            {gyroscope ? session.stream : "STREAM", accelerometer ? session.stream : "STREAM"}));
}

double durationOf(const BoardObservations& camera) {
  return camera.windows.empty() ? 0.0 : camera.windows.back().time_s - camera.windows.front().time_s;
}
double durationOf(const ImuData& imu) {
  return imu.samples.empty() ? 0.0 : secondsSince(imu.samples.front().time_ns, imu.samples.back().time_ns);
}

void checkDuration(const Session& session, const DetectionResult& detections) {
  const double min_s = session.options.initialisation->min_overlap_s;
  const auto check = [&](const std::string& sensor, double duration_s) {
    if (duration_s >= min_s) return;
    throw withClockRate(
        calibrationFailed(
            sensor,
            fmt::format("the recording is too short: {:.2f} s, at least {:.2f} s are required{}", duration_s,
                        min_s, session.time_range_s ? " in " + howTo(HowTo::LimitTime) : ""),
            "Record at least 20 s of varied motion"),
        session, detections.cameras.front(), detections.imus);
  };
  for (const BoardObservations& camera : detections.cameras) check(camera.camera, durationOf(camera));
  for (const ImuData& imu : detections.imus) check(imu.name, durationOf(imu));
}

void logDetections(const DetectionResult& detections, const RunContext& context) {
  for (const BoardObservations& camera : detections.cameras) {
    const bool windows = camera.kind == CameraKind::Events;
    context.progress.log(LogLevel::Info,
                         fmt::format("{}: {} {}, board in {} of {} {} ({})", camera.camera, camera.events,
                                     measurementsOf(camera.kind), camera.views.size(), camera.windows.size(),
                                     windows ? "windows" : "frames", outcomes(camera)));
    if (const std::string rejected = rejectedSentence(camera); !rejected.empty())
      context.progress.log(LogLevel::Info, rejected);
  }
}

// A log that ends early, say: the reason why many views are not used.
void noteUncovered(const DetectionResult& detections, double min_coverage,
                   std::vector<RecordingFault>& faults) {
  for (const BoardObservations& camera : detections.cameras) {
    for (const ImuData& imu : detections.imus) {
      const double camera_s = durationOf(camera), imu_s = durationOf(imu);
      if (imu_s >= min_coverage * camera_s) continue;
      addUnlessListed(
          {imu.name, FaultKind::Part, imu_s,
           fmt::format("{}: its samples cover {:.1f} s, those of {} {:.1f} s: views beyond are not used",
                       imu.name, imu_s, camera.camera, camera_s)},
          faults);
    }
  }
}

}  // namespace

CalibrationError withClockRate(const CalibrationError& error, const Session& session,
                               const BoardObservations& seen, std::span<const ImuData> imus) {
  constexpr std::array kFactors = {2.0, 0.5, 1e3, 1e-3, 1e6, 1e-6};
  constexpr double kNear = 0.03;
  constexpr double kSlowestImu_hz = 10.0, kFastestImu_hz = 20'000.0;
  if (session.time_range_s) return error;
  const double camera_s = durationOf(seen);
  for (const ImuData& imu : imus) {
    const double imu_s = durationOf(imu), factor = camera_s / imu_s;
    if (!(camera_s > 0.0) || !(imu_s > 0.0)) continue;
    const auto found = std::find_if(kFactors.begin(), kFactors.end(),
                                    [&](double each) { return std::abs(factor / each - 1.0) < kNear; });
    if (found == kFactors.end()) continue;
    // An IMU with a usual sampling rate has the correct clock, except that a doubled clock looks usual, too.
    const double rate_hz = static_cast<double>(imu.samples.size()) / imu_s;
    const bool usual = rate_hz > kSlowestImu_hz && rate_hz < kFastestImu_hz && (*found > 2.0 || *found < 0.5);
    const std::string& camera = seen.camera;
    const std::string wrong = usual ? camera : imu.name;
    const std::string scale = fmt::format("{:g}", usual ? 1.0 / *found : *found);
    const double fast = usual ? *found : 1.0 / *found;
    const std::string key = fmt::format("{}.{}.clock_scale", usual ? "cameras" : "imus", wrong);
    return CalibrationError(error.kind(), error.place(),
                            fmt::format("{}; the times of {} span {:.3f} s and those of {} {:.3f} s, so the "
                                        "clock of {} may run {:g} times too {}",
                                        error.problem(), imu.name, imu_s, camera, camera_s, wrong,
                                        std::max(fast, 1.0 / fast), fast > 1.0 ? "fast" : "slow"),
                            fmt::format("If so, set {} to {}", key, scale))
        .repairedBy(Repair{key, scale});
  }
  return error;
}

void checkSession(const Session& session) {
  if (session.board_blinks)
    throw badInput(session.source.string() + ": board.blinking",
                   "a flashing board cannot determine time offsets: the flash times on the sensors' clocks "
                   "are unknown, and the camera must be almost at rest",
                   "Calibrate each camera's intrinsics " + howTo(HowTo::CalibrateLens) +
                       ", then move the sensors in front of a printed board");
  if (session.imus.empty() && session.cameras.size() == 1) {
    throw badInput(session.source.string() + ": imus", "the session has neither an IMU nor a second camera",
                   "Add an IMU or a second camera. To calibrate only the camera's intrinsics, calibrate it " +
                       howTo(HowTo::CalibrateLens));
  }
  for (std::size_t k = 0; session.cameras.size() > 1 && k < session.cameras.size(); ++k) {
    if (!session.boardOf(k).hasHalfTurnAmbiguity()) continue;
    throw badInput(
        session.source.string() + ": board",
        "the board looks the same when turned by 180 degrees, so the poses between cameras are ambiguous",
        "Use an asymmetric board with an odd number of rows. For intrinsics, calibrate each camera " +
            howTo(HowTo::CalibrateLens));
  }
}

void checkPass(const Session& session, const RunContext& context, DetectionResult& detections) {
  for (std::size_t k = 0; k < detections.imus.size(); ++k) {
    const ImuData& imu = detections.imus[k];
    if (k < session.imus.size()) checkBothSensors(imu, session.imus[k]);
    checkStampsApart(imu);
    checkAxesAlive(imu);
    checkUnits(imu, k < session.imus.size() ? &session.imus[k] : nullptr, *session.options.initialisation);
    for (const RecordingFault& fault : checkImu(imu.name, imu.samples))
      if (fault.kind != FaultKind::Encoding)
        addUnlessListed(fault, detections.faults);  // of stamps: named while reading
  }
  for (std::size_t k = 0; k < detections.cameras.size(); ++k) {
    const std::optional<RecordingFault> unseen = unseenCircles(detections.cameras[k], session.boardOf(k));
    if (unseen) addUnlessListed(*unseen, detections.faults);
  }
  noteUncovered(detections, session.options.initialisation->min_imu_coverage, detections.faults);
  for (const RecordingFault& fault : detections.faults) context.progress.log(LogLevel::Warning, fault.text);
  logDetections(detections, context);
  checkDuration(session, detections);
  for (std::size_t k = 0; k < detections.cameras.size(); ++k) {
    const BoardObservations& camera = detections.cameras[k];
    if (camera.views.empty())
      if (const std::optional<CalibrationError> blink = unexpectedBlink(session, k))
        throw CalibrationError(*blink);
    checkBoardSeen(camera, session.boardOf(k), detections.faults);
    checkBoardSize(camera, session.boardOf(k), session.options.front_end->extent);
  }
}

}  // namespace evical
