#include "core/pipeline/rig/recording_assessment.h"

#include "core/pipeline/rig/calibration_pipeline.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/initialisation/initialisation_options.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/numerics/angles.h"
#include "core/numerics/robust.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/optimisation_options.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "core/report/html/advice.h"
#include "core/report/html/measures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace evical {
namespace {

const char* const kStage = "assess";

// Thresholds that agree with the report's advice after a calibration. The user reads the good ones.
constexpr double kGood_s = 15.0;
constexpr double kGoodBoard = 0.6, kFairBoard = 0.3;         // of the windows
constexpr double kGoodCoverage = 0.6, kFairCoverage = 0.35;  // of the image
constexpr double kFairSpeed_px_s = 20.0;
constexpr double kFairSigma = 3.0;  // times the required sigma

constexpr double kGoodTurn_rad_s = 0.3, kFairTurn_rad_s = 0.1;                // RMS
constexpr double kGoodAcceleration_m_s2 = 0.3, kFairAcceleration_m_s2 = 0.1;  // the same
// Progress after each step.
constexpr double kUntilState = 0.3, kUntilBatch = 0.7;

// Options that stop early: sigmas change little on the last steps, and each step takes as long as the first.
// If the motion leaves directions unobservable, the first steps are not enough: large residuals make sigmas
// several times too large.
OptimisationOptions shortened(OptimisationOptions options) {
  constexpr double kNear_sigmas = 2.0, kNearInStage = 1e-3;
  options.stage_tolerance = std::max(options.stage_tolerance, kNearInStage);
  options.last_step_sigmas = std::max(options.last_step_sigmas, kNear_sigmas);
  options.threads = 1;  // runs in the background
  return options;
}

Light lightOf(double value, double good, double fair) {
  return value >= good ? Light::Good : value >= fair ? Light::Fair : Light::Poor;
}

class Assessor {
 public:
  // `no_lens`: why a lens that is not given could not be calibrated; circles are then in raw pixels.
  Assessor(const Session& session, const DetectedRecording& detected, const RunContext& context,
           const CalibrationError* no_lens = nullptr)
      : session_(session),
        pass_(detected.detections),
        detected_(detected),
        context_(context),
        no_lens_(no_lens) {}

  RecordingAssessment run() {
    context_.progress.stageStarted(kStage);
    assessDuration();
    const html::Measures measures = measured();
    for (std::size_t k = 0; k < pass_.cameras.size(); ++k)
      assessCamera(pass_.cameras[k], measures.cameras[k]);
    assessLenses();
    if (no_lens_ != nullptr) {
      assessAxes(nullptr);
      addObstacle(*no_lens_);
    } else if (isRig()) {
      assessRig();
    } else {
      result_.can_be_calibrated = result_.board_seen;
    }
    conclude();
    return std::move(result_);
  }

 private:
  void add(AssessedThing thing, const std::string& sensor, Light light, std::string measured,
           std::string required, const std::string& advice) {
    result_.all.push_back({thing, sensor, light, std::move(measured), std::move(required),
                           light == Light::Good ? std::string() : advice});
  }
  // If false, only the lens can be calibrated.
  bool isRig() const { return session_.imus.size() + session_.cameras.size() >= 2; }

  void assessRig() {
    std::optional<InitialisedCalibration> start;
    try {
      start = initialiseCalibration(session_, pass_, context_.unobserved(), detected_.intrinsics);
    } catch (const CalibrationError& error) {
      assessAxes(nullptr);
      addObstacle(error);
      return;
    }
    context_.progress.stageProgress(kUntilState);
    assessAxes(&start->initial.state);
    if (!start->initial.doubt.empty())
      add(AssessedThing::Obstacle, {}, Light::Fair, start->initial.doubt, {}, "Measure the board again.");
    try {
      expectSigmas(*start);
      result_.can_be_calibrated = true;
    } catch (const CalibrationError& error) {
      addObstacle(error);
    }
  }

  void assessDuration() {
    const double min_s = session_.options.initialisation->min_overlap_s;
    double duration_s = 0.0;
    for (const BoardObservations& camera : pass_.cameras)
      if (!camera.windows.empty())
        duration_s = std::max(duration_s, camera.windows.back().time_s - camera.windows.front().time_s);
    add(AssessedThing::Duration, {}, lightOf(duration_s, kGood_s, min_s), fmt::format("{:.1f} s", duration_s),
        fmt::format("{:g} s", kGood_s), "Record 20 to 30 s of varied motion.");
  }

  html::Measures measured() const {
    const NamedResult nothing_yet;
    ReportData data{nothing_yet, {}};
    for (std::size_t k = 0; k < session_.cameras.size(); ++k) data.boards.push_back(session_.seenBoard(k));
    data.cameras = pass_.cameras;
    data.lenses = pass_.lenses;
    data.resolutions_px = pass_.resolutions_px;
    return html::measure(data);
  }

  void assessCamera(const BoardObservations& camera, const html::CameraMeasures& measures) {
    add(AssessedThing::Board, camera.camera, lightOf(measures.detectionRate(), kGoodBoard, kFairBoard),
        fmt::format("{:.0f} % of {} {}", 100.0 * measures.detectionRate(), measures.windows,
                    camera.kind == CameraKind::Events ? "windows" : "frames"),
        fmt::format("{:.0f} %", 100.0 * kGoodBoard), html::remedyForMissed(measures));
    if (measures.views == 0) return;
    result_.board_seen = true;
    if (!measures.cells.empty()) {
      const std::string empty = html::emptyRegions(measures);
      add(AssessedThing::Coverage, camera.camera,
          lightOf(measures.coveredShare(), kGoodCoverage, kFairCoverage),
          fmt::format("{:.0f} % of the image", 100.0 * measures.coveredShare()),
          fmt::format("{:.0f} %", 100.0 * kGoodCoverage),
          empty.empty() ? "Move the board through the whole image, into its corners."
                        : "Move the board through the whole image. Hardly covered: " + empty + ".");
    }
    assessSpeed(camera);
  }

  // Event cameras only: frames need no speed.
  void assessSpeed(const BoardObservations& camera) {
    if (camera.kind != CameraKind::Events) return;
    std::vector<double> speeds_px_s;
    for (const BoardView& view : camera.views)
      for (const CircleObservation& circle : view.circles) speeds_px_s.push_back(circle.velocity_px_s.norm());
    const double speed_px_s = medianOf(std::move(speeds_px_s));
    const bool fast = speed_px_s > kFastSpeed_px_s;
    add(AssessedThing::Speed, camera.camera,
        fast ? Light::Fair : lightOf(speed_px_s, kGoodSpeed_px_s, kFairSpeed_px_s),
        fmt::format("{:.0f} px/s", speed_px_s),
        fmt::format("{:g} to {:g} px/s", kGoodSpeed_px_s, kFastSpeed_px_s),
        fast ? "Move more slowly: the board should cross the image in one or two seconds."
             : "Move faster: the board should cross the image in one or two seconds.");
  }

  void assessLenses() {
    for (std::size_t k = 0; k < detected_.intrinsics.size(); ++k) {
      const std::optional<IntrinsicsResult>& found = detected_.intrinsics[k];
      if (!found) continue;
      std::string advice = found->reason;
      for (const std::string& each : found->advice) advice += (advice.empty() ? "" : ". ") + each;
      add(AssessedThing::Lens, session_.cameras[k].name,
          found->status == CalibrationStatus::Ok ? Light::Good : Light::Fair,
          fmt::format("projection sigma {:.2g} px", found->image.rms_px),
          fmt::format("{:g} px", session_.options.intrinsics->needed_projection_px), advice);
    }
  }

  void assessAxes(const CalibrationState* state) {
    if (pass_.imus.empty() || pass_.imus[session_.referenceImu()].samples.empty()) return;
    const ImuData& imu = pass_.imus[session_.referenceImu()];
    const AssessedMotion motion = assessMotion(imu, pass_.start_ns, state);
    static constexpr std::array<const char*, 3> kTurn = {"Turn the camera up and down.",
                                                         "Turn the camera left and right.",
                                                         "Turn the camera about its optical axis."};
    static constexpr std::array<const char*, 3> kMove = {
        "Move the camera left and right, briskly.", "Move the camera up and down, briskly.",
        "Move the camera towards the board and back, briskly."};
    const auto assess = [&](AssessedThing thing, const Eigen::Vector3d& spread, double good, double fair,
                            const char* unit, const std::array<const char*, 3>& remedies, const char* verb) {
      Eigen::Index axis = 0;
      const double least = spread.minCoeff(&axis);
      const auto index = static_cast<std::size_t>(axis);
      add(thing, imu.name, lightOf(least, good, fair),
          fmt::format("{:.2g}, {:.2g}, {:.2g} {}", spread.x(), spread.y(), spread.z(), unit),
          fmt::format("{:g} each", good),
          motion.along_camera ? std::string(remedies[index])
                              : fmt::format("{} the {} axis of {} more.", verb, "xyz"[index], imu.name));
    };
    assess(AssessedThing::Turns, motion.turn_rad_s, kGoodTurn_rad_s, kFairTurn_rad_s, "rad/s", kTurn,
           "Turn about");
    assess(AssessedThing::Accelerations, motion.acceleration_m_s2, kGoodAcceleration_m_s2,
           kFairAcceleration_m_s2, "m/s\u00b2", kMove, "Accelerate along");
  }

  // Covariance of the estimator at a state close to the solution.
  void expectSigmas(const InitialisedCalibration& start) {
    const OptimisationOptions& options = *session_.options.optimisation;
    const RunContext unobserved = context_.unobserved();
    const BatchSolution near =
        optimiseBatch(start.input, start.initial.state, shortened(options), unobserved);
    context_.progress.stageProgress(kUntilBatch);
    const UncertaintyEstimate estimate = estimateUncertainty(start.input, near, options, unobserved);
    for (std::size_t k = 0; k < start.input.cameras.size(); ++k) {
      if (start.input.isReferenceCamera(k) || start.input.sensorOf(k) != k) continue;
      const CameraUncertainty& sigma = estimate.report.cameras[k];
      result_.sigmas.push_back({start.input.cameras[k].name, kDegPerRad * sigma.rotation_std_rad.maxCoeff(),
                                1e3 * sigma.translation_std_m.maxCoeff(), 1e3 * sigma.time_offset_std_s});
    }
    for (const ExpectedSigmas& sigmas : result_.sigmas) judge(sigmas, estimate.report.weakest);
  }

  void judge(const ExpectedSigmas& sigmas, const std::string& weakest) {
    const OptimisationOptions& options = *session_.options.optimisation;
    const auto say = [&](AssessedThing thing, double sigma, double needed, const char* unit,
                         const char* remedy) {
      // NaN counts as Poor.
      const Light light = sigma <= needed                ? Light::Good
                          : sigma <= kFairSigma * needed ? Light::Fair
                                                         : Light::Poor;
      add(thing, sigmas.sensor, light, fmt::format("\u00b1{:.2g} {}", sigma, unit),
          fmt::format("{:g} {}", needed, unit),
          fmt::format("{} The weakest direction is {}.", remedy, weakest));
    };
    say(AssessedThing::Rotation, sigmas.rotation_deg, options.needed_rotation_deg, "deg",
        "Turn the camera about all three axes, faster and for longer.");
    say(AssessedThing::Translation, sigmas.translation_mm, options.needed_translation_mm, "mm",
        "Turn the camera about all three axes, briskly: only rotations determine the distance between the "
        "sensors.");
    say(AssessedThing::TimeOffset, sigmas.time_offset_ms, options.needed_time_offset_ms, "ms",
        "Move faster, and change direction more often.");
  }

  void addObstacle(const CalibrationError& error) {
    if (!result_.board_seen) return;  // already reported, and the cause of all other problems
    add(AssessedThing::Obstacle, error.place(), Light::Poor, error.problem(), {}, error.advice());
  }

  // Obstacles and expected sigmas decide; other measures reduce the light to Fair at most.
  void conclude() {
    for (const Assessed& one : result_.all) {
      const bool decides = one.thing == AssessedThing::Obstacle || one.thing == AssessedThing::Rotation ||
                           one.thing == AssessedThing::Translation || one.thing == AssessedThing::TimeOffset;
      const Light counted = decides ? one.light : std::min(one.light, Light::Fair);
      result_.light = std::max(result_.light, counted);
    }
    if (!result_.board_seen || !result_.can_be_calibrated) result_.light = Light::Poor;
  }

  const Session& session_;
  const DetectionResult& pass_;
  const DetectedRecording& detected_;
  const RunContext& context_;
  const CalibrationError* no_lens_;
  RecordingAssessment result_;
};

// Detections in raw pixels, for cameras with unknown lenses.
DetectedRecording detectWithoutLens(const Session& session, const RunContext& context) {
  Session seen = session;
  for (SessionCamera& camera : seen.cameras) camera.intrinsics.reset();
  return {readAndDetect(seen, context), {}};
}

}  // namespace

const char* nameOf(AssessedThing thing) {
  static constexpr std::array<const char*, 11> kNames = {
      "duration",      "board in view", "coverage",    "speed",       "lens",    "turns",
      "accelerations", "rotation",      "translation", "time offset", "obstacle"};
  return kNames[static_cast<std::size_t>(thing)];
}

RecordingAssessment assessRecording(const Session& session, const DetectedRecording& detected,
                                    const RunContext& context) {
  return Assessor(session, detected, context).run();
}

CheckedRecording checkRecording(const Session& session, const RunContext& context) {
  try {
    DetectedRecording detected = detectRecording(session, context);
    RecordingAssessment assessment = assessRecording(session, detected, context);
    return {std::move(assessment), std::move(detected)};
  } catch (const CalibrationError& error) {
    if (error.kind() == ErrorKind::BadInput) throw;
    // Detections without a lens may show why it could not be calibrated.
    const DetectedRecording detected = detectWithoutLens(session, context);
    return {Assessor(session, detected, context, &error).run(), {}};
  }
}

namespace {

Eigen::Vector3d spreadOf(const std::vector<Eigen::Vector3d>& values) {
  const double count = static_cast<double>(values.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), squares = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& value : values) mean += value / count;
  for (const Eigen::Vector3d& value : values) squares += (value - mean).cwiseAbs2() / count;
  return squares.cwiseSqrt();
}

}  // namespace

AssessedMotion assessMotion(const ImuData& reference_imu, std::int64_t start_ns,
                            const CalibrationState* state) {
  const bool placed =
      state != nullptr && !state->cameras.empty() && state->world_from_imu_rotation.segmentCount() >= 1;
  const Eigen::Matrix3d shown_from_imu =
      placed ? state->cameras.front().reference_from_camera.rotation.conjugate().toRotationMatrix()
             : Eigen::Matrix3d::Identity();
  std::vector<Eigen::Vector3d> turns, accelerations;
  for (const ImuSample& sample : reference_imu.samples) {
    const double time_s = secondsSince(start_ns, sample.time_ns);
    if (placed && !state->world_from_imu_rotation.contains(time_s)) continue;
    Eigen::Vector3d acceleration = sample.specific_force_m_s2;
    if (placed)
      acceleration +=
          evaluate(state->world_from_imu_rotation, time_s, RotationOrder::Rotation).rotation.transpose() *
          state->gravity_in_world_m_s2;
    turns.push_back(shown_from_imu * sample.angular_rate_rad_s);
    accelerations.push_back(shown_from_imu * acceleration);
  }
  return {spreadOf(turns), spreadOf(accelerations), placed};
}

}  // namespace evical
