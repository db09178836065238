#include "core/pipeline/check/check_session.h"

#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/nearest_name.h"
#include "core/data/quantity.h"
#include "core/geometry/intrinsics_numbers.h"
#include "core/pipeline/compare/compared_quantities.h"
#include "core/pipeline/runs/saved_run.h"
#include "core/pipeline/session/check_options.h"
#include "core/pipeline/session/session_keys.h"
#include "core/pipeline/session/session_of_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace evical {
namespace {

NamedResult resultIn(const std::filesystem::path& path) {
  NamedResult before = readOldResult(path, "checked");
  if (before.result->state.cameras.empty())
    throw badInput(resultFileOf(path).string(), "has no cameras", "Give the result of a calibration");
  return before;
}

std::vector<std::string> namesOf(const std::vector<SensorDescription>& sensors) {
  std::vector<std::string> names;
  for (const SensorDescription& sensor : sensors) names.push_back(sensor.name);
  return names;
}

template <class Sensors>
void checkSensors(const Sensors& sensors, const std::vector<SensorDescription>& known, const char* what,
                  CheckInput& input) {
  const std::vector<std::string> names = namesOf(known);
  std::set<std::string> seen;
  for (const auto& sensor : sensors) {
    seen.insert(sensor.name);
    if (std::find(names.begin(), names.end(), sensor.name) == names.end())
      throw badInput(
          input.session.source.string(),
          fmt::format("the {} '{}' is not in the old result: it is of another rig, or the sensor has "
                      "another name there",
                      what, sensor.name),
          names.empty() ? fmt::format("The old result has no {}s", what) : nameAdvice(sensor.name, names));
  }
  for (const std::string& name : names)
    if (!seen.contains(name))
      input.notes.push_back(
          fmt::format("the {} '{}' of the old result is not in the session: it is not checked", what, name));
}

// What was weighed then would pull both results to one value, and hide a change; what is given stays given.
template <class Rows, class Prior>
void dropWeighed(const Rows& rows, Prior& prior) {
  forEachPriorQuantity(rows, [&](const auto& row) {
    auto& known = row.prior(prior);
    if (known && !known->isGiven()) known.reset();
  });
}

// The recording is seen through the lens as it was, so that what has changed of it shows.
void setLens(const CameraState& before, SessionCamera& camera, CheckInput& input) {
  const std::optional<CameraIntrinsics>& lens = before.lens.inUse();
  if (!lens)
    throw badInput("cameras." + camera.name, "the old result does not say what its lens is",
                   "Calibrate again: the result is of an older version, or was shortened");
  if (camera.resolution_px.known() && camera.resolution_px != lens->resolution_px)
    throw badInput(input.session.source.string() + ": cameras." + camera.name,
                   fmt::format("has an image of {}, in the old result it has {}",
                               sizeText(camera.resolution_px), sizeText(lens->resolution_px)),
                   "Check a camera in the mode that it was calibrated in");
  if (camera.intrinsics && camera.intrinsics->model != lens->model)
    input.notes.push_back(fmt::format(
        "the session gives {} a lens of another kind ({}) than the old result has ({}), which is taken",
        camera.name, cameraModelTitle(camera.intrinsics->model), cameraModelTitle(lens->model)));
  camera.intrinsics = lens;
  camera.resolution_px = lens->resolution_px;
  camera.intrinsics_uncertainty.reset();
}

Session sessionFor(const CheckPaths& paths) {
  if (isSessionFile(paths.recording)) return readSession(paths.recording);
  if (!isThere(paths.recording))
    throw badInput(paths.recording.string(), "is not there", "Give the new recording, or a session of it");
  Session session;
  if (!paths.session.empty()) {
    session = readSessionOfRun(paths.session);
  } else {
    std::optional<Session> kept = sessionOfOldResult(paths.result);
    if (!kept)
      throw badInput(paths.result.string(),
                     "there is no run_session.yaml beside it, which says board and sensors",
                     "Give the session of the new recording by --session");
    session = std::move(*kept);
  }
  setRecording(paths.recording, session);
  return session;
}

bool isSameBoard(const std::filesystem::path& result, const Session& session) {
  try {
    const std::optional<Session> kept = sessionOfOldResult(result);
    return kept && kept->board == session.board;
  } catch (const CalibrationError&) {
    return false;  // which nobody asked for
  }
}

// Where the old result has a sigma: what was given then is given by the session now.
template <class Known, class Value, class Sigma>
void weigh(const Value& value, const Sigma& sigma, const Sigma& stability, std::optional<Known>& prior) {
  if (isGiven(prior)) return;
  if constexpr (std::is_same_v<Sigma, double>) {
    if (sigma > 0.0) prior = Known{value, std::hypot(sigma, stability)};
  } else {
    constexpr double kLeast = 1e-12;  // a sigma of 0 would be none
    if ((sigma.array() > 0.0).any())
      prior = Known{value, Sigma((sigma.array().square() + stability.array().square()).sqrt().max(kLeast))};
  }
}

struct Stability {
  Eigen::Vector3d rotation_rad, translation_m;
  double time_offset_s;
  Eigen::Matrix3d mapping;

  explicit Stability(const CheckOptions& options)
      : rotation_rad(Eigen::Vector3d::Constant(kRadPerDeg * options.stability_rotation_deg)),
        translation_m(Eigen::Vector3d::Constant(1e-3 * options.stability_translation_mm)),
        time_offset_s(1e-3 * options.stability_time_offset_ms),
        mapping(Eigen::Matrix3d::Constant(options.stability_imu_scale).triangularView<Eigen::Upper>()) {}
};

template <class Uncertainty>
void weighPlace(const RigidTransform& pose, double time_offset_s, const Uncertainty& sigma,
                const Stability& stability, SensorPrior& prior) {
  weigh(pose.rotation, sigma.rotation_std_rad, stability.rotation_rad, prior.rotation);
  weigh(pose.translation_m, sigma.translation_std_m, stability.translation_m, prior.translation);
  weigh(time_offset_s, sigma.time_offset_std_s, stability.time_offset_s, prior.time_offset);
}

// With its whole covariance: focal length and distortion err together.
void weighLens(const NamedResult& before, const std::string& camera, double stability_px,
               SessionCamera& session_camera) {
  const UncertaintyReport& report = before.result->uncertainty;
  const auto first = std::find(report.names.begin(), report.names.end(), camera + ".focal_length.x [px]");
  if (first == report.names.end()) return;
  const Eigen::Index begin = first - report.names.begin();
  Eigen::Index count = 4;
  while (count < kIntrinsicsCount && begin + count < static_cast<Eigen::Index>(report.names.size()) &&
         report.names[static_cast<std::size_t>(begin + count)].starts_with(camera + ".distortion."))
    ++count;
  const auto sigmas = report.standard_deviations.segment(begin, count).asDiagonal();
  const Eigen::MatrixXd covariance = sigmas * report.correlation.block(begin, begin, count, count) * sigmas +
                                     lensCovariance(*session_camera.intrinsics, count, stability_px);
  const Eigen::VectorXd std = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  LensUncertainty& uncertainty = session_camera.intrinsics_uncertainty.emplace();
  uncertainty.std.head(count) = std;
  IntrinsicsMatrix& correlation = uncertainty.correlation.emplace(IntrinsicsMatrix::Identity());
  correlation.topLeftCorner(count, count) =
      std.cwiseInverse().asDiagonal() * covariance * std.cwiseInverse().asDiagonal();
}

}  // namespace

CheckInput checkInputOf(NamedResult before, Session session) {
  CheckInput input{std::move(before), std::move(session), true, {}, {}};
  if (input.session.reference != input.before.reference)
    throw badInput(input.session.source.string() + ": reference",
                   fmt::format("is '{}', that of the old result is '{}'", input.session.reference,
                               input.before.reference),
                   "Use the old result's reference: poses are relative to it");
  checkSensors(input.session.cameras, input.before.cameras, "camera", input);
  checkSensors(input.session.imus, input.before.imus, "IMU", input);
  const std::vector<std::string> names = namesOf(input.before.cameras);
  for (SessionImu& imu : input.session.imus) dropWeighed(kImuQuantities, imu.prior);
  for (SessionCamera& camera : input.session.cameras) {
    dropWeighed(kCameraQuantities, camera.prior);
    if (!camera.same_sensor_as.empty()) continue;  // whose lens is that one's
    const auto k = std::find(names.begin(), names.end(), camera.name) - names.begin();
    setLens(input.before.result->state.cameras.at(static_cast<std::size_t>(k)), camera, input);
  }
  if (input.before.result->status == CalibrationStatus::Doubtful)
    input.notes.push_back("the old calibration was doubtful itself: " + input.before.result->reason);
  return input;
}

namespace {

CheckInput checkInputIn(const std::filesystem::path& result, NamedResult before, Session session) {
  CheckInput input = checkInputOf(std::move(before), std::move(session));
  input.same_board = isSameBoard(result, input.session);
  input.before_name = result.string();
  return input;
}

}  // namespace

CheckInput readCheckInput(const CheckPaths& paths) {
  NamedResult before = resultIn(paths.result);
  return checkInputIn(paths.result, std::move(before), sessionFor(paths));
}

CheckInput readCheckInput(const std::filesystem::path& result, Session session) {
  return checkInputIn(result, resultIn(result), std::move(session));
}

Session withPriorOf(const NamedResult& before, Session session) {
  const Stability stability(*session.options.check);
  const CalibrationState& state = before.result->state;
  const UncertaintyReport& sigmas = before.result->uncertainty;
  for (std::size_t k = 0; k < before.cameras.size(); ++k)
    for (SessionCamera& camera : session.cameras) {
      if (camera.name != before.cameras[k].name) continue;
      weighLens(before, camera.name, session.options.check->stability_lens_px, camera);
      if (camera.name == session.reference || !camera.same_sensor_as.empty()) continue;
      weighPlace(state.cameras[k].reference_from_camera, state.cameras[k].time_offset_s, sigmas.cameras[k],
                 stability, camera.prior);
    }
  for (std::size_t k = 0; k < before.imus.size(); ++k)
    for (SessionImu& imu : session.imus) {
      if (imu.name != before.imus[k].name) continue;
      const ImuState& was = state.imus[k];
      const ImuUncertainty& sigma = sigmas.imus[k];
      weigh(was.gyroscope_mapping, sigma.gyroscope_mapping_std, stability.mapping,
            imu.prior.gyroscope_mapping);
      weigh(was.accelerometer_mapping, sigma.accelerometer_mapping_std, stability.mapping,
            imu.prior.accelerometer_mapping);
      weigh(was.accelerometer_delay_s, sigma.accelerometer_delay_std_s, stability.time_offset_s,
            imu.prior.accelerometer_delay);
      weigh(was.gyroscope_from_accelerometer, sigma.gyroscope_rotation_std_rad, stability.rotation_rad,
            imu.prior.gyroscope_rotation);
      if (imu.name != session.reference)
        weighPlace(was.reference_from_imu, was.time_offset_s, sigma, stability, imu.prior);
    }
  return session;
}

}  // namespace evical
