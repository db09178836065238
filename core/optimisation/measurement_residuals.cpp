#include "core/optimisation/measurement_residuals.h"

#include "core/base/in_parallel.h"
#include "core/base/time.h"
#include "core/geometry/camera_motion.h"
#include "core/optimisation/bias_knots.h"
#include "core/optimisation/inertial_cost.h"
#include "core/optimisation/sample_errors.h"
#include "core/optimisation/view_circles.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

namespace evical {
namespace {

// Circles of one cost function from the first of these on: the view, or rows of a rolling shutter with common
// pose times, since nothing connects the errors of different rows.
std::size_t countOfPart(const ProblemBuilder& builder, CameraKind kind,
                        std::span<const TimedCircle> circles) {
  if (kind == CameraKind::Events) return circles.size();
  const ParameterBlocks& parameters = builder.parameters;
  const CalibrationState& state = parameters.moved();
  const double longest_s = PoseTimes::longest_s(
      std::min(state.world_from_imu_rotation.knot_spacing_s, state.imu_in_world_m.knot_spacing_s));
  const SegmentTimes segment = parameters.segmentAt(circles.front().time_s);
  const auto beyond = std::ranges::find_if(circles, [&](const TimedCircle& circle) {
    return circle.time_s - circles.front().time_s > longest_s ||
           !sameSegment(segment, parameters.segmentAt(circle.time_s));
  });
  return static_cast<std::size_t>(beyond - circles.begin());
}

struct ViewPart {
  double time_s;  // of its first circle
  SegmentTimes segments;
  std::unique_ptr<ViewCost> cost;
};

// One cost function for these circles, in order of time.
ViewPart partOf(const ProblemBuilder& builder, std::size_t camera, const CircleModel& model,
                const PixelErrors& pixel_errors, const BoardView& view,
                std::span<const TimedCircle> circles) {
  const CalibrationState& state = builder.parameters.moved();
  const NoiseScales& scales = builder.weights.scales;
  std::vector<CircleMeasurement> measured;
  measured.reserve(circles.size());
  for (const TimedCircle& circle : circles) {
    const CircleObservation& observed = view.circles[circle.index];
    measured.push_back(measurementOf(builder.input, state, builder.options, camera, observed,
                                     {scales.circles[camera], scales.displacements[camera]}));
    measured.back().pixel_error_px = pixel_errors.at(observed);
  }
  const SegmentTimes segments = segmentsBetween(state, circles.front().time_s, circles.back().time_s);
  return {circles.front().time_s, segments, std::make_unique<ViewCost>(model, segments, std::move(measured))};
}

std::vector<ViewPart> partsOf(const ProblemBuilder& builder, std::size_t camera, const CircleModel& model,
                              const PixelErrors& pixel_errors, std::size_t view) {
  const CalibrationState& state = builder.parameters.moved();
  const BoardObservations& observations = builder.input.cameras[camera].observations;
  std::vector<TimedCircle> circles = circlesWithin(state, state.cameras[camera], observations.views[view]);
  std::erase_if(circles, [&](const TimedCircle& circle) {
    return !builder.weights.used_circles[camera][view][circle.index];
  });
  std::ranges::stable_sort(circles, {}, &TimedCircle::time_s);
  std::vector<ViewPart> parts;
  for (std::span<const TimedCircle> rest = circles; !rest.empty();) {
    const auto part = rest.first(countOfPart(builder, observations.kind, rest));
    parts.push_back(partOf(builder, camera, model, pixel_errors, observations.views[view], part));
    rest = rest.subspan(part.size());
  }
  return parts;
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

// Cost functions are made in parallel, and added in order.
void addCircles(ProblemBuilder& builder, std::size_t camera, const CircleModel& model,
                const PixelErrors& pixel_errors) {
  constexpr std::size_t kAtOnce = 64;  // views of a thread
  const std::size_t views = builder.input.cameras[camera].observations.views.size();
  std::vector<std::vector<ViewPart>> parts(views);
  inParallel(builder.options.threads, (views + kAtOnce - 1) / kAtOnce, [&](std::size_t k) {
    for (std::size_t view = k * kAtOnce; view < std::min(views, (k + 1) * kAtOnce); ++view)
      parts[view] = partsOf(builder, camera, model, pixel_errors, view);
  });
  ParameterBlocks& parameters = builder.parameters;
  CalibrationState& state = parameters.moved();
  IntrinsicsBlock* const intrinsics = parameters.intrinsics(camera);
  for (std::vector<ViewPart>& of_view : parts) {
    for (ViewPart& part : of_view) {
      std::vector<double*> blocks = blocksOfView(state, part.segments, camera, parameters.sensorOf(camera),
                                                 builder.input.cameras[camera].board);
      if (intrinsics != nullptr) blocks.push_back(intrinsics->data());
      ViewCost* const cost = part.cost.release();
      builder.residuals.push_back({builder.problem.AddResidualBlock(cost, nullptr, blocks),
                                   SensorKind::Circles, camera, part.time_s, cost});
    }
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
