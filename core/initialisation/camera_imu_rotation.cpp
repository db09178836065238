#include "core/initialisation/camera_imu_rotation.h"

#include "core/geometry/so3.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

// Rotation from the camera's rotation vectors to the gyroscope's (G.
// Wahba's problem, by SVD), with robust weights.
void alignVectors(const std::vector<RotationPair>& pairs, const std::vector<Eigen::Vector3d>& felt,
                  double scale_rad, RelativeRotation& result) {
  Eigen::Matrix3d rotation = result.reference_from_sensor.toRotationMatrix();
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d sums = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const double error = (felt[k] - rotation * pairs[k].seen_rad).norm() / scale_rad;
      // The first round does not have a rotation yet.
      const double weight = round == 0 ? 1.0 : cauchyWeight(error * error);
      sums += weight * felt[k] * pairs[k].seen_rad.transpose();
    }
    const BestRotation best = bestRotation(sums);
    rotation = best.matrix;
    // Strengths are mean squares of rotation about each axis.
    result.axis_ratio = std::sqrt(best.strengths[1] / std::max(best.strengths[0], 1e-12));
    result.main_axis_in_imu = best.main_axis;
  }
  result.reference_from_sensor = Eigen::Quaterniond(rotation);
}

std::vector<Eigen::Vector3d> feltRotations(const std::vector<RotationPair>& pairs, const GyroRotation& gyro,
                                           double offset_s) {
  std::vector<Eigen::Vector3d> felt;
  felt.reserve(pairs.size());
  for (const RotationPair& pair : pairs)
    felt.push_back(gyro.between(pair.from_s + offset_s, pair.to_s + offset_s));
  return felt;
}

// Given values are treated as certain: information beyond that of any recording.
Vector7 holding(bool rotation, bool offset) {
  constexpr double kCertain = 1e12;
  Vector7 information = Vector7::Zero();
  if (rotation) information.head<3>().setConstant(kCertain);
  if (offset) information(3) = kCertain;
  return information;
}

// One Gauss-Newton step on rotation, offset and bias; returns the robust RMS before it.
double step(const std::vector<RotationPair>& pairs, const GyroRotation& gyro, double scale_rad,
            const Vector7& held, RelativeRotation& result) {
  constexpr double kDelta_s = 1e-3;
  const auto now = feltRotations(pairs, gyro, result.time_offset_s);
  const auto before = feltRotations(pairs, gyro, result.time_offset_s - kDelta_s);
  const auto after = feltRotations(pairs, gyro, result.time_offset_s + kDelta_s);
  const Eigen::Matrix3d rotation = result.reference_from_sensor.toRotationMatrix();
  Matrix7 matrix = Matrix7::Zero();
  Vector7 vector = Vector7::Zero();
  double squares = 0.0, weights = 0.0, cost = 0.0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const double duration_s = pairs[k].to_s - pairs[k].from_s;
    const Eigen::Vector3d turned = rotation * pairs[k].seen_rad;
    const Eigen::Vector3d error = now[k] - turned - result.gyroscope_bias_rad_s * duration_s;
    const double weight = cauchyWeight(error.squaredNorm() / (scale_rad * scale_rad));
    Eigen::Matrix<double, 3, 7> jacobian;
    jacobian.leftCols<3>() = rotation * skew(pairs[k].seen_rad);
    jacobian.col(3) = (after[k] - before[k]) / (2.0 * kDelta_s);
    jacobian.rightCols<3>() = -duration_s * Eigen::Matrix3d::Identity();
    matrix += weight * jacobian.transpose() * jacobian;
    vector -= weight * jacobian.transpose() * error;
    squares += weight * error.squaredNorm();
    weights += weight;
    cost -= std::log(weight);
  }
  // Keeps undetermined directions unchanged: priors of 1 rad, 10 ms, 0.1 rad/s at the noise's scale.
  const double noise2 = scale_rad * scale_rad;
  matrix.diagonal() += noise2 * (Vector7() << 1.0, 1.0, 1.0, 1e4, 100.0, 100.0, 100.0).finished();
  matrix.diagonal() += held;
  const Vector7 delta = matrix.ldlt().solve(vector);
  result.reference_from_sensor = (result.reference_from_sensor * quaternionExp(delta.head<3>())).normalized();
  constexpr double kLongestStep_s = 0.03;
  result.time_offset_s += std::clamp(delta(3), -kLongestStep_s, kLongestStep_s);
  result.gyroscope_bias_rad_s += delta.tail<3>();
  result.cost = cost / static_cast<double>(pairs.size());
  return std::sqrt(squares / std::max(weights, 1e-12));
}

}  // namespace

std::vector<RotationPair> rotationPairs(const std::vector<CameraPose>& poses, double pair_gap_s,
                                        double max_pair_s) {
  std::vector<RotationPair> pairs;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    std::size_t l = k + 1;
    while (l < poses.size() && poses[l].time_s - poses[k].time_s < pair_gap_s) ++l;
    if (l >= poses.size() || poses[l].time_s - poses[k].time_s > max_pair_s) continue;
    pairs.push_back({poses[k].time_s, poses[l].time_s,
                     quaternionLog(poses[k].world_from_camera.rotation.conjugate() *
                                   poses[l].world_from_camera.rotation)});
  }
  return pairs;
}

std::optional<RelativeRotation> estimateCameraImuRotation(const std::vector<CameraPose>& poses,
                                                          const GyroRotation& gyro, double time_offset_s,
                                                          const InitialisationOptions& options,
                                                          const SensorPrior& prior) {
  constexpr double kFirstScale_rad = 0.05, kLastScale_rad = 0.005;
  constexpr int kSteps = 15;
  std::vector<RotationPair> pairs = rotationPairs(poses, options.pair_gap_s, options.max_pair_s);
  const bool offset_given = isGiven(prior.time_offset), rotation_given = isGiven(prior.rotation);
  const double reach_s = offset_given ? 0.0 : options.time_offset_reach_s;
  const double lowest_s = time_offset_s - reach_s, highest_s = time_offset_s + reach_s;
  std::erase_if(pairs, [&](const RotationPair& pair) {
    return !gyro.covers(pair.from_s + lowest_s, pair.to_s + highest_s);
  });
  if (pairs.size() < 5) return std::nullopt;
  RelativeRotation result;
  result.time_offset_s = time_offset_s;
  result.pairs = static_cast<int>(pairs.size());
  alignVectors(pairs, feltRotations(pairs, gyro, time_offset_s), kFirstScale_rad, result);
  if (rotation_given) result.reference_from_sensor = prior.rotation->value;
  const Vector7 held = holding(rotation_given, offset_given);
  double scale_rad = kFirstScale_rad;
  for (int k = 0; k < kSteps; ++k) {
    result.residual_rad = step(pairs, gyro, scale_rad, held, result);
    result.time_offset_s = std::clamp(result.time_offset_s, lowest_s, highest_s);
    scale_rad = std::max(0.7 * scale_rad, kLastScale_rad);
  }
  if (rotation_given) result.reference_from_sensor = prior.rotation->value;  // exactly
  return result;
}

}  // namespace evical
