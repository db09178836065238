#include "core/initialisation/gravity_alignment.h"

#include "core/base/time.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical {
namespace {

constexpr int kExtras = 9;  // lever, gravity, bias
using ExtrasMatrix = Eigen::Matrix<double, kExtras, kExtras>;
using ExtrasVector = Eigen::Matrix<double, kExtras, 1>;
using ExtrasJacobian = Eigen::Matrix<double, 3, kExtras>;

// sum_j weights[j] P[segment + j] + extras * x = target, three rows with one sigma.
struct LinearRow {
  int segment;
  Eigen::Vector4d weights;
  ExtrasJacobian extras;
  Eigen::Vector3d target;
  double inverse_variance;
  bool position;
};

struct AveragedForce {
  double time_s;
  Eigen::Vector3d force_m_s2;
};

// Quarter knots: short against the splines' own resolution, long against 1 kHz.
std::vector<AveragedForce> averageForces(std::span<const ImuSample> samples, std::int64_t start_ns,
                                         const So3Spline& rotation) {
  std::vector<AveragedForce> averages;
  const double bin_s = 0.25 * rotation.knot_spacing_s;
  double sum_time = 0.0, bin_end_s = rotation.start_s + bin_s;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  const auto flush = [&] {
    if (count > 0) averages.push_back({sum_time / count, sum / count});
    sum_time = 0.0;
    sum.setZero();
    count = 0;
  };
  for (const ImuSample& sample : samples) {
    const double time_s = secondsSince(start_ns, sample.time_ns);
    if (!rotation.contains(time_s)) continue;
    if (time_s >= bin_end_s) {
      flush();
      bin_end_s = rotation.start_s + bin_s * (std::floor((time_s - rotation.start_s) / bin_s) + 1.0);
    }
    sum_time += time_s;
    sum += sample.specific_force_m_s2;
    ++count;
  }
  flush();
  return averages;
}

std::vector<LinearRow> makeRows(const std::vector<CameraPose>& poses, double time_offset_s,
                                const std::vector<AveragedForce>& forces, const So3Spline& rotation,
                                const VectorSpline& spline, const InitialisationOptions& options) {
  std::vector<LinearRow> rows;
  for (const CameraPose& pose : poses) {
    const double time_s = pose.time_s + time_offset_s;
    if (!rotation.contains(time_s)) continue;
    const VectorSample sample = evaluate(spline, time_s);
    LinearRow row{sample.segment,
                  sample.value_weights,
                  ExtrasJacobian::Zero(),
                  pose.world_from_camera.translation_m,
                  1.0 / (options.position_sigma_m * options.position_sigma_m),
                  true};
    row.extras.leftCols<3>() = evaluate(rotation, time_s, RotationOrder::Rotation).rotation;
    rows.push_back(row);
  }
  const double sigma = options.acceleration_sigma_m_s2;
  for (const AveragedForce& force : forces) {
    const VectorSample sample = evaluate(spline, force.time_s);
    const Eigen::Matrix3d r = evaluate(rotation, force.time_s, RotationOrder::Rotation).rotation;
    LinearRow row{sample.segment,       sample.acceleration_weights, ExtrasJacobian::Zero(),
                  r * force.force_m_s2, 1.0 / (sigma * sigma),       false};
    row.extras.middleCols<3>(3) = -Eigen::Matrix3d::Identity();
    row.extras.rightCols<3>() = r;
    rows.push_back(row);
  }
  return rows;
}

struct Solution {
  Eigen::MatrixX3d points;
  ExtrasVector extras;
  ExtrasMatrix covariance;
};

// Control points couple along time only (one banded matrix for all three axes); the nine extras come by Schur
// complement.
Solution solve(const std::vector<LinearRow>& rows, int point_count, const ExtrasMatrix& prior,
               const ExtrasVector& prior_vector) {
  std::vector<Eigen::Triplet<double>> triplets;
  std::array<Eigen::MatrixXd, 3> coupling;
  coupling.fill(Eigen::MatrixXd::Zero(point_count, kExtras + 1));  // last column: right hand side
  ExtrasMatrix matrix = prior;
  ExtrasVector vector = prior_vector;
  for (const LinearRow& row : rows) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        triplets.emplace_back(row.segment + i, row.segment + j,
                              row.inverse_variance * row.weights(i) * row.weights(j));
      }
      for (int axis = 0; axis < 3; ++axis) {
        auto target = coupling[static_cast<std::size_t>(axis)].row(row.segment + i);
        target.head<kExtras>() += row.inverse_variance * row.weights(i) * row.extras.row(axis);
        target(kExtras) += row.inverse_variance * row.weights(i) * row.target(axis);
      }
    }
    matrix += row.inverse_variance * row.extras.transpose() * row.extras;
    vector += row.inverse_variance * row.extras.transpose() * row.target;
  }
  Eigen::SparseMatrix<double> band(point_count, point_count);
  band.setFromTriplets(triplets.begin(), triplets.end());
  // Ends and gaps: a control point that nothing sees follows its neighbours.
  std::vector<Eigen::Triplet<double>> smooth;
  constexpr double kSmoothness = 1e-2;
  constexpr std::array<double, 4> kThirdDifference = {-1.0, 3.0, -3.0, 1.0};
  for (int k = 0; k + 3 < point_count; ++k) {
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        smooth.emplace_back(k + i, k + j,
                            kSmoothness * kThirdDifference[static_cast<std::size_t>(i)] *
                                kThirdDifference[static_cast<std::size_t>(j)]);
      }
    }
  }
  Eigen::SparseMatrix<double> smoothing(point_count, point_count);
  smoothing.setFromTriplets(smooth.begin(), smooth.end());
  band += smoothing;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> factor(
      band);
  std::array<Eigen::MatrixXd, 3> solved;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    solved[axis] = factor.solve(coupling[axis]);
    matrix -= coupling[axis].leftCols<kExtras>().transpose() * solved[axis].leftCols<kExtras>();
    vector -= coupling[axis].leftCols<kExtras>().transpose() * solved[axis].col(kExtras);
  }
  Solution solution;
  solution.extras = matrix.ldlt().solve(vector);
  solution.covariance = matrix.inverse();
  solution.points.resize(point_count, 3);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    solution.points.col(static_cast<Eigen::Index>(axis)) =
        solved[axis].col(kExtras) - solved[axis].leftCols<kExtras>() * solution.extras;
  }
  return solution;
}

// Weights for the next round: views that lie far from the spline count less.
void reweigh(std::vector<LinearRow>& rows, const Solution& solution, const InitialisationOptions& options,
             GravityAlignment& result) {
  double position2 = 0.0, acceleration2 = 0.0;
  int positions = 0, accelerations = 0;
  for (LinearRow& row : rows) {
    const Eigen::Vector3d error = solution.points.middleRows<4>(row.segment).transpose() * row.weights +
                                  row.extras * solution.extras - row.target;
    if (row.position) {
      const double scale_m = 5.0 * options.position_sigma_m;
      const double weight = 1.0 / (1.0 + error.squaredNorm() / (scale_m * scale_m));
      row.inverse_variance = weight / (options.position_sigma_m * options.position_sigma_m);
      position2 += weight * error.squaredNorm();
      ++positions;
    } else {
      acceleration2 += error.squaredNorm();
      ++accelerations;
    }
  }
  result.position_rms_m = std::sqrt(position2 / std::max(positions, 1));
  result.acceleration_rms_m_s2 = std::sqrt(acceleration2 / std::max(accelerations, 1));
}

}  // namespace

GravityAlignment alignGravity(const std::vector<CameraPose>& poses, double time_offset_s,
                              std::span<const ImuSample> samples, std::int64_t start_ns,
                              const So3Spline& rotation, const InitialisationOptions& options) {
  constexpr int kRounds = 5;
  GravityAlignment result;
  result.imu_in_world_m.start_s = rotation.start_s;
  result.imu_in_world_m.knot_spacing_s = rotation.knot_spacing_s;
  result.imu_in_world_m.control_points.assign(rotation.control_points.size(), Eigen::Vector3d::Zero());
  const auto point_count = static_cast<int>(rotation.control_points.size());
  std::vector<LinearRow> rows = makeRows(poses, time_offset_s, averageForces(samples, start_ns, rotation),
                                         rotation, result.imu_in_world_m, options);
  Solution solution;
  for (int round = 0; round < kRounds; ++round) {
    ExtrasMatrix prior = ExtrasMatrix::Zero();
    ExtrasVector prior_vector = ExtrasVector::Zero();
    prior.diagonal().head<3>().setConstant(1.0 / (options.translation_sigma_m * options.translation_sigma_m));
    prior.diagonal().tail<3>().setConstant(
        1.0 / (options.accelerometer_bias_sigma_m_s2 * options.accelerometer_bias_sigma_m_s2));
    if (round > 0) {
      // |g| is known: a tight observation along the direction found so far.
      constexpr double kNormSigma_m_s2 = 1e-4;
      const Eigen::Vector3d down = solution.extras.segment<3>(3).normalized();
      const double weight = 1.0 / (kNormSigma_m_s2 * kNormSigma_m_s2);
      prior.block<3, 3>(3, 3) += weight * down * down.transpose();
      prior_vector.segment<3>(3) = weight * options.gravity_m_s2 * down;
    }
    solution = solve(rows, point_count, prior, prior_vector);
    reweigh(rows, solution, options, result);
  }
  for (int k = 0; k < point_count; ++k) {
    result.imu_in_world_m.control_points[static_cast<std::size_t>(k)] = solution.points.row(k).transpose();
  }
  // p_wc = p_wb + R_wb t: rows say P + R t = p_wc.
  result.camera_in_imu_m = solution.extras.head<3>();
  result.gravity_in_world_m_s2 = solution.extras.segment<3>(3).normalized() * options.gravity_m_s2;
  result.accelerometer_bias_m_s2 = solution.extras.tail<3>();
  result.camera_in_imu_std_m = std::sqrt(solution.covariance.diagonal().head<3>().maxCoeff());
  return result;
}

}  // namespace evical
