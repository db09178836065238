// Accuracy of frame cameras, further boards and lenses, as one table: `evical_benchmarks frame_cameras
// [--only NAME...] [--seconds S]`. Simulated recordings are compared with their truth; real ones, in the
// folder EVICAL_DATA, with published values. Fails if a target is missed.
#include "core/base/time.h"
#include "core/frames/gray_image.h"
#include "core/geometry/projection_difference.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/recording/recording_reader.h"
#include "core/recording/recording_writer.h"
#include "tests/benchmarks/benchmark_program.h"
#include "tests/benchmarks/scenario_run.h"
#include "tests/support/real_recordings.h"
#include "tests/support/test_folders.h"

#include <fmt/format.h>

#include <QTemporaryDir>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace evical::benchmarks::frame_cameras {
namespace {

constexpr double kMmPerM = 1e3, kMsPerS = 1e3;

class Table {
 public:
  Table() { fmt::print("| recording | what | found | target | |\n|---|---|---|---|---|\n"); }

  void add(const std::string& recording, const std::string& what, const std::string& found,
           const std::string& target, bool met) {
    fmt::print("| {} | {} | {} | {} | {} |\n", recording, what, found, target, met ? "met" : "MISSED");
    std::fflush(stdout);
    all_met_ = all_met_ && met;
  }
  void atMost(const std::string& recording, const std::string& what, double found, double target,
              const char* unit) {
    add(recording, what, fmt::format("{:.3g} {}", found, unit), fmt::format("{:g} {}", target, unit),
        found <= target);
  }
  void failed(const std::string& recording, const std::string& why) {
    add(recording, "all", why, "a result", false);
  }
  bool allMet() const { return all_met_; }

 private:
  bool all_met_ = true;
};

Scenario scenarioOf(const std::string& name, std::optional<double> duration_s) {
  Scenario scenario = readScenario(test::scenarioPath(name));
  if (duration_s) scenario.duration_s = *duration_s;
  return scenario;
}

// Pose of one camera relative to another, or to the reference IMU.
struct RelativeError {
  double rotation_deg, translation_mm, time_offset_ms;
};
RelativeError errorOf(const RigidTransform& found, const RigidTransform& truth, double offset_error_s) {
  return {kDegPerRad * rotationAngleBetween_rad(found.rotation, truth.rotation),
          kMmPerM * (found.translation_m - truth.translation_m).norm(), kMsPerS * std::abs(offset_error_s)};
}
RelativeError camerasError(const CalibrationState& found, const CalibrationState& truth, std::size_t a,
                           std::size_t b) {
  const auto between = [&](const CalibrationState& state) {
    return inverse(state.cameras[a].reference_from_camera) * state.cameras[b].reference_from_camera;
  };
  const auto later_s = [&](const CalibrationState& state) {
    const double time_s = found.cameras[a].time_offset_at_s;
    return timeOffsetAt_s(state.cameras[b], time_s) - timeOffsetAt_s(state.cameras[a], time_s);
  };
  return errorOf(between(found), between(truth), later_s(found) - later_s(truth));
}
RelativeError cameraError(const CalibrationState& found, const CalibrationState& truth, std::size_t k) {
  const CameraState &a = found.cameras[k], &b = truth.cameras[k];
  return errorOf(a.reference_from_camera, b.reference_from_camera,
                 a.time_offset_s - timeOffsetAt_s(b, a.time_offset_at_s));
}

void addError(Table& table, const std::string& recording, const std::string& of, const RelativeError& error,
              const RelativeError& target) {
  table.atMost(recording, of + ": rotation", error.rotation_deg, target.rotation_deg, "deg");
  table.atMost(recording, of + ": translation", error.translation_mm, target.translation_mm, "mm");
  table.atMost(recording, of + ": time offset", error.time_offset_ms, target.time_offset_ms, "ms");
}

// Bound of the difference between two consistent estimates of one quantity.
constexpr double kAgree_sigmas = 3.0;

double worstSigmas(const CalibrationResult& result) {
  const CameraState &a = result.state.cameras[0], &b = result.state.cameras[1];
  const CameraUncertainty &sa = result.uncertainty.cameras[0], &sb = result.uncertainty.cameras[1];
  const Eigen::Vector3d turn =
      quaternionLog(a.reference_from_camera.rotation * b.reference_from_camera.rotation.conjugate());
  const Eigen::Vector3d shift = a.reference_from_camera.translation_m - b.reference_from_camera.translation_m;
  const auto sigma = [](const Eigen::Vector3d& x, const Eigen::Vector3d& y) -> Eigen::Vector3d {
    return (x.array().square() + y.array().square()).sqrt();
  };
  return std::max(
      turn.cwiseQuotient(sigma(sa.rotation_std_rad, sb.rotation_std_rad)).cwiseAbs().maxCoeff(),
      shift.cwiseQuotient(sigma(sa.translation_std_m, sb.translation_std_m)).cwiseAbs().maxCoeff());
}

void davisWithFrames(Table& table, std::optional<double> seconds) {
  const std::string name = "davis346_frames";
  const Scenario scenario = scenarioOf(name, seconds);
  const Outcome both = runScenario(scenario);
  const Outcome apart = runScenario(
      scenario, [](Session& session) { session.options.optimisation.edit().share_sensors = false; });
  Scenario of_events = scenario;
  of_events.cameras.resize(1);
  const Outcome events = runScenario(of_events);
  if (!both.result || !apart.result || !events.result || both.result->latencies.empty())
    return table.failed(name, both.verdictText());
  const CalibrationState truth = trueState(scenario);
  const double latency_s = truth.cameras[1].time_offset_s - truth.cameras[0].time_offset_s;
  table.atMost(name, "events' latency", kMsPerS * std::abs(both.result->latencies[0].latency_s - latency_s),
               0.05, "ms");
  table.atMost(name, "events and frames apart: poses differ by", worstSigmas(*apart.result), kAgree_sigmas,
               "sigmas");
  constexpr double kScatter = 1.1;  // of sigmas that are estimated from the recording
  const CameraUncertainty &s = both.result->uncertainty.cameras[0],
                          &alone = events.result->uncertainty.cameras[0];
  table.atMost(name, "sigma of rotation, of that with events alone",
               s.rotation_std_rad.norm() / alone.rotation_std_rad.norm(), kScatter, "times");
  table.atMost(name, "sigma of translation, of that with events alone",
               s.translation_std_m.norm() / alone.translation_std_m.norm(), kScatter, "times");
}

// The outcome of an event camera with a frame camera, against the truth of both; empty if it failed.
std::optional<Outcome> eventsToFrames(Table& table, const std::string& name, const Scenario& scenario) {
  Outcome outcome = runScenario(scenario);
  if (!outcome.result) {
    table.failed(name, outcome.verdictText());
    return std::nullopt;
  }
  addError(table, name, "events to frames", camerasError(outcome.result->state, trueState(scenario), 0, 1),
           {0.02, 0.5, 0.05});
  return outcome;
}

void hybridStereo(Table& table, std::optional<double> seconds) {
  const std::string name = "hybrid_stereo";
  const Scenario scenario = scenarioOf(name, seconds);
  const std::optional<Outcome> found = eventsToFrames(table, name, scenario);
  if (!found) return;
  const Outcome& outcome = *found;
  addError(table, name, "events to IMU", cameraError(outcome.result->state, trueState(scenario), 0),
           {0.1, 2.0, 0.2});
  table.add(name, "verdict", outcome.verdict, "ok", outcome.verdict == "ok");
}

// One bag of raw pixels and IMU samples, as camera drivers record them.
void bringIntoOneBag(Session& session, const std::filesystem::path& bag) {
  const auto pictures = openRecording(session.cameras[0].recording), imu = openRecording(session.recording);
  std::vector<StreamInfo> streams = pictures->streams();
  for (StreamInfo& stream : streams) stream.resolution_px = {};
  const std::size_t imu_stream = findStream(*imu, session.imus[0].stream, StreamType::Imu);
  streams.push_back(imu->streams()[imu_stream]);
  const auto writer = createBag(bag, streams, false);
  std::vector<std::size_t> all(streams.size() - 1);
  std::iota(all.begin(), all.end(), 0);
  pictures->select(all);
  imu->select({imu_stream});
  std::vector<ImuSample> samples;
  Packet packet;
  while (imu->read(packet))
    toSi(packet.imu_samples, streams.back().acceleration_unit, streams.back().angular_rate_unit, samples);
  std::size_t next = 0;
  while (pictures->read(packet)) {
    for (const Frame& packed : packet.frames) {
      for (; next < samples.size() && samples[next].time_ns <= packed.time_ns; ++next)
        writer->write(all.size(), std::span(samples).subspan(next, 1));
      GrayImage image = decodeFrame(packed, session.cameras[0].recording.string());
      Frame frame;
      frame.time_ns = packed.time_ns;
      frame.size_px = image.size_px;
      frame.row_bytes = static_cast<std::size_t>(image.size_px.width_px);
      frame.bytes = std::move(image.pixels);
      writer->writeFrame(packet.stream, frame);
    }
  }
  writer->write(all.size(), std::span(samples).subspan(next));
  writer->finish();
  session.recording = bag;
  for (SessionCamera& camera : session.cameras) camera.recording.clear();
}

void frameStereo(Table& table, std::optional<double> seconds) {
  const std::string name = "frame_stereo_imu";
  const Scenario scenario = scenarioOf(name, seconds);
  const QTemporaryDir folder;
  const SimulationSummary made = simulate(scenario, folder.path().toStdString(), {});
  Session session = readSession(made.session);
  bringIntoOneBag(session, folder.filePath("all.bag").toStdString());
  const Stopwatch stopwatch;
  const CalibrationRun run = calibrate(session, RunContext{});
  table.atMost(name, "wall time from a bag", stopwatch.elapsed_s(), 20.0, "s");
  const CalibrationState truth = trueState(scenario);
  addError(table, name, "camera to camera", camerasError(run.result.state, truth, 0, 1), {0.01, 0.2, 0.1});
  addError(table, name, "camera to IMU", cameraError(run.result.state, truth, 0), {0.03, 1.5, 0.1});
  const std::string verdict = statusName(run.result.status);
  table.add(name, "verdict", verdict, "ok", verdict == "ok");
}

void rollingShutter(Table& table, std::optional<double> seconds) {
  const std::string name = "rolling_shutter";
  const Scenario scenario = scenarioOf(name, seconds);
  const Outcome rolling = runScenario(scenario);
  const Outcome global =
      runScenario(scenario, [](Session& session) { session.cameras[0].shutter = Shutter::Global; });
  const auto lineDelayError = [&](const char* what, const Outcome& outcome) {
    if (!outcome.result) return table.failed(name, outcome.verdictText());
    const double error_us =
        outcome.result->state.cameras[0].line_delay_us - scenario.cameras[0].frames->line_delay_us;
    table.atMost(name, what, std::abs(error_us), 0.3, "us");
  };
  lineDelayError("line delay", rolling);
  lineDelayError("line delay, declared as global", global);
  const bool freed = global.result && !global.result->freed.empty() &&
                     global.result->freed.front().name == std::string_view("rolling_shutter");
  table.add(name, "declared as global", global.verdict + (freed ? ", line delay freed" : ""),
            "ok, line delay freed", global.verdict == "ok" && freed && !isWrong(global));
}

void wideFrame(Table& table, std::optional<double> seconds) {
  const std::string name = "wide_frame";
  const Scenario scenario = scenarioOf(name, seconds);
  const QTemporaryDir folder;
  const SimulationSummary made = simulate(scenario, folder.path().toStdString(), {});
  const IntrinsicsResult found = calibrateIntrinsics(readSession(made.session), 0, {}).result;
  constexpr double kOfImageCircle = 0.95;
  const CameraIntrinsics& truth = scenario.cameras[0].intrinsics;
  table.atMost(
      name, "projection, RMS over 95 % of the image circle",
      projectionDifference(truth, found.intrinsics, kOfImageCircle * shareOfImageCircle(truth)).rms_px, 0.15,
      "px");
}

void twoBoards(Table& table, std::optional<double> seconds) {
  const std::string name = "two_boards";
  const Scenario scenario = scenarioOf(name, seconds);
  const std::optional<Outcome> found = eventsToFrames(table, name, scenario);
  if (!found) return;
  const RelativeError tags = errorOf(found->result->state.boardAt(1).world_from_board,
                                     scenario.further_boards[0].world_from_board, 0.0);
  table.atMost(name, "board to board: rotation", tags.rotation_deg, 0.02, "deg");
  table.atMost(name, "board to board: translation", tags.translation_mm, 0.5, "mm");
}

// The corners determine another lens than the published one, so poses are comparable only with the published
// lens fixed.
void eurocImuApril(Table& table, const QString& real) {
  const std::string name = "euroc_imu_april (real)";
  const RigidTransform published = test::eurocImuFromCamera();
  const auto turn_deg = [&](const CameraState& camera) {
    return kDegPerRad * camera.reference_from_camera.rotation.angularDistance(published.rotation);
  };
  const auto shift_mm = [&](const CameraState& camera) {
    return kMmPerM * (camera.reference_from_camera.translation_m - published.translation_m).norm();
  };
  const QTemporaryDir work;
  Session session = test::eurocImuApril(real, QDir(work.path()));
  const CalibrationResult result = calibrate(session, RunContext{}).result;
  const CameraState& camera = result.state.cameras[0];
  table.atMost(name, "rays in the IMU's frame against the published", test::raysFromEuroc_deg(camera), 0.3,
               "deg");
  table.atMost(name, "time offset", kMsPerS * std::abs(camera.time_offset_s), 1.0, "ms");
  table.add(name, "verdict", statusName(result.status), "doubtful",
            result.status == CalibrationStatus::Doubtful);
  table.add(name, "pose with the lens of these corners, from the published",
            fmt::format("{:.2f} deg, {:.1f} mm", turn_deg(camera), shift_mm(camera)), "none", true);
  session.options.optimisation.edit().camera_intrinsics = CameraIntrinsicsChoice::Fixed;
  const CameraState fixed = calibrate(session, RunContext{}).result.state.cameras[0];
  table.atMost(name, "rotation with the published lens, from the published", turn_deg(fixed), 0.3, "deg");
  table.atMost(name, "translation with the published lens, from the published", shift_mm(fixed), 5.0, "mm");
}

void efcalib(Table& table, const QString& real) {
  const std::string name = "efcalib (real)";
  const QTemporaryDir work;
  const CalibrationRun run = calibrate(test::efcalib(real, QDir(work.path())), RunContext{});
  const RigidTransform& frames = run.result.state.cameras[1].reference_from_camera;
  table.atMost(name, "rotation against (5.10, -9.13, -0.85) deg",
               (kDegPerRad * quaternionLog(frames.rotation) - Eigen::Vector3d(5.10, -9.13, -0.85)).norm(),
               0.2, "deg");
  table.atMost(name, "translation against (118.0, -8.7, 19.1) mm",
               (kMmPerM * frames.translation_m - Eigen::Vector3d(118.0, -8.7, 19.1)).norm(), 2.0, "mm");
  table.atMost(name, "residuals of events", run.intrinsics[0]->reprojection_rms_px, 0.12, "px");
  table.atMost(name, "residuals of frames", run.intrinsics[1]->reprojection_rms_px, 0.17, "px");
}

void dvs128Blinking(Table& table, const QString& real) {
  const std::string name = "dvs128_blinking (real)";
  const IntrinsicsRun run = calibrateIntrinsics(test::dvs128Blinking(real, 4, 8), 0, RunContext{});
  table.atMost(name,
               fmt::format("focal length (sigma {:.1f}) against 89.8 px", run.result.standardDeviations()[0]),
               std::abs(run.result.intrinsics.focal_length_px.mean() - 89.8), 1.5, "px");
}

void checkerboardPictures(Table& table, const std::string& name, const QDir& folder, const QString& pattern,
                          double focal_px, double percent) {
  const QTemporaryDir work;
  const IntrinsicsRun run =
      calibrateIntrinsics(test::pictures(folder, pattern, QDir(work.path())), 0, RunContext{});
  table.atMost(name, fmt::format("focal length against {:g} px", focal_px),
               100.0 * std::abs(run.result.intrinsics.focal_length_px.mean() / focal_px - 1.0), percent, "%");
}

void realOnes(Table& table, const std::function<bool(const char*)>& asked) {
  const QString real = test::realRecordings();
  if (real.isEmpty()) {
    fmt::print(stderr, "EVICAL_DATA is not set: real recordings are omitted\n");
    return;
  }
  if (asked("euroc_imu_april")) eurocImuApril(table, real);
  if (asked("efcalib")) efcalib(table, real);
  if (asked("dvs128_blinking")) dvs128Blinking(table, real);
  if (asked("vector_blinking"))
    checkerboardPictures(table, "vector_blinking (real)", QDir(real + "/vector_blinking"), "*.png", 327.52,
                         0.2);
  const QDir opencv("/usr/share/doc/opencv-doc/examples/data");
  if (!asked("opencv-doc")) return;
  if (opencv.exists("left01.jpg"))
    checkerboardPictures(table, "opencv-doc (real)", opencv, "left??.jpg", 534.0, 0.3);
  else
    fmt::print(stderr, "The package opencv-doc is not installed: its images are omitted\n");
}

}  // namespace

int run(int argc, char** argv) {
  CommandLine app("Accuracy of frame cameras, further boards and lenses, against targets");
  std::vector<std::string> only;
  std::optional<double> seconds;
  app.option("--only", only, "Recordings by name, instead of all");
  app.option("--seconds", seconds, "Duration of simulated recordings, instead of their own")
      .between(2.0, 3600.0);
  if (!app.parse(argc, argv)) return 0;
  const auto asked = [&](const char* name) {
    return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
  };
  Table table;
  if (asked("davis346_frames")) davisWithFrames(table, seconds);
  if (asked("hybrid_stereo")) hybridStereo(table, seconds);
  if (asked("frame_stereo_imu")) frameStereo(table, seconds);
  if (asked("rolling_shutter")) rollingShutter(table, seconds);
  if (asked("wide_frame")) wideFrame(table, seconds);
  if (asked("two_boards")) twoBoards(table, seconds);
  realOnes(table, asked);
  return table.allMet() ? 0 : 1;
}

}  // namespace evical::benchmarks::frame_cameras
