#include "core/optimisation/parameter_blocks.h"

#include "core/optimisation/bias_knots.h"
#include "core/optimisation/inertial_cost.h"
#include "core/optimisation/known_values.h"

#include <algorithm>
#include <type_traits>

namespace evical {
namespace {

// Offset and drift hardly correlate in the middle of the recording. An existing drift keeps its reference
// time.
template <class Sensor>
void startDrift(const So3Spline& trajectory, Sensor& sensor) {
  if (sensor.time_offset_drift_ppm == 0.0)
    sensor.time_offset_at_s = sensorTime_s(sensor, 0.5 * (trajectory.start_s + trajectory.endTime_s()));
}

// visit(matrix of one IMU, same matrix of another): matrices are blocks of their upper triangles.
template <class Visitor>
void forEachMatrix(const ImuState& imu, ImuState& other, Visitor&& visit) {
  forEachQuantity(kImuQuantities, [&](const auto& row) {
    if constexpr (std::is_same_v<decltype(row.value(other)), Eigen::Matrix3d&>)
      visit(row.value(imu), row.value(other));
  });
}

void copySensor(CameraState& from, CameraState& to) {
  forEachQuantity(kCameraQuantities, [&](const auto& row) {
    if (row.info.of_sensor) row.value(to) = row.value(from);
  });
}

}  // namespace

std::optional<Eigen::Index> columnOf(const QuantityAddress& number, const std::vector<Quantity>& quantities,
                                     const std::vector<Eigen::Index>& first_column) {
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const Eigen::Index column = first_column[i] + static_cast<Eigen::Index>(number.component);
    if (quantities[i].info->is(number.owner, number.id) && quantities[i].sensor == number.sensor &&
        column < first_column[i + 1])
      return column;
  }
  return std::nullopt;
}

ParameterBlocks::ParameterBlocks(const CalibrationInput& input, const OptimisationOptions& options,
                                 const CalibrationState& initial)
    : moved_(initial) {
  for (std::size_t i = 0; i < input.cameras.size(); ++i)
    sensors_.push_back(options.share_sensors ? input.sensorOf(i) : i);
  followSensors();
  for (CameraState& camera : moved_.cameras) startDrift(moved_.world_from_imu_rotation, camera);
  for (ImuState& imu : moved_.imus) startDrift(moved_.world_from_imu_rotation, imu);
  setGivenValues(input, options, moved_);
  for (std::size_t i = 0; i < moved_.imus.size(); ++i) {
    placeBiasKnots(options, input.imus[i].noise, moved_.world_from_imu_rotation, moved_.imus[i]);
    forEachMatrix(moved_.imus[i], moved_.imus[i], [&](const Eigen::Matrix3d& matrix, Eigen::Matrix3d&) {
      parametersFromMapping(matrix, triangles_[&matrix].data());
    });
  }
  for (std::size_t i = 0; i < input.cameras.size(); ++i) {
    const CameraData& camera = input.cameras[i];
    const bool free = options.freesIntrinsics() && ownsSensor(i);
    CameraLens lens = camera.lens;
    if (camera.same_sensor_as) lens.given_with.reset();  // one prior per sensor
    intrinsics_.push_back(free ? std::make_unique<IntrinsicsBlock>(lens, moved_.cameras[i], options)
                               : nullptr);
    if (!options.freesIntrinsics()) moved_.cameras[i].lens.solved.reset();
  }
}

CalibrationState ParameterBlocks::state() const {
  CalibrationState state = moved_;
  for (std::size_t i = 0; i < state.imus.size(); ++i)
    forEachMatrix(moved_.imus[i], state.imus[i], [&](const Eigen::Matrix3d& matrix, Eigen::Matrix3d& other) {
      other = mappingFromParameters(triangles_.at(&matrix).data());
    });
  for (std::size_t i = 0; i < state.cameras.size(); ++i)
    if (intrinsics_[i]) state.cameras[i].lens.solved = intrinsics_[i]->intrinsics();
  for (std::size_t i = 0; i < state.cameras.size(); ++i)
    if (!ownsSensor(i)) copySensor(state.cameras[sensorOf(i)], state.cameras[i]);
  return state;
}

void ParameterBlocks::followSensors() {
  for (std::size_t i = 0; i < moved_.cameras.size(); ++i)
    if (!ownsSensor(i)) copySensor(moved_.cameras[sensorOf(i)], moved_.cameras[i]);
}

SegmentTimes ParameterBlocks::segmentAt(double time_s) const {
  return evical::segmentAt(moved_.world_from_imu_rotation, moved_.imu_in_world_m, time_s);
}

void ParameterBlocks::appendRotation(const SegmentTimes& segment, std::vector<double*>& blocks) {
  auto* points = &moved_.world_from_imu_rotation.control_points[static_cast<std::size_t>(segment.rotation)];
  for (std::size_t k = 0; k < rotationPointsOf(segment); ++k) blocks.push_back(points[k].coeffs().data());
}

void ParameterBlocks::appendPosition(const SegmentTimes& segment, std::vector<double*>& blocks) {
  auto* points = &moved_.imu_in_world_m.control_points[static_cast<std::size_t>(segment.position)];
  for (std::size_t k = 0; k < positionPointsOf(segment); ++k) blocks.push_back(points[k].data());
}

double* ParameterBlocks::of(std::optional<CameraIntrinsics>& value) {
  for (std::size_t i = 0; i < moved_.cameras.size(); ++i)
    if (&moved_.cameras[i].lens.solved == &value && intrinsics_[i]) return intrinsics_[i]->data();
  return nullptr;
}

std::vector<Quantity> ParameterBlocks::quantities() {
  std::vector<Quantity> all;
  const auto add = [&](const QuantityInfo& info, std::size_t sensor, double* block) {
    if (block != nullptr) all.push_back({&info, sensor, block});
  };
  forEachSensorKind([&](auto kind) {
    for (std::size_t i = 0; i < kind.of(moved_).size(); ++i) {
      const bool follows = kind.kOwner == QuantityOwner::Camera && !ownsSensor(i);
      forEachQuantity(kind.rows(), [&](const auto& row) {
        if (!follows || !row.info.of_sensor) add(row.info, i, of(row.value(kind.of(moved_)[i])));
      });
    }
  });
  for (std::size_t i = 0; i <= moved_.further_boards.size(); ++i)
    forEachQuantity(kBoardQuantities,
                    [&](const auto& row) { add(row.info, i, of(row.value(moved_.boardAt(i)))); });
  add(kGravityQuantity, 0, moved_.gravity_in_world_m_s2.data());
  return all;
}

std::vector<Quantity> ParameterBlocks::biasKnots() {
  std::vector<Quantity> all;
  const QuantityInfo& gyroscope = quantityInfo(QuantityOwner::Imu, QuantityId::GyroscopeBias);
  const QuantityInfo& accelerometer = quantityInfo(QuantityOwner::Imu, QuantityId::AccelerometerBias);
  for (std::size_t i = 0; i < moved_.imus.size(); ++i) {
    BiasDrift& drift = moved_.imus[i].bias_drift;
    for (Eigen::Vector3d& knot : drift.gyroscope_rad_s) all.push_back({&gyroscope, i, knot.data()});
    for (Eigen::Vector3d& knot : drift.accelerometer_m_s2) all.push_back({&accelerometer, i, knot.data()});
  }
  return all;
}

std::vector<double*> ParameterBlocks::controlPoints() {
  struct Placed {
    double time_s;
    double* block;
  };
  std::vector<Placed> placed;
  const auto add = [&](double start_s, double spacing_s, std::size_t k, double* block) {
    placed.push_back({start_s + static_cast<double>(k) * spacing_s, block});
  };
  So3Spline& r = moved_.world_from_imu_rotation;
  VectorSpline& p = moved_.imu_in_world_m;
  for (std::size_t k = 0; k < r.control_points.size(); ++k)
    add(r.start_s, r.knot_spacing_s, k, r.control_points[k].coeffs().data());
  for (std::size_t k = 0; k < p.control_points.size(); ++k)
    add(p.start_s, p.knot_spacing_s, k, p.control_points[k].data());
  std::stable_sort(placed.begin(), placed.end(),
                   [](const Placed& a, const Placed& b) { return a.time_s < b.time_s; });
  std::vector<double*> blocks;
  for (const Placed& each : placed) blocks.push_back(each.block);
  return blocks;
}

}  // namespace evical
