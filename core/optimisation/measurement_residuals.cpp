#include "core/optimisation/measurement_residuals.h"

#include "core/base/time.h"
#include "core/optimisation/bias_knots.h"
#include "core/optimisation/circle_errors.h"
#include "core/optimisation/edge_localisation_bias.h"
#include "core/optimisation/inertial_cost.h"
#include "core/optimisation/sample_runs.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace evical {
namespace {

// Shift of a time by each ppm of drift.
template <class Sensor>
double byDrift_s(const Sensor& sensor, double time_s) {
  return 1e-6 * (time_s - sensor.time_offset_at_s);
}

// Index of the image's cell, of 16 x 10.
int placeOf(const Eigen::Vector2d& centre_px, const Resolution& resolution_px) {
  constexpr int kColumns = 16, kRows = 10;
  const auto cell = [](double at, int size_px, int cells) {
    return std::clamp(static_cast<int>(std::floor(at * cells / std::max(1, size_px))), 0, cells - 1);
  };
  return cell(centre_px.y(), resolution_px.height_px, kRows) * kColumns +
         cell(centre_px.x(), resolution_px.width_px, kColumns);
}

CircleMeasurement circleOf(const ProblemBuilder& builder, std::size_t camera, std::size_t view,
                           std::size_t circle, const PixelErrors& pixel_errors) {
  const CameraData& data = builder.input.cameras[camera];
  const CircleObservation& observed = data.observations.views[view].circles[circle];
  const double scale = builder.weights.scales.circles[camera];
  const double floor_px2 = builder.options.least_centre_sigma_px * builder.options.least_centre_sigma_px;
  const Eigen::Matrix2d covariance =
      scale * scale * (observed.covariance_px2 + floor_px2 * Eigen::Matrix2d::Identity());
  CircleMeasurement m;
  m.time_s = observed.time_s;
  m.by_drift_s = byDrift_s(builder.parameters.moved().cameras[camera], observed.time_s);
  m.by_line_s = 1e-6 * observed.rows_below_middle;
  m.by_exposure_s = observed.longer_exposed_s;
  m.on_board_m = builder.input.boardOf(camera).point_m(observed.circle);
  m.centre_px = observed.centre_px;
  m.whitening_px = covariance.llt().matrixL().solve(Eigen::Matrix2d::Identity());
  m.lead = edgeBiasEffect(*data.lens.detection_intrinsics, observed, builder.options.slow_edge_speed_px_s);
  m.pixel_error_px = pixel_errors.at(observed);
  m.common_px = scale * commonDisplacement_px(data.observations.kind, observed, builder.options);
  m.view = static_cast<int>(view);
  m.circle = static_cast<int>(circle);
  m.point = observed.circle;
  m.place = placeOf(observed.centre_px, data.lens.detection_intrinsics->resolution_px);
  return m;
}

// When it was measured, on the trajectory's clock.
struct TimedCircle {
  double time_s = 0.0;
  std::uint32_t view = 0, circle = 0;
};

// Used circles within the splines' range, in order of time. Not the measurements themselves, which are ten times as
// large.
std::vector<TimedCircle> circlesOf(const ProblemBuilder& builder, std::size_t camera) {
  const CalibrationState& state = builder.parameters.moved();
  const auto& views = builder.input.cameras[camera].observations.views;
  std::vector<TimedCircle> circles;
  for (std::uint32_t view = 0; view < views.size(); ++view) {
    for (std::uint32_t i = 0; i < views[view].circles.size(); ++i) {
      if (!builder.weights.used_circles[camera][view][i]) continue;
      const double time_s = circleTime_s(state.cameras[camera], views[view].circles[i]);
      if (!state.world_from_imu_rotation.contains(time_s) || !state.imu_in_world_m.contains(time_s)) continue;
      circles.push_back({time_s, view, i});
    }
  }
  std::ranges::stable_sort(circles, {}, &TimedCircle::time_s);
  return circles;
}

// Used samples of the run, with their times and values.
std::vector<InertialMeasurement> samplesOf(const ProblemBuilder& builder, const SampleRun& run,
                                           Eigen::Vector3d ImuSample::*value,
                                           const std::vector<std::uint8_t>& used) {
  std::vector<InertialMeasurement> measurements;
  measurements.reserve(run.end - run.begin);
  for (std::size_t i = run.begin; i < run.end; ++i) {
    if (!used[i]) continue;
    const ImuSample& sample = builder.input.imus[run.imu].samples[i];
    const double time_s = secondsSince(builder.input.start_ns, sample.time_ns);
    measurements.push_back(
        {time_s, sample.*value, byDrift_s(builder.parameters.moved().imus[run.imu], time_s)});
  }
  return measurements;
}

ImuRole roleOf(const ProblemBuilder& builder, const SampleRun& run) {
  return builder.isReference(run.imu) ? ImuRole::Reference : ImuRole::Further;
}

void addGyroscope(ProblemBuilder& builder, const SampleRun& run, double sigma) {
  ImuState& state = builder.parameters.moved().imus[run.imu];
  std::vector<InertialMeasurement> measurements = samplesOf(builder, run, &ImuSample::angular_rate_rad_s,
                                                            builder.weights.used_samples[run.imu].gyroscope);
  if (measurements.empty()) return;
  std::vector<double*> blocks;
  builder.parameters.appendRotation(run.segment, blocks);
  blocks.insert(blocks.end(),
                {state.gyroscope_bias_rad_s.data(), builder.parameters.of(state.gyroscope_scale_misalignment),
                 state.gyroscope_from_accelerometer.coeffs().data()});
  if (!builder.isReference(run.imu))
    blocks.insert(blocks.end(), {state.reference_from_imu.rotation.coeffs().data(), &state.time_offset_s,
                                 &state.time_offset_drift_ppm});
  const auto drift = appendDriftBlocks(state.bias_drift, state.bias_drift.gyroscope_rad_s,
                                       measurements.front().time_s, blocks);
  auto* cost = new GyroscopeCost(roleOf(builder, run), sigma, run.segment, std::move(measurements), drift);
  builder.residuals.push_back(
      {builder.problem.AddResidualBlock(cost, nullptr, blocks), SensorKind::Gyroscope, run.imu, run.time_s});
}

void addAccelerometer(ProblemBuilder& builder, const SampleRun& run, double sigma) {
  CalibrationState& all = builder.parameters.moved();
  ImuState& state = all.imus[run.imu];
  std::vector<InertialMeasurement> measurements = samplesOf(
      builder, run, &ImuSample::specific_force_m_s2, builder.weights.used_samples[run.imu].accelerometer);
  if (measurements.empty()) return;
  std::vector<double*> blocks;
  builder.parameters.appendRotation(run.segment, blocks);
  builder.parameters.appendPosition(run.segment, blocks);
  blocks.insert(blocks.end(), {all.gravity_in_world_m_s2.data(), state.accelerometer_bias_m_s2.data(),
                               builder.parameters.of(state.accelerometer_scale_misalignment),
                               &state.accelerometer_delay_s});
  if (!builder.isReference(run.imu)) {
    blocks.insert(blocks.end(), {state.reference_from_imu.rotation.coeffs().data(),
                                 state.reference_from_imu.translation_m.data(), &state.time_offset_s,
                                 &state.time_offset_drift_ppm});
  }
  const auto drift = appendDriftBlocks(state.bias_drift, state.bias_drift.accelerometer_m_s2,
                                       measurements.front().time_s, blocks);
  auto* cost =
      new AccelerometerCost(roleOf(builder, run), sigma, run.segment, std::move(measurements), drift);
  builder.residuals.push_back({builder.problem.AddResidualBlock(cost, nullptr, blocks),
                               SensorKind::Accelerometer, run.imu, run.time_s});
}

}  // namespace

void addCircles(ProblemBuilder& builder, std::size_t camera, const CircleModel& model,
                const PixelErrors& pixel_errors) {
  ParameterBlocks& parameters = builder.parameters;
  CameraState& state = parameters.moved().cameras[camera];
  CameraState& sensor = parameters.moved().cameras[parameters.sensorOf(camera)];
  BoardState& board = parameters.moved().boardAt(builder.input.cameras[camera].board);
  const std::vector<TimedCircle> circles = circlesOf(builder, camera);
  for (std::size_t begin = 0, end = 0; begin < circles.size(); begin = end) {
    const double begin_s = circles[begin].time_s;
    const SegmentTimes segment = parameters.segmentAt(begin_s);
    while (end < circles.size() && sameSegment(segment, parameters.segmentAt(circles[end].time_s))) ++end;
    std::vector<CircleMeasurement> measurements;
    measurements.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i)
      measurements.push_back(circleOf(builder, camera, circles[i].view, circles[i].circle, pixel_errors));
    auto* cost = new CircleCost(model, segment, std::move(measurements));
    std::vector<double*> blocks;
    parameters.appendRotation(segment, blocks);
    parameters.appendPosition(segment, blocks);
    blocks.insert(
        blocks.end(),
        {sensor.reference_from_camera.rotation.coeffs().data(),
         sensor.reference_from_camera.translation_m.data(), &state.time_offset_s,
         &sensor.time_offset_drift_ppm, &state.line_delay_us, &state.edge_localisation_bias_px,
         &state.slow_edge_localisation_bias_px, &board.scale, &board.stretch, &board.row_curvature_1_m,
         &board.column_curvature_1_m, &board.twist_1_m, &state.exposure_share,
         board.world_from_board.rotation.coeffs().data(), board.world_from_board.translation_m.data()});
    if (IntrinsicsBlock* intrinsics = parameters.intrinsics(camera)) blocks.push_back(intrinsics->data());
    builder.residuals.push_back({builder.problem.AddResidualBlock(cost, nullptr, blocks), SensorKind::Circles,
                                 camera, begin_s, cost});
  }
}

void addImu(ProblemBuilder& builder, std::size_t imu) {
  const CalibrationState& state = builder.parameters.moved();
  const NoiseScales& scales = builder.weights.scales;
  const ImuData& data = builder.input.imus[imu];
  const double rate_sigma = scales.gyroscopes[imu] * data.gyroscopeSigma_rad_s();
  const double force_sigma = scales.accelerometers[imu] * data.accelerometerSigma_m_s2();
  for (const SampleRun& run : gyroscopeRuns(builder.input, state, imu))
    addGyroscope(builder, run, rate_sigma);
  for (const SampleRun& run : accelerometerRuns(builder.input, state, imu))
    addAccelerometer(builder, run, force_sigma);
}

}  // namespace evical
