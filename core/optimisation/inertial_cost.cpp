#include "core/optimisation/inertial_cost.h"

#include "core/geometry/so3.h"
#include "core/optimisation/bias_knots.h"

namespace evical {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void writeMapping(double** jacobians, int block, Eigen::Index row, const Vector3d& v, double weight) {
  jacobianRows<3, 6>(jacobians, block, row) = derivativeByMapping(weight * v);
}

// Derivatives by the time offset, whose block is `first`, and by its drift, the next one.
void writeTimeRows(double** jacobians, int first, Eigen::Index row, const Vector3d& by_time,
                   const InertialMeasurement& sample) {
  if (jacobians[first]) jacobianRows<3, 1>(jacobians, first, row) = by_time;
  if (jacobians[first + 1]) jacobianRows<3, 1>(jacobians, first + 1, row) = sample.by_drift_s * by_time;
}

// Adds the weighted drift to the samples' residuals; its two blocks are the last, starting at `first`.
void addDrift(const DriftTimes& drift, const std::vector<InertialMeasurement>& samples, double weight,
              int first, double const* const* parameters, double* residuals, double** jacobians) {
  const Eigen::Map<const Vector3d> before(parameters[first]), after(parameters[first + 1]);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    const double share = drift.shareAt(samples[i].time_s);
    Eigen::Map<Vector3d>(residuals + row) += weight * ((1.0 - share) * before + share * after);
    if (!jacobians) continue;
    if (jacobians[first])
      jacobianRows<3, 3>(jacobians, first, row) = weight * (1.0 - share) * Matrix3d::Identity();
    if (jacobians[first + 1])
      jacobianRows<3, 3>(jacobians, first + 1, row) = weight * share * Matrix3d::Identity();
  }
}

void appendDriftBlocks(std::vector<int>& sizes) {
  sizes.insert(sizes.end(), {3, 3});
}

bool anyOf(double** jacobians, int first, int count) {
  if (!jacobians) return false;
  for (int i = first; i < first + count; ++i) {
    if (jacobians[i]) return true;
  }
  return false;
}

// Specific force at the IMU's position in the reference IMU's frame, without the IMU's own rotation.
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

enum AccelerometerBlock {
  kImuPosition = 4,
  kGravity = 8,
  kForceBias,
  kForceMapping,
  kDelay,
  kForceRotation,
  kLeverArm,
  kForceTimeOffset,
  kForceTimeOffsetDrift
};

// The accelerometer's blocks, converted.
struct Accelerometer {
  bool further;
  Vector3d gravity, bias, lever_arm = Vector3d::Zero();
  Matrix3d mapping, imu_from_reference = Matrix3d::Identity();  // mapping: times the weight
  double weight, delay_s, time_offset_s = 0.0, time_offset_drift_ppm = 0.0;

  Accelerometer(ImuRole role, double sample_weight, double const* const* parameters)
      : further(role == ImuRole::Further),
        gravity(parameters[kGravity]),
        bias(parameters[kForceBias]),
        mapping(sample_weight * mappingFromParameters(parameters[kForceMapping])),
        weight(sample_weight),
        delay_s(*parameters[kDelay]) {
    if (!further) return;
    imu_from_reference =
        Eigen::Map<const Eigen::Quaterniond>(parameters[kForceRotation]).toRotationMatrix().transpose();
    lever_arm = Eigen::Map<const Vector3d>(parameters[kLeverArm]);
    time_offset_s = *parameters[kForceTimeOffset];
    time_offset_drift_ppm = *parameters[kForceTimeOffsetDrift];
  }
  // Time on the reference's clock.
  double timeOf_s(const InertialMeasurement& sample) const {
    return sample.time_s + time_offset_s + sample.by_drift_s * time_offset_drift_ppm - delay_s;
  }
  // Angular rates change the force through the lever arm, and its derivative by time through the rotation.
  RotationOrder order(bool with_rate) const {
    return further     ? RotationOrder::Acceleration
           : with_rate ? RotationOrder::Velocity
                       : RotationOrder::Rotation;
  }
};

struct MotionAtSample {
  RotationSample rotation;
  RotationJacobians by_control_points;
  VectorSample position;

  MotionAtSample() {
    rotation.angular_velocity_rad_s.setZero();
    rotation.angular_acceleration_rad_s2.setZero();
  }
};

// Derivatives of one sample's residual by both splines' control points.
void writeSplineRows(const Accelerometer& model, const MotionAtSample& motion, const SpecificForce& force,
                     Eigen::Index row, double** jacobians) {
  const Matrix3d by_force = model.mapping * model.imu_from_reference;
  const Matrix3d by_world = by_force * motion.rotation.rotation.transpose();
  const Matrix3d by_attitude = by_force * skew(force.from_motion);
  const Vector3d& w = motion.rotation.angular_velocity_rad_s;
  const Matrix3d arm = skew(model.lever_arm);
  const Matrix3d by_velocity = -by_force * (skew(w.cross(model.lever_arm)) + skew(w) * arm);
  const Matrix3d by_acceleration = -by_force * arm;
  for (int k = 0; k < 4; ++k) {
    const auto point = static_cast<std::size_t>(k);
    if (jacobians[k]) {
      Matrix3d by_point = by_attitude * motion.by_control_points.rotation[point];
      if (model.further) {
        by_point += by_velocity * motion.by_control_points.velocity[point] +
                    by_acceleration * motion.by_control_points.acceleration[point];
      }
      writeRotationRows<3>(jacobians, k, row, by_point);
    }
    if (jacobians[kImuPosition + k]) {
      jacobianRows<3, 3>(jacobians, kImuPosition + k, row) =
          motion.position.acceleration_weights[k] * by_world;
    }
  }
}

// Derivatives by the delay, and by the time offset and its drift.
void writeTimeRows(const Accelerometer& model, const Vector3d& force_rate, const InertialMeasurement& sample,
                   Eigen::Index row, double** jacobians) {
  const Vector3d by_time = model.mapping * (model.imu_from_reference * force_rate);
  if (jacobians[kDelay]) jacobianRows<3, 1>(jacobians, kDelay, row) = -by_time;
  if (model.further) writeTimeRows(jacobians, kForceTimeOffset, row, by_time, sample);
}

// Derivatives by everything else except times.
void writeModelRows(const Accelerometer& model, const MotionAtSample& motion, const SpecificForce& force,
                    Eigen::Index row, double** jacobians) {
  const Matrix3d by_force = model.mapping * model.imu_from_reference;
  const Vector3d in_imu = model.imu_from_reference * force.total;
  if (jacobians[kGravity]) {
    jacobianRows<3, 3>(jacobians, kGravity, row) = -by_force * motion.rotation.rotation.transpose();
  }
  if (jacobians[kForceBias])
    jacobianRows<3, 3>(jacobians, kForceBias, row) = model.weight * Matrix3d::Identity();
  if (jacobians[kForceMapping]) writeMapping(jacobians, kForceMapping, row, in_imu, model.weight);
  if (!model.further) return;
  if (jacobians[kForceRotation]) {
    writeRotationRows<3>(jacobians, kForceRotation, row, model.mapping * skew(in_imu));
  }
  if (jacobians[kLeverArm]) {
    const Matrix3d w = skew(motion.rotation.angular_velocity_rad_s);
    jacobianRows<3, 3>(jacobians, kLeverArm, row) =
        by_force * (skew(motion.rotation.angular_acceleration_rad_s2) + w * w);
  }
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

Eigen::Matrix<double, 3, 6> derivativeByMapping(const Vector3d& v) {
  Eigen::Matrix<double, 3, 6> derivative;
  derivative << v.x(), v.y(), v.z(), 0.0, 0.0, 0.0,  //
      0.0, 0.0, 0.0, v.y(), v.z(), 0.0,              //
      0.0, 0.0, 0.0, 0.0, 0.0, v.z();
  return derivative;
}

GyroscopeCost::GyroscopeCost(ImuRole role, double sigma_rad_s, const SegmentTimes& segment,
                             std::vector<InertialMeasurement> samples, std::optional<DriftTimes> drift)
    : role_(role),
      weight_(1.0 / sigma_rad_s),
      segment_(segment),
      samples_(std::move(samples)),
      drift_(drift) {
  *mutable_parameter_block_sizes() = {4, 4, 4, 4, 3, 6, 4};
  if (role == ImuRole::Further) {
    mutable_parameter_block_sizes()->insert(parameter_block_sizes().end(), {4, 1, 1});
  }
  if (drift) appendDriftBlocks(*mutable_parameter_block_sizes());
  set_num_residuals(3 * static_cast<int>(samples_.size()));
}

bool GyroscopeCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  enum { kBias = 4, kMapping, kGyroscopeRotation, kRotation, kTimeOffset, kTimeOffsetDrift };
  const bool further = role_ == ImuRole::Further;
  const Eigen::Map<const Vector3d> bias(parameters[kBias]);
  const Matrix3d gyroscope_from_imu =
      Eigen::Map<const Eigen::Quaterniond>(parameters[kGyroscopeRotation]).toRotationMatrix();
  const Matrix3d by_imu_rate = weight_ * mappingFromParameters(parameters[kMapping]) * gyroscope_from_imu;
  Matrix3d imu_from_reference = Matrix3d::Identity();
  if (further) {
    imu_from_reference =
        Eigen::Map<const Eigen::Quaterniond>(parameters[kRotation]).toRotationMatrix().transpose();
  }
  const double time_offset_s = further ? *parameters[kTimeOffset] : 0.0;
  const double drift_ppm = further ? *parameters[kTimeOffsetDrift] : 0.0;
  const bool by_spline = anyOf(jacobians, 0, 4), by_time = further && anyOf(jacobians, kTimeOffset, 2);
  const Matrix3d by_rate = by_imu_rate * imu_from_reference;
  const So3Segment rotation_segment = rotationSegment(segment_, parameters, by_spline);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    const double time_s = samples_[i].time_s + time_offset_s + samples_[i].by_drift_s * drift_ppm;
    RotationSample rotation;
    RotationJacobians by_control_points;
    rotation_segment.evaluate(segment_.rotationPlace(time_s),
                              by_time ? RotationOrder::Acceleration : RotationOrder::Velocity, rotation,
                              by_spline ? &by_control_points : nullptr);
    const Vector3d rate = imu_from_reference * rotation.angular_velocity_rad_s;
    Eigen::Map<Vector3d>(residuals + row) = by_imu_rate * rate + weight_ * (bias - samples_[i].value);
    if (!jacobians) continue;
    for (int k = 0; k < 4; ++k) {
      if (jacobians[k])
        writeRotationRows<3>(jacobians, k, row,
                             by_rate * by_control_points.velocity[static_cast<std::size_t>(k)]);
    }
    if (jacobians[kBias]) jacobianRows<3, 3>(jacobians, kBias, row) = weight_ * Matrix3d::Identity();
    if (jacobians[kMapping]) writeMapping(jacobians, kMapping, row, gyroscope_from_imu * rate, weight_);
    if (jacobians[kGyroscopeRotation])
      writeRotationRows<3>(jacobians, kGyroscopeRotation, row, -by_imu_rate * skew(rate));
    if (further && jacobians[kRotation])
      writeRotationRows<3>(jacobians, kRotation, row, by_imu_rate * skew(rate));
    if (by_time)
      writeTimeRows(jacobians, kTimeOffset, row, by_rate * rotation.angular_acceleration_rad_s2, samples_[i]);
  }
  if (drift_) {
    const int first = static_cast<int>(parameter_block_sizes().size()) - 2;
    addDrift(*drift_, samples_, weight_, first, parameters, residuals, jacobians);
  }
  return true;
}

AccelerometerCost::AccelerometerCost(ImuRole role, double sigma_m_s2, const SegmentTimes& segment,
                                     std::vector<InertialMeasurement> samples,
                                     std::optional<DriftTimes> drift)
    : role_(role), weight_(1.0 / sigma_m_s2), segment_(segment), samples_(std::move(samples)), drift_(drift) {
  *mutable_parameter_block_sizes() = {4, 4, 4, 4, 3, 3, 3, 3, 3, 3, 6, 1};
  if (role == ImuRole::Further)
    mutable_parameter_block_sizes()->insert(parameter_block_sizes().end(), {4, 3, 1, 1});
  if (drift) appendDriftBlocks(*mutable_parameter_block_sizes());
  set_num_residuals(3 * static_cast<int>(samples_.size()));
}

bool AccelerometerCost::Evaluate(double const* const* parameters, double* residuals,
                                 double** jacobians) const {
  const Accelerometer model(role_, weight_, parameters);
  const bool by_spline = anyOf(jacobians, 0, kGravity);
  const bool by_time =
      anyOf(jacobians, kDelay, 1) || (model.further && anyOf(jacobians, kForceTimeOffset, 2));
  const So3Segment rotation_segment = rotationSegment(segment_, parameters, by_spline);
  const auto moveTo = [&](double time_s, MotionAtSample& motion, bool with_jacobians) {
    rotation_segment.evaluate(segment_.rotationPlace(time_s), model.order(by_time), motion.rotation,
                              with_jacobians ? &motion.by_control_points : nullptr);
    motion.position = positionAt(segment_, parameters + kImuPosition, time_s);
  };
  const Vector3d jerk = jerkOf(segment_, parameters + kImuPosition);
  // The angular jerk is omitted: it acts only through the lever arm of further IMUs.
  const auto forceRate = [&](double time_s, const MotionAtSample& at,
                             const SpecificForce& force) -> Vector3d {
    if (!model.further)
      return at.rotation.rotation.transpose() * jerk -
             at.rotation.angular_velocity_rad_s.cross(force.from_motion);
    const double step_s = 1e-4 * segment_.rotation_spacing_s;
    MotionAtSample before, after;
    moveTo(time_s - step_s, before, false);
    moveTo(time_s + step_s, after, false);
    return (specificForce(after.rotation, after.position, model.gravity, model.lever_arm).total -
            specificForce(before.rotation, before.position, model.gravity, model.lever_arm).total) /
           (2.0 * step_s);
  };
  MotionAtSample motion;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    const double time_s = model.timeOf_s(samples_[i]);
    moveTo(time_s, motion, by_spline);
    const SpecificForce force =
        specificForce(motion.rotation, motion.position, model.gravity, model.lever_arm);
    Eigen::Map<Vector3d>(residuals + row) =
        model.mapping * (model.imu_from_reference * force.total) + weight_ * (model.bias - samples_[i].value);
    if (!jacobians) continue;
    if (by_spline) writeSplineRows(model, motion, force, row, jacobians);
    writeModelRows(model, motion, force, row, jacobians);
    if (by_time) writeTimeRows(model, forceRate(time_s, motion, force), samples_[i], row, jacobians);
  }
  if (drift_) {
    const int first = static_cast<int>(parameter_block_sizes().size()) - 2;
    addDrift(*drift_, samples_, weight_, first, parameters, residuals, jacobians);
  }
  return true;
}

}  // namespace evical
