#include "core/optimisation/inertial_cost.h"

#include "core/geometry/so3.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"

namespace evical {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

template <int Columns>
auto rowsOf(double** jacobians, int block, Eigen::Index row) {
  return Eigen::Map<Eigen::Matrix<double, 3, Columns, Columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>>(
      jacobians[block] + row * Columns);
}

void writeRotation(double** jacobians, int block, Eigen::Index row, const Matrix3d& by_delta) {
  auto rows = rowsOf<4>(jacobians, block, row);
  rows.leftCols<3>() = by_delta;
  rows.col(3).setZero();
}

// d(M v)/d(upper triangle), times the weight.
void writeMapping(double** jacobians, int block, Eigen::Index row, const Vector3d& v, double weight) {
  auto rows = rowsOf<6>(jacobians, block, row);
  const Vector3d w = weight * v;
  rows << w.x(), w.y(), w.z(), 0.0, 0.0, 0.0,  //
      0.0, 0.0, 0.0, w.y(), w.z(), 0.0,        //
      0.0, 0.0, 0.0, 0.0, 0.0, w.z();
}

bool anyOf(double** jacobians, int first, int count) {
  if (!jacobians) return false;
  for (int i = first; i < first + count; ++i) {
    if (jacobians[i]) return true;
  }
  return false;
}

// The specific force at the IMU's place in the reference IMU's frame, without the IMU's own rotation.
struct SpecificForce {
  Vector3d from_motion;  // R_wb^T (p'' - g)
  Vector3d total;
};

SpecificForce specificForce(const RotationSample& rotation, const VectorSample& position,
                            const Vector3d& gravity, const Vector3d& lever_arm) {
  const Vector3d from_motion = rotation.rotation.transpose() * (position.acceleration - gravity);
  const Vector3d& w = rotation.angular_velocity_rad_s;
  return {from_motion,
          from_motion + rotation.angular_acceleration_rad_s2.cross(lever_arm) + w.cross(w.cross(lever_arm))};
}

}  // namespace

Matrix3d mappingFromParameters(const double* m) {
  Matrix3d mapping;
  mapping << m[0], m[1], m[2], 0.0, m[3], m[4], 0.0, 0.0, m[5];
  return mapping;
}

void parametersFromMapping(const Matrix3d& mapping, double* m) {
  m[0] = mapping(0, 0), m[1] = mapping(0, 1), m[2] = mapping(0, 2);
  m[3] = mapping(1, 1), m[4] = mapping(1, 2), m[5] = mapping(2, 2);
}

GyroscopeCost::GyroscopeCost(ImuRole role, double sigma_rad_s, const SegmentTimes& segment,
                             std::vector<InertialMeasurement> samples)
    : role_(role), weight_(1.0 / sigma_rad_s), segment_(segment), samples_(std::move(samples)) {
  *mutable_parameter_block_sizes() = {4, 4, 4, 4, 3, 6};
  if (role == ImuRole::Further) {
    mutable_parameter_block_sizes()->push_back(4);
    mutable_parameter_block_sizes()->push_back(1);
  }
  set_num_residuals(3 * static_cast<int>(samples_.size()));
}

bool GyroscopeCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  enum { kBias = 4, kMapping, kRotation, kTimeOffset };
  const bool further = role_ == ImuRole::Further;
  const Eigen::Map<const Vector3d> bias(parameters[kBias]);
  const Matrix3d mapping = weight_ * mappingFromParameters(parameters[kMapping]);
  Matrix3d imu_from_reference = Matrix3d::Identity();
  if (further) {
    imu_from_reference =
        Eigen::Map<const Eigen::Quaterniond>(parameters[kRotation]).toRotationMatrix().transpose();
  }
  const double time_offset_s = further ? *parameters[kTimeOffset] : 0.0;
  const bool by_spline = anyOf(jacobians, 0, 4), by_time = further && jacobians && jacobians[kTimeOffset];
  const Matrix3d by_rate = mapping * imu_from_reference;
  const So3Segment rotation_segment(parameters[0], parameters[1], parameters[2], parameters[3],
                                    segment_.rotation_spacing_s, by_spline);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    const double time_s = samples_[i].time_s + time_offset_s;
    RotationSample rotation;
    RotationJacobians by_control_points;
    rotation_segment.evaluate((time_s - segment_.rotation_start_s) / segment_.rotation_spacing_s,
                              by_time ? RotationOrder::Acceleration : RotationOrder::Velocity, rotation,
                              by_spline ? &by_control_points : nullptr);
    const Vector3d rate = imu_from_reference * rotation.angular_velocity_rad_s;
    Eigen::Map<Vector3d>(residuals + row) = mapping * rate + weight_ * (bias - samples_[i].value);
    if (!jacobians) continue;
    for (int k = 0; k < 4; ++k) {
      if (jacobians[k])
        writeRotation(jacobians, k, row, by_rate * by_control_points.velocity[static_cast<std::size_t>(k)]);
    }
    if (jacobians[kBias]) rowsOf<3>(jacobians, kBias, row) = weight_ * Matrix3d::Identity();
    if (jacobians[kMapping]) writeMapping(jacobians, kMapping, row, rate, weight_);
    if (further && jacobians[kRotation]) writeRotation(jacobians, kRotation, row, mapping * skew(rate));
    if (by_time) rowsOf<1>(jacobians, kTimeOffset, row) = by_rate * rotation.angular_acceleration_rad_s2;
  }
  return true;
}

AccelerometerCost::AccelerometerCost(ImuRole role, double sigma_m_s2, const SegmentTimes& segment,
                                     std::vector<InertialMeasurement> samples)
    : role_(role), weight_(1.0 / sigma_m_s2), segment_(segment), samples_(std::move(samples)) {
  *mutable_parameter_block_sizes() = {4, 4, 4, 4, 3, 3, 3, 3, 3, 3, 6};
  if (role == ImuRole::Further)
    mutable_parameter_block_sizes()->insert(parameter_block_sizes().end(), {4, 3, 1});
  set_num_residuals(3 * static_cast<int>(samples_.size()));
}

bool AccelerometerCost::Evaluate(double const* const* parameters, double* residuals,
                                 double** jacobians) const {
  enum { kPosition = 4, kGravity = 8, kBias, kMapping, kRotation, kLeverArm, kTimeOffset };
  const bool further = role_ == ImuRole::Further;
  const double* const* p = parameters + kPosition;
  const Eigen::Map<const Vector3d> gravity(parameters[kGravity]), bias(parameters[kBias]);
  const Matrix3d mapping = weight_ * mappingFromParameters(parameters[kMapping]);
  Matrix3d imu_from_reference = Matrix3d::Identity();
  Vector3d lever_arm = Vector3d::Zero();
  if (further) {
    imu_from_reference =
        Eigen::Map<const Eigen::Quaterniond>(parameters[kRotation]).toRotationMatrix().transpose();
    lever_arm = Eigen::Map<const Vector3d>(parameters[kLeverArm]);
  }
  const double time_offset_s = further ? *parameters[kTimeOffset] : 0.0;
  const bool by_spline = anyOf(jacobians, 0, 4);
  const RotationOrder order = further ? RotationOrder::Acceleration : RotationOrder::Rotation;
  const Matrix3d by_force = mapping * imu_from_reference;
  const So3Segment rotation_segment(parameters[0], parameters[1], parameters[2], parameters[3],
                                    segment_.rotation_spacing_s, by_spline);
  const auto rotationPlace = [&](double t_s) {
    return (t_s - segment_.rotation_start_s) / segment_.rotation_spacing_s;
  };
  const auto positionAt = [&](double t_s) {
    return evaluateVectorSegment(p[0], p[1], p[2], p[3],
                                 (t_s - segment_.position_start_s) / segment_.position_spacing_s,
                                 segment_.position_spacing_s);
  };
  // The angular jerk isn't worth a formula: it acts through the lever arm of further IMUs only.
  const auto forceRate = [&](double t_s) -> Vector3d {
    const double step_s = 1e-4 * segment_.rotation_spacing_s;
    RotationSample before, after;
    rotation_segment.evaluate(rotationPlace(t_s - step_s), order, before);
    rotation_segment.evaluate(rotationPlace(t_s + step_s), order, after);
    return (specificForce(after, positionAt(t_s + step_s), gravity, lever_arm).total -
            specificForce(before, positionAt(t_s - step_s), gravity, lever_arm).total) /
           (2.0 * step_s);
  };
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    const double time_s = samples_[i].time_s + time_offset_s;
    RotationSample rotation;
    rotation.angular_velocity_rad_s.setZero();
    rotation.angular_acceleration_rad_s2.setZero();
    RotationJacobians by_control_points;
    rotation_segment.evaluate(rotationPlace(time_s), order, rotation,
                              by_spline ? &by_control_points : nullptr);
    const VectorSample position = positionAt(time_s);
    const SpecificForce force = specificForce(rotation, position, gravity, lever_arm);
    const Vector3d in_imu = imu_from_reference * force.total;
    Eigen::Map<Vector3d>(residuals + row) = mapping * in_imu + weight_ * (bias - samples_[i].value);
    if (!jacobians) continue;
    const Matrix3d by_world = by_force * rotation.rotation.transpose();
    if (by_spline) {
      const Matrix3d by_attitude = by_force * skew(force.from_motion);
      Matrix3d by_velocity, by_acceleration;
      if (further) {
        const Vector3d& w = rotation.angular_velocity_rad_s;
        by_velocity = -by_force * (skew(w.cross(lever_arm)) + skew(w) * skew(lever_arm));
        by_acceleration = -by_force * skew(lever_arm);
      }
      for (int k = 0; k < 4; ++k) {
        if (!jacobians[k]) continue;
        const auto c = static_cast<std::size_t>(k);
        Matrix3d by_point = by_attitude * by_control_points.rotation[c];
        if (further) {
          by_point += by_velocity * by_control_points.velocity[c] +
                      by_acceleration * by_control_points.acceleration[c];
        }
        writeRotation(jacobians, k, row, by_point);
      }
    }
    for (int k = 0; k < 4; ++k) {
      if (jacobians[kPosition + k]) {
        rowsOf<3>(jacobians, kPosition + k, row) = position.acceleration_weights[k] * by_world;
      }
    }
    if (jacobians[kGravity]) rowsOf<3>(jacobians, kGravity, row) = -by_world;
    if (jacobians[kBias]) rowsOf<3>(jacobians, kBias, row) = weight_ * Matrix3d::Identity();
    if (jacobians[kMapping]) writeMapping(jacobians, kMapping, row, in_imu, weight_);
    if (!further) continue;
    if (jacobians[kRotation]) writeRotation(jacobians, kRotation, row, mapping * skew(in_imu));
    if (jacobians[kLeverArm]) {
      const Matrix3d w = skew(rotation.angular_velocity_rad_s);
      rowsOf<3>(jacobians, kLeverArm, row) = by_force * (skew(rotation.angular_acceleration_rad_s2) + w * w);
    }
    if (jacobians[kTimeOffset]) rowsOf<1>(jacobians, kTimeOffset, row) = by_force * forceRate(time_s);
  }
  return true;
}

}  // namespace evical
