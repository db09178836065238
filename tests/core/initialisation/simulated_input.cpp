#include "tests/core/initialisation/simulated_input.h"
#include "tests/support/random_vector.h"

#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/geometry/trajectory.h"
#include "core/numerics/angles.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/imu_simulator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>

namespace evical::test {
namespace {

MotionModel motionModel(Motion kind, double distance_m) {
  MotionModel m;
  m.distance_m = distance_m;
  m.angle_amplitude_rad = {0.38, 0.38, 0.31};
  m.target_amplitude_m = {0.08, 0.05};
  m.roll_rad = std::numbers::pi / 2.0;
  switch (kind) {
    case Motion::Everyday:
      break;
    case Motion::Slow:
      m.image_speed_px_s = 20.0;
      break;
    case Motion::Fast:
      m.angle_amplitude_rad = {0.23, 0.23, 0.35};
      m.image_speed_px_s = 280.0;
      break;
    case Motion::OneAxis:
      m.angle_amplitude_rad = {0.0, 0.44, 0.0};
      break;
    case Motion::Planar:
      m.distance_amplitude_m = 0.0;
      m.angle_amplitude_rad = {0.0, 0.0, 0.31};
      m.target_amplitude_m = {0.1, 0.07};
      break;
    case Motion::HardlyMoving:
      m.distance_amplitude_m = 0.005;
      m.angle_amplitude_rad = {0.026, 0.026, 0.026};
      m.target_amplitude_m = {0.008, 0.008};
      m.image_speed_px_s = 12.0;
      break;
    case Motion::Periodic:  // every axis at nearly the same frequency, with a period of about 0.8 s
      m.sinusoids = 1;
      m.lowest_frequency_hz = 1.2;
      m.highest_frequency_hz = 1.22;
      m.image_speed_px_s = 0.0;
      break;
    case Motion::Symmetric:  // straight in front, hardly tilted: two poses fit a view
      m.angle_amplitude_rad = {0.12, 0.12, 0.5};
      m.image_speed_px_s = 50.0;
      break;
    case Motion::Shaky:  // hands that tremble: 4 degrees at 2 to 7 Hz
      m.distance_amplitude_m = 0.01;
      m.angle_amplitude_rad = {0.07, 0.07, 0.07};
      m.target_amplitude_m = {0.01, 0.01};
      m.lowest_frequency_hz = 2.0;
      m.highest_frequency_hz = 7.0;
      m.image_speed_px_s = 0.0;
      break;
  }
  return m;
}

Scenario makeScenario(const SimulationOptions& options) {
  Scenario scenario;
  scenario.seed = options.seed;
  scenario.duration_s = options.duration_s;
  scenario.motion = motionModel(options.motion, options.distance_m);
  scenario.gravity_in_world_m_s2 = Eigen::Vector3d(0.35, 9.79, 0.42).normalized() * 9.81;
  for (int k = 0; k < options.cameras; ++k) {
    SimulatedCamera camera;
    camera.name = k == 0 ? "left" : "right";
    camera.intrinsics = {CameraModel::PinholeRadtan, {346, 260}, {262.4, 262.9}, {171.8, 131.2}, {}};
    camera.imu_from_camera = {Eigen::Quaterniond(0.707, 0.012, -0.707, 0.015).normalized(),
                              {0.021, -0.034, 0.012}};
    if (k > 0) {
      camera.imu_from_camera.translation_m += Eigen::Vector3d(0.0, 0.01, 0.1);
      camera.imu_from_camera.rotation = camera.imu_from_camera.rotation * quaternionExp({0.02, 0.05, -0.3});
    }
    camera.time_offset_s = options.time_offset_s + 0.07 * k;
    camera.pixel.latency_s = camera.pixel.low_pass_s = 0.0;
    scenario.cameras.push_back(camera);
  }
  SimulatedImu imu;
  imu.rate_hz = options.imu_rate_hz;
  imu.gyroscope_bias_rad_s = {0.014, -0.011, 0.009};  // 0.02 rad/s
  imu.accelerometer_bias_m_s2 = {0.2, -0.15, 0.17};   // 0.3 m/s^2
  imu.gyroscope_scale_misalignment << 1.004, 0.002, -0.001, 0.0, 0.997, 0.0015, 0.0, 0.0, 1.002;
  imu.accelerometer_scale_misalignment << 0.998, -0.001, 0.002, 0.0, 1.003, 0.001, 0.0, 0.0, 1.001;
  scenario.imus = {imu};
  if (!options.second_imu) return scenario;
  SimulatedImu second = imu;
  second.name = "second";
  second.gyroscope_bias_rad_s = {-0.02, 0.01, 0.015};
  second.accelerometer_bias_m_s2 = {-0.1, 0.2, 0.05};
  second.reference_from_imu = {quaternionExp({0.3, -2.0, 1.0}), {0.12, -0.05, 0.08}};
  second.time_offset_s = options.second_imu_offset_s;
  scenario.imus.push_back(second);
  return scenario;
}

// The same pattern shifted by one row: half a column sideways and one spacing down; circles beyond the board
// are lost.
void shiftByRow(BoardView& view, const Board& board) {
  std::vector<CircleObservation> shifted;
  for (CircleObservation circle : view.circles) {
    const int row = circle.circle / board.cols, col = circle.circle % board.cols + row % 2;
    if (row + 1 >= board.rows || col >= board.cols) continue;
    circle.circle = board.index(row + 1, col);
    shifted.push_back(circle);
  }
  std::sort(shifted.begin(), shifted.end(), [](const auto& a, const auto& b) { return a.circle < b.circle; });
  view.circles = std::move(shifted);
  view.kind = ViewKind::Partial;
}

std::optional<BoardView> observe(const SinusoidMotion& motion, const Scenario& scenario, std::size_t camera,
                                 double time_s, double sigma_px, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> jitter(-5e-3, 5e-3);
  BoardView view;
  view.time_s = time_s;
  for (const TrueCircle& truth : trueBoardView(motion, scenario, camera, time_s)) {
    if (!truth.inside) continue;
    CircleObservation circle;
    circle.circle = truth.circle;
    // Each circle has a separate time; 5 ms of a smooth path are straight to a hundredth of a pixel.
    circle.time_s = time_s + jitter(random);
    circle.velocity_px_s = truth.velocity_px_s;
    circle.centre_px = truth.centre_px + truth.velocity_px_s * (circle.time_s - time_s) +
                       sigma_px * test::randomVector<2>([&] { return normal(random); });
    circle.covariance_px2 = std::max(sigma_px * sigma_px, 1e-6) * Eigen::Matrix2d::Identity();
    circle.events = 100;
    circle.residual_rms_px = sigma_px;
    view.circles.push_back(circle);
  }
  const int count = static_cast<int>(view.circles.size());
  if (count < 0.4 * scenario.board.pointCount()) return std::nullopt;
  view.kind = count == scenario.board.pointCount() ? ViewKind::Complete : ViewKind::Partial;
  return view;
}

std::vector<bool> missingWindows(std::size_t count, const SimulationOptions& options,
                                 std::mt19937_64& random) {
  std::vector<bool> missing(count, false);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto stretch = static_cast<std::size_t>(1.0 / options.window_s);
  for (std::size_t k = 0; k < count; ++k) {
    const bool begin = k % stretch == 0 && uniform(random) < 0.5 * options.missing_share;
    if (begin)
      std::fill_n(missing.begin() + static_cast<std::ptrdiff_t>(k), std::min(stretch, count - k), true);
    if (uniform(random) < 0.5 * options.missing_share) missing[k] = true;
  }
  return missing;
}

}  // namespace

SimulatedInput simulateInput(const SimulationOptions& options) {
  SimulatedInput result;
  result.truth = makeScenario(options);
  const SinusoidMotion motion(result.truth);
  std::mt19937_64 random(options.seed * 31 + 7);
  CalibrationInput& input = result.input;
  input.start_ns = result.truth.start_ns;
  input.board = result.truth.board;
  for (std::size_t k = 0; k < result.truth.cameras.size(); ++k) {
    CameraData camera;
    camera.name = camera.observations.camera = result.truth.cameras[k].name;
    camera.lens = givenLens(result.truth.cameras[k].intrinsics);
    const auto windows = static_cast<std::size_t>(options.duration_s / options.window_s);
    const std::vector<bool> missing = missingWindows(windows, options, random);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (std::size_t w = 0; w < windows; ++w) {
      WindowReport report;
      report.time_s = (static_cast<double>(w) + 0.5) * options.window_s;
      auto view = observe(motion, result.truth, k, report.time_s, options.centre_sigma_px, random);
      const bool misplaced = uniform(random) < options.misplaced_share;
      if (view && !missing[w]) {
        if (misplaced) {
          shiftByRow(*view, input.board);
          ++result.misplaced;
        }
        report.outcome = WindowOutcome::Complete;
        camera.observations.views.push_back(std::move(*view));
      }
      camera.observations.windows.push_back(report);
    }
    input.cameras.push_back(std::move(camera));
  }
  for (std::size_t k = 0; k < result.truth.imus.size(); ++k) {
    ImuData imu;
    imu.name = result.truth.imus[k].name;
    imu.samples = simulateImu(result.truth, k);
    std::erase_if(imu.samples, [&](const ImuSample& sample) {
      const double time_s = secondsSince(input.start_ns, sample.time_ns);
      return time_s < options.imu_begin_s || (options.imu_end_s >= 0.0 && time_s > options.imu_end_s);
    });
    input.imus.push_back(std::move(imu));
  }
  return result;
}

InitialErrors initialErrors(const CalibrationState& state, const SimulatedInput& simulated,
                            std::size_t camera) {
  InitialErrors errors;
  const SimulatedCamera& truth = simulated.truth.cameras[camera];
  const CameraState& found = state.cameras[camera];
  errors.rotation_deg = kDegPerRad * rotationAngleBetween_rad(found.reference_from_camera.rotation,
                                                              truth.imu_from_camera.rotation);
  errors.translation_m =
      (found.reference_from_camera.translation_m - truth.imu_from_camera.translation_m).norm();
  errors.time_offset_s = std::abs(found.time_offset_s - truth.time_offset_s);
  const Eigen::Vector3d down = simulated.truth.gravity_in_world_m_s2.normalized();
  errors.gravity_deg =
      kDegPerRad * std::asin(std::min(1.0, state.gravity_in_world_m_s2.normalized().cross(down).norm()));
  if (state.gravity_in_world_m_s2.dot(down) < 0.0) errors.gravity_deg = 180.0 - errors.gravity_deg;
  const SimulatedImu& imu = simulated.truth.imus.front();
  errors.gyroscope_bias_rad_s = (state.imus.front().gyroscope_bias_rad_s - imu.gyroscope_bias_rad_s).norm();
  errors.accelerometer_bias_m_s2 =
      (state.imus.front().accelerometer_bias_m_s2 - imu.accelerometer_bias_m_s2).norm();
  const SinusoidMotion motion(simulated.truth);
  int count = 0;
  for (const BoardView& view : simulated.input.cameras[camera].observations.views) {
    const double time_s = view.time_s + truth.time_offset_s;
    if (!state.imu_in_world_m.contains(time_s)) continue;
    const RigidTransform estimate = worldFromImu(state.world_from_imu_rotation, state.imu_in_world_m, time_s);
    const RigidTransform there = motion.imuAt(time_s).world_from_body;
    const double angle_deg = kDegPerRad * rotationAngleBetween_rad(estimate.rotation, there.rotation);
    errors.trajectory_rotation_deg += angle_deg * angle_deg;
    errors.trajectory_position_m += (estimate.translation_m - there.translation_m).squaredNorm();
    ++count;
  }
  errors.trajectory_rotation_deg = std::sqrt(errors.trajectory_rotation_deg / std::max(count, 1));
  errors.trajectory_position_m = std::sqrt(errors.trajectory_position_m / std::max(count, 1));
  return errors;
}

}  // namespace evical::test
