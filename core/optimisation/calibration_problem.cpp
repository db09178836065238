#include "core/optimisation/calibration_problem.h"

#include "core/optimisation/edge_lead.h"
#include "core/optimisation/known_values.h"

#include "core/base/time.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

ceres::Problem::Options borrowManifolds() {
  ceres::Problem::Options options;
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

bool sameSegment(const SegmentTimes& a, const SegmentTimes& b) {
  return a.rotation == b.rotation && a.position == b.position;
}

}  // namespace

CalibrationProblem::CalibrationProblem(const CalibrationInput& input, const OptimisationOptions& options,
                                       const CalibrationState& initial)
    : input_(input), options_(options), state_(initial) {
  setGivenValues(input, options, state_);
  for (std::size_t i = 0; i < state_.imus.size() && i < input.imus.size(); ++i)
    placeBiasKnots(options, input.imus[i].noise, state_.world_from_imu_rotation, state_.imus[i]);
  gyroscope_mappings_.resize(state_.imus.size());
  accelerometer_mappings_.resize(state_.imus.size());
  for (std::size_t i = 0; i < state_.imus.size(); ++i) {
    parametersFromMapping(state_.imus[i].gyroscope_mapping, gyroscope_mappings_[i].data());
    parametersFromMapping(state_.imus[i].accelerometer_mapping, accelerometer_mappings_[i].data());
  }
  for (std::size_t i = 0; i < input.cameras.size(); ++i) {
    const CameraData& camera = input.cameras[i];
    const bool free = intrinsicsAreFree(camera, options);
    intrinsics_.push_back(
        free ? std::make_unique<IntrinsicsBlock>(*camera.intrinsics, state_.cameras[i], options) : nullptr);
    if (!free) state_.cameras[i].intrinsics.reset();
    circle_models_.push_back(std::make_unique<CircleModel>(
        CircleModel{*camera.intrinsics, input.board.radius_m, options.huber_sigma, free}));
    // Between cameras no wrong amplitude of one counts for much: where the board is, either sees anew.
    const double pixel_error_px = input.imus.empty() ? 0.0 : options.pixel_error_px;
    pixel_errors_.emplace_back(camera, input.board, pixel_error_px);
    auto& used = used_circles.emplace_back();
    for (const BoardView& view : camera.observations.views)
      used.emplace_back(view.circles.size(), std::uint8_t{1});
  }
  held_axes.resize(input.imus.size());
  scales.circles.assign(input.cameras.size(), 1.0);
  scales.gyroscopes.assign(input.imus.size(), 1.0);
  scales.accelerometers.assign(input.imus.size(), 1.0);
}

void CalibrationProblem::build(ReleaseStages stage) {
  blocks_.clear();
  assigned_offsets_s_.clear();
  for (const CameraState& camera : state_.cameras) assigned_offsets_s_.push_back(camera.time_offset_s);
  for (const ImuState& imu : state_.imus) assigned_offsets_s_.push_back(imu.time_offset_s);
  problem_ = std::make_unique<ceres::Problem>(borrowManifolds());
  for (std::size_t i = 0; i < state_.cameras.size(); ++i) addCircles(i);
  for (std::size_t i = 0; i < state_.imus.size(); ++i) {
    if (isReference(i) || stage != ReleaseStages::Extrinsics) addImu(i);
  }
  addPriors(stage);
  addKnownValues();
  if (input_.imus.empty()) addSmoothness();
  setManifolds(stage);
  if (input_.imus.empty()) holdReferenceCamera();
}

double CalibrationProblem::segmentDrift_knots() const {
  double largest_s = 0.0;
  for (std::size_t i = 0; i < state_.cameras.size(); ++i) {
    largest_s = std::max(largest_s, std::abs(state_.cameras[i].time_offset_s - assigned_offsets_s_[i]));
  }
  for (std::size_t i = 0; i < state_.imus.size(); ++i) {
    const double assigned_s = assigned_offsets_s_[state_.cameras.size() + i];
    largest_s = std::max(largest_s, std::abs(state_.imus[i].time_offset_s - assigned_s));
  }
  return largest_s /
         std::min(state_.world_from_imu_rotation.knot_spacing_s, state_.imu_in_world_m.knot_spacing_s);
}

const CalibrationState& CalibrationProblem::state() const {
  for (std::size_t i = 0; i < state_.imus.size(); ++i) {
    state_.imus[i].gyroscope_mapping = mappingFromParameters(gyroscope_mappings_[i].data());
    state_.imus[i].accelerometer_mapping = mappingFromParameters(accelerometer_mappings_[i].data());
  }
  for (std::size_t i = 0; i < state_.cameras.size(); ++i)
    if (intrinsics_[i]) state_.cameras[i].intrinsics = intrinsics_[i]->intrinsics();
  return state_;
}

SegmentTimes CalibrationProblem::segmentAt(double time_s) const {
  const So3Spline& r = state_.world_from_imu_rotation;
  const VectorSpline& p = state_.imu_in_world_m;
  SegmentTimes segment;
  segment.rotation = placeInSpline(r, time_s).segment;
  segment.position = placeInSpline(p.start_s, p.knot_spacing_s, p.segmentCount(), time_s).segment;
  segment.rotation_start_s = r.start_s + segment.rotation * r.knot_spacing_s;
  segment.position_start_s = p.start_s + segment.position * p.knot_spacing_s;
  segment.rotation_spacing_s = r.knot_spacing_s;
  segment.position_spacing_s = p.knot_spacing_s;
  return segment;
}

void CalibrationProblem::appendRotationBlocks(const SegmentTimes& segment, std::vector<double*>& blocks) {
  auto* points = &state_.world_from_imu_rotation.control_points[static_cast<std::size_t>(segment.rotation)];
  for (int k = 0; k < 4; ++k) blocks.push_back(points[k].coeffs().data());
}

void CalibrationProblem::appendPositionBlocks(const SegmentTimes& segment, std::vector<double*>& blocks) {
  auto* points = &state_.imu_in_world_m.control_points[static_cast<std::size_t>(segment.position)];
  for (int k = 0; k < 4; ++k) blocks.push_back(points[k].data());
}

CircleMeasurement CalibrationProblem::measurement(std::size_t camera, std::size_t view,
                                                  std::size_t circle) const {
  const CircleObservation& observed = input_.cameras[camera].observations.views[view].circles[circle];
  const double floor_px2 = options_.least_centre_sigma_px * options_.least_centre_sigma_px;
  const Eigen::Matrix2d covariance = scales.circles[camera] * scales.circles[camera] *
                                     (observed.covariance_px2 + floor_px2 * Eigen::Matrix2d::Identity());
  CircleMeasurement m;
  m.time_s = observed.time_s;
  m.on_board_m = input_.board.centre_m(observed.circle);
  m.centre_px = observed.centre_px;
  m.whitening_px = covariance.llt().matrixL().solve(Eigen::Matrix2d::Identity());
  m.lead = edgeLeadEffect(*input_.cameras[camera].intrinsics, observed, options_.rest_speed_px_s);
  m.pixel_error_px = pixel_errors_[camera].at(observed);
  m.view = static_cast<int>(view);
  m.circle = static_cast<int>(circle);
  return m;
}

void CalibrationProblem::addCircles(std::size_t camera) {
  CameraState& state = state_.cameras[camera];
  std::vector<CircleMeasurement> measurements;
  const auto& views = input_.cameras[camera].observations.views;
  for (std::size_t view = 0; view < views.size(); ++view) {
    for (std::size_t i = 0; i < views[view].circles.size(); ++i) {
      if (!used_circles[camera][view][i]) continue;
      const double time_s = views[view].circles[i].time_s + state.time_offset_s;
      if (!state_.world_from_imu_rotation.contains(time_s) || !state_.imu_in_world_m.contains(time_s))
        continue;
      measurements.push_back(measurement(camera, view, i));
    }
  }
  std::stable_sort(
      measurements.begin(), measurements.end(),
      [](const CircleMeasurement& a, const CircleMeasurement& b) { return a.time_s < b.time_s; });
  for (std::size_t begin = 0, end = 0; begin < measurements.size(); begin = end) {
    const SegmentTimes segment = segmentAt(measurements[begin].time_s + state.time_offset_s);
    while (end < measurements.size() &&
           sameSegment(segment, segmentAt(measurements[end].time_s + state.time_offset_s))) {
      ++end;
    }
    auto* cost = new CircleCost(*circle_models_[camera], segment,
                                {measurements.begin() + static_cast<std::ptrdiff_t>(begin),
                                 measurements.begin() + static_cast<std::ptrdiff_t>(end)});
    std::vector<double*> blocks;
    appendRotationBlocks(segment, blocks);
    appendPositionBlocks(segment, blocks);
    blocks.insert(blocks.end(), {state.reference_from_camera.rotation.coeffs().data(),
                                 state.reference_from_camera.translation_m.data(), &state.time_offset_s,
                                 &state.edge_lead_px, &state.edge_lead_growth_px});
    if (intrinsics_[camera]) blocks.push_back(intrinsics_[camera]->data());
    blocks_.push_back({problem_->AddResidualBlock(cost, nullptr, blocks), SensorKind::Circles, camera,
                       measurements[begin].time_s + state.time_offset_s, cost});
  }
}

void CalibrationProblem::addImu(std::size_t imu) {
  const auto& samples = input_.imus[imu].samples;
  const auto timeOf = [&](const ImuSample& sample) {
    return secondsSince(input_.start_ns, sample.time_ns) + state_.imus[imu].time_offset_s;
  };
  const auto inRotation = [&](double time_s) { return state_.world_from_imu_rotation.contains(time_s); };
  const auto inPosition = [&](double time_s) { return state_.imu_in_world_m.contains(time_s); };
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    const double begin_s = timeOf(samples[begin]);
    end = begin + 1;
    if (!inRotation(begin_s)) continue;
    const SegmentTimes segment = segmentAt(begin_s);
    while (end < samples.size() && inRotation(timeOf(samples[end])) &&
           inPosition(timeOf(samples[end])) == inPosition(begin_s) &&
           sameSegment(segment, segmentAt(timeOf(samples[end]))) &&
           sameBiasKnots(state_.imus[imu], begin_s, timeOf(samples[end]))) {
      ++end;
    }
    const std::span<const ImuSample> some(samples.data() + begin, end - begin);
    addGyroscope(imu, segment, begin_s, some);
    if (inPosition(begin_s)) addAccelerometer(imu, segment, begin_s, some);
  }
}

void CalibrationProblem::addGyroscope(std::size_t imu, const SegmentTimes& segment, double time_s,
                                      std::span<const ImuSample> samples) {
  ImuState& state = state_.imus[imu];
  const ImuData& data = input_.imus[imu];
  const double sigma = scales.gyroscopes[imu] * data.noise.gyroscope_density * std::sqrt(data.rate_hz());
  std::vector<InertialMeasurement> measurements;
  for (const ImuSample& sample : samples) {
    measurements.push_back({secondsSince(input_.start_ns, sample.time_ns), sample.angular_rate_rad_s});
  }
  std::vector<double*> blocks;
  appendRotationBlocks(segment, blocks);
  blocks.insert(blocks.end(), {state.gyroscope_bias_rad_s.data(), gyroscope_mappings_[imu].data(),
                               state.gyroscope_from_accelerometer.coeffs().data()});
  if (!isReference(imu)) {
    blocks.insert(blocks.end(), {state.reference_from_imu.rotation.coeffs().data(), &state.time_offset_s});
  }
  const auto drift = appendDriftBlocks(state.bias_drift, state.bias_drift.gyroscope_rad_s,
                                       measurements.front().time_s, blocks);
  auto* cost = new GyroscopeCost(roleOf(imu), sigma, segment, std::move(measurements), drift);
  blocks_.push_back({problem_->AddResidualBlock(cost, nullptr, blocks), SensorKind::Gyroscope, imu, time_s});
}

void CalibrationProblem::addAccelerometer(std::size_t imu, const SegmentTimes& segment, double time_s,
                                          std::span<const ImuSample> samples) {
  ImuState& state = state_.imus[imu];
  const ImuData& data = input_.imus[imu];
  const double sigma =
      scales.accelerometers[imu] * data.noise.accelerometer_density * std::sqrt(data.rate_hz());
  std::vector<InertialMeasurement> measurements;
  for (const ImuSample& sample : samples) {
    measurements.push_back({secondsSince(input_.start_ns, sample.time_ns), sample.specific_force_m_s2});
  }
  std::vector<double*> blocks;
  appendRotationBlocks(segment, blocks);
  appendPositionBlocks(segment, blocks);
  blocks.insert(blocks.end(), {state_.gravity_in_world_m_s2.data(), state.accelerometer_bias_m_s2.data(),
                               accelerometer_mappings_[imu].data()});
  if (!isReference(imu)) {
    blocks.insert(blocks.end(), {state.reference_from_imu.rotation.coeffs().data(),
                                 state.reference_from_imu.translation_m.data(), &state.time_offset_s});
  }
  const auto drift = appendDriftBlocks(state.bias_drift, state.bias_drift.accelerometer_m_s2,
                                       measurements.front().time_s, blocks);
  auto* cost = new AccelerometerCost(roleOf(imu), sigma, segment, std::move(measurements), drift);
  blocks_.push_back(
      {problem_->AddResidualBlock(cost, nullptr, blocks), SensorKind::Accelerometer, imu, time_s});
}

void CalibrationProblem::setManifolds(ReleaseStages stage) {
  const auto set = [&](double* block, ceres::Manifold* manifold) {
    if (problem_->HasParameterBlock(block)) problem_->SetManifold(block, manifold);
  };
  for (auto& point : state_.world_from_imu_rotation.control_points) set(point.coeffs().data(), &so3_);
  for (CameraState& camera : state_.cameras)
    set(camera.reference_from_camera.rotation.coeffs().data(), &so3_);
  for (std::size_t i = 0; i < state_.imus.size(); ++i) {
    double* gyroscope_rotation = state_.imus[i].gyroscope_from_accelerometer.coeffs().data();
    set(state_.imus[i].reference_from_imu.rotation.coeffs().data(), &so3_);
    set(gyroscope_rotation, &so3_);
    if (problem_->HasParameterBlock(gyroscope_rotation) && !turnsGyroscope(i, stage))
      problem_->SetParameterBlockConstant(gyroscope_rotation);
  }
  if (!options_.free_gravity_norm) set(state_.gravity_in_world_m_s2.data(), &sphere_);
  for (const auto& block : intrinsics_)
    if (block) block->hold(*problem_, stage == lastStage(options_));
  if (stage == ReleaseStages::Mappings) return;
  for (std::size_t i = 0; i < state_.imus.size(); ++i) {
    for (double* mapping : {gyroscope_mappings_[i].data(), accelerometer_mappings_[i].data()}) {
      if (problem_->HasParameterBlock(mapping)) problem_->SetParameterBlockConstant(mapping);
    }
  }
}

std::vector<Quantity> CalibrationProblem::quantities() {
  std::vector<Quantity> all;
  for (std::size_t i = 0; i < state_.cameras.size(); ++i) {
    CameraState& camera = state_.cameras[i];
    all.push_back({QuantityKind::CameraRotation, i, camera.reference_from_camera.rotation.coeffs().data()});
    all.push_back({QuantityKind::CameraTranslation, i, camera.reference_from_camera.translation_m.data()});
    all.push_back({QuantityKind::CameraTimeOffset, i, &camera.time_offset_s});
    all.push_back({QuantityKind::EdgeLead, i, &camera.edge_lead_px});
    all.push_back({QuantityKind::EdgeLeadGrowth, i, &camera.edge_lead_growth_px});
    if (intrinsics_[i]) all.push_back({QuantityKind::CameraIntrinsics, i, intrinsics_[i]->data()});
  }
  for (std::size_t i = 0; i < state_.imus.size(); ++i) {
    ImuState& imu = state_.imus[i];
    all.push_back({QuantityKind::ImuRotation, i, imu.reference_from_imu.rotation.coeffs().data()});
    all.push_back({QuantityKind::ImuTranslation, i, imu.reference_from_imu.translation_m.data()});
    all.push_back({QuantityKind::ImuTimeOffset, i, &imu.time_offset_s});
    all.push_back({QuantityKind::GyroscopeBias, i, imu.gyroscope_bias_rad_s.data()});
    all.push_back({QuantityKind::AccelerometerBias, i, imu.accelerometer_bias_m_s2.data()});
    all.push_back({QuantityKind::GyroscopeMapping, i, gyroscope_mappings_[i].data()});
    all.push_back({QuantityKind::AccelerometerMapping, i, accelerometer_mappings_[i].data()});
    all.push_back({QuantityKind::GyroscopeRotation, i, imu.gyroscope_from_accelerometer.coeffs().data()});
  }
  all.push_back({QuantityKind::GravityDirection, 0, state_.gravity_in_world_m_s2.data()});
  std::erase_if(all, [&](const Quantity& q) {
    return !problem_->HasParameterBlock(q.block) || problem_->IsParameterBlockConstant(q.block);
  });
  return all;
}

std::vector<Quantity> CalibrationProblem::driftBlocks() {
  std::vector<Quantity> all;
  for (std::size_t i = 0; i < state_.imus.size(); ++i) {
    BiasDrift& drift = state_.imus[i].bias_drift;
    for (Eigen::Vector3d& knot : drift.gyroscope_rad_s)
      all.push_back({QuantityKind::GyroscopeBias, i, knot.data()});
    for (Eigen::Vector3d& knot : drift.accelerometer_m_s2)
      all.push_back({QuantityKind::AccelerometerBias, i, knot.data()});
  }
  std::erase_if(all, [&](const Quantity& q) { return !problem_->HasParameterBlock(q.block); });
  return all;
}

std::vector<double*> CalibrationProblem::splineBlocks() {
  struct Placed {
    double time_s;
    double* block;
  };
  std::vector<Placed> placed;
  const auto add = [&](double start_s, double spacing_s, std::size_t k, double* block) {
    if (problem_->HasParameterBlock(block))
      placed.push_back({start_s + static_cast<double>(k) * spacing_s, block});
  };
  So3Spline& r = state_.world_from_imu_rotation;
  VectorSpline& p = state_.imu_in_world_m;
  for (std::size_t k = 0; k < r.control_points.size(); ++k) {
    add(r.start_s, r.knot_spacing_s, k, r.control_points[k].coeffs().data());
  }
  for (std::size_t k = 0; k < p.control_points.size(); ++k) {
    add(p.start_s, p.knot_spacing_s, k, p.control_points[k].data());
  }
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed& a, const Placed& b) { return a.time_s < b.time_s; });
  std::vector<double*> blocks;
  for (const Placed& each : placed) blocks.push_back(each.block);
  return blocks;
}

}  // namespace evical
