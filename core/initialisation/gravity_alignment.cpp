#include "core/initialisation/gravity_alignment.h"

#include "core/base/time.h"
#include "core/geometry/so3.h"
#include "core/numerics/band_cholesky.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace evical {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct AveragedForce {
  double time_s;
  Vector3d force_m_s2;
};

// Averages over quarter knots: short compared with the splines' resolution, long compared with samples at 1
// kHz.
std::vector<AveragedForce> averageForces(std::span<const ImuSample> samples, std::int64_t start_ns,
                                         const So3Spline& rotation) {
  std::vector<AveragedForce> averages;
  const double bin_s = 0.25 * rotation.knot_spacing_s;
  double sum_time = 0.0, bin_end_s = rotation.start_s + bin_s;
  Vector3d sum = Vector3d::Zero();
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

// Two kinds of three equations each: P(weights) + R lever = measured (a view's position), or
// P(weights) + R bias - gravity = R measured (an acceleration). If the board's scale is unknown, the
// latter is scale P(weights) + R (bias + skew f) - gravity = R measured, with the products linearised:
// measurements never multiply an unknown, since their noise would then bias it towards zero.
struct Row {
  bool position;
  std::size_t camera;
  int segment;
  Eigen::Vector4d weights;
  Matrix3d world_from_imu;
  Vector3d measured;
  double weight = 1.0;  // robust
};

// The unknowns other than control points: levers, gravity, bias. If the board's scale is estimated, also the
// scale, and the matrix of errors of the accelerometer's scales and axes and of the rotation, row by row:
// without it, these errors would bias the board's scale.
struct Layout {
  explicit Layout(std::size_t cameras) : gravity(static_cast<Eigen::Index>(3 * cameras)) {}
  Eigen::Index gravity;
  bool with_scale = false;
  Eigen::Index lever(std::size_t camera) const { return static_cast<Eigen::Index>(3 * camera); }
  Eigen::Index bias() const { return gravity + 3; }
  Eigen::Index scale() const { return gravity + 6; }
  Eigen::Index skew() const { return gravity + 7; }
  Eigen::Index size() const { return gravity + (with_scale ? 16 : 6); }
};

struct Solution {
  Eigen::MatrixX3d points;
  Eigen::VectorXd shared;
  Eigen::MatrixXd covariance;        // of the shared unknowns
  Eigen::MatrixX3d points_by_scale;  // their covariances with the board's scale, if it is estimated
};

struct Sigmas {
  double position_m, acceleration_m_s2;
};

class Alignment {
 public:
  Alignment(std::span<const CameraTrack> cameras, std::span<const ImuSample> samples, std::int64_t start_ns,
            const So3Spline& rotation, const InitialisationOptions& options, const RunContext& context)
      : options_(options),
        context_(context),
        layout_(cameras.size()),
        point_count_(static_cast<Eigen::Index>(rotation.control_points.size())),
        knot_spacing_s_(rotation.knot_spacing_s),
        sigmas_{options.position_sigma_m, options.acceleration_sigma_m_s2} {
    VectorSpline knots{rotation.start_s, rotation.knot_spacing_s,
                       std::vector<Vector3d>(rotation.control_points.size(), Vector3d::Zero())};
    const auto add = [&](bool position, std::size_t camera, double time_s, const Vector3d& measured) {
      const VectorSample sample = evaluate(knots, time_s);
      rows_.push_back({position, camera, sample.segment,
                       position ? sample.value_weights : sample.acceleration_weights,
                       evaluate(rotation, time_s, RotationOrder::Rotation).rotation, measured});
    };
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      known_levers_.push_back(cameras[c].translation);
      for (const CameraPose& pose : cameras[c].poses) {
        const double time_s = pose.time_s + cameras[c].time_offset_s;
        if (rotation.contains(time_s)) add(true, c, time_s, pose.world_from_camera.translation_m);
      }
    }
    for (const AveragedForce& force : averageForces(samples, start_ns, rotation))
      add(false, 0, force.time_s, force.force_m_s2);
  }

  void turn(const Matrix3d& rotation) {
    for (Row& row : rows_) row.world_from_imu *= rotation;
  }
  void releaseScale() { layout_.with_scale = true; }
  // Resets the weights of earlier rounds.
  void restart() {
    for (Row& row : rows_) row.weight = 1.0;
    sigmas_ = {options_.position_sigma_m, options_.acceleration_sigma_m_s2};
    gravity_m_s2_.reset();
  }

  Solution solve(int rounds) {
    Solution solution;
    for (int round = 0; round < rounds; ++round) {
      context_.throwIfStopped();
      solution = solveOnce();
      points_ = solution.points;
      gravity_m_s2_ = solution.shared.segment<3>(layout_.gravity);
      if (layout_.with_scale) scale_ = solution.shared(layout_.scale());
      reweigh(solution);
    }
    return solution;
  }
  double scaleSigma(const Solution& solution) const;
  double cost() const { return cost_; }
  double accelerationMisfit_m_s2() const { return acceleration_misfit_m_s2_; }
  const Layout& layout() const { return layout_; }
  void summarise(GravityAlignment& result) const {
    result.position_rms_m = sigmas_.position_m;
    result.acceleration_rms_m_s2 = sigmas_.acceleration_m_s2;
    result.acceleration_misfit_m_s2 = acceleration_misfit_m_s2_;
    for (const Row& row : rows_) {
      if (!row.position) continue;
      ++result.views;
      result.outlying_views += row.weight < kOutlyingWeight ? 1 : 0;
    }
  }

 private:
  static constexpr double kOutlyingWeight = 0.1;

  Solution solveOnce() const;
  void addPriors(Eigen::MatrixXd& matrix, Eigen::VectorXd& vector) const;
  void accumulate(const Row& row, BandCholesky& band, std::array<Eigen::MatrixXd, 3>& coupling,
                  Eigen::MatrixXd& matrix, Eigen::VectorXd& vector) const;
  Eigen::Matrix3Xd sharedCoefficients(const Row& row) const;
  Eigen::Vector4d pointWeights(const Row& row) const {
    return row.position ? row.weights : Eigen::Vector4d(scale_ * row.weights);
  }
  Vector3d accelerationBefore(const Row& row) const {
    return points_.middleRows<4>(row.segment).transpose() * row.weights;
  }
  Vector3d target(const Row& row) const;
  double rowWeight(const Row& row) const {
    const double sigma = row.position ? sigmas_.position_m : sigmas_.acceleration_m_s2;
    return row.weight / (sigma * sigma);
  }
  Vector3d errorOf(const Row& row, const Solution& solution) const;
  void reweigh(const Solution& solution);

  InitialisationOptions options_;
  const RunContext& context_;
  Layout layout_;
  Eigen::Index point_count_;
  double knot_spacing_s_;
  Sigmas sigmas_;
  std::vector<Row> rows_;
  std::vector<std::optional<KnownVector>> known_levers_;  // by camera
  // The last solution: where products of unknowns are linearised.
  double scale_ = 1.0;
  Eigen::MatrixX3d points_;
  std::optional<Vector3d> gravity_m_s2_;
  double cost_ = 0.0;
  double acceleration_misfit_m_s2_ = 0.0;
};

void Alignment::addPriors(Eigen::MatrixXd& matrix, Eigen::VectorXd& vector) const {
  const auto inverseSquare = [](double sigma) { return 1.0 / (sigma * sigma); };
  matrix.diagonal().head(layout_.gravity).setConstant(inverseSquare(options_.translation_sigma_m));
  constexpr double kGiven_m = 1e-4;
  for (std::size_t c = 0; c < known_levers_.size(); ++c) {
    if (!known_levers_[c]) continue;
    const Vector3d sigma_m =
        known_levers_[c]->sigma.value_or(Vector3d::Constant(kGiven_m)).cwiseMax(kGiven_m);
    const Vector3d weight = sigma_m.cwiseAbs2().cwiseInverse();
    matrix.diagonal().segment<3>(layout_.lever(c)) = weight;
    vector.segment<3>(layout_.lever(c)) = weight.cwiseProduct(known_levers_[c]->value);
  }
  matrix.diagonal()
      .segment<3>(layout_.bias())
      .setConstant(inverseSquare(options_.accelerometer_bias_sigma_m_s2));
  if (layout_.with_scale) {
    constexpr double kAnyScale = 1.0;
    matrix(layout_.scale(), layout_.scale()) = vector(layout_.scale()) = inverseSquare(kAnyScale);
    matrix.diagonal().tail<9>().setConstant(inverseSquare(options_.accelerometer_scale_misalignment_sigma));
  }
  if (!gravity_m_s2_) return;
  // |g| is known: a tight observation along the current direction.
  constexpr double kNormSigma_m_s2 = 1e-4;
  const Vector3d down = gravity_m_s2_->normalized();
  matrix.block<3, 3>(layout_.gravity, layout_.gravity) +=
      inverseSquare(kNormSigma_m_s2) * down * down.transpose();
  vector.segment<3>(layout_.gravity) += inverseSquare(kNormSigma_m_s2) * options_.gravity_m_s2 * down;
}

Eigen::Matrix3Xd Alignment::sharedCoefficients(const Row& row) const {
  const Matrix3d& r = row.world_from_imu;
  Eigen::Matrix3Xd c = Eigen::Matrix3Xd::Zero(3, layout_.size());
  c.middleCols<3>(row.position ? layout_.lever(row.camera) : layout_.bias()) = r;
  if (!row.position) c.middleCols<3>(layout_.gravity) = -Matrix3d::Identity();
  if (!layout_.with_scale || row.position) return c;
  c.col(layout_.scale()) = accelerationBefore(row);
  const Vector3d force = r.transpose() * (scale_ * accelerationBefore(row) - *gravity_m_s2_);
  Eigen::Index column = layout_.skew();
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j) c.col(column++) = r.col(i) * force(j);
  return c;
}

Vector3d Alignment::target(const Row& row) const {
  if (row.position) return row.measured;
  const Vector3d force = row.world_from_imu * row.measured;
  return layout_.with_scale ? Vector3d(force + scale_ * accelerationBefore(row)) : force;
}

// `coupling` by axis: control points x (shared unknowns, right hand side).
void Alignment::accumulate(const Row& row, BandCholesky& band, std::array<Eigen::MatrixXd, 3>& coupling,
                           Eigen::MatrixXd& matrix, Eigen::VectorXd& vector) const {
  const double w = rowWeight(row);
  const Eigen::Matrix3Xd shared = sharedCoefficients(row);
  const Vector3d right = target(row);
  const Eigen::Vector4d points = pointWeights(row);
  band.addOuter(row.segment, points, w);
  for (int axis = 0; axis < 3; ++axis) {
    auto block = coupling[static_cast<std::size_t>(axis)].middleRows<4>(row.segment);
    block.leftCols(layout_.size()) += w * points * shared.row(axis);
    block.col(layout_.size()) += w * right(axis) * points;
  }
  matrix.noalias() += w * shared.transpose() * shared;
  vector.noalias() += w * shared.transpose() * right;
}

// One banded matrix for all three axes; the shared unknowns follow from the Schur complement.
Solution Alignment::solveOnce() const {
  const Eigen::Index n = layout_.size();
  BandCholesky band(point_count_, 3);
  std::array<Eigen::MatrixXd, 3> coupling;
  coupling.fill(Eigen::MatrixXd::Zero(point_count_, n + 1));
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd vector = Eigen::VectorXd::Zero(n);
  addPriors(matrix, vector);
  for (const Row& row : rows_) accumulate(row, band, coupling, matrix, vector);
  // Ends and gaps: a control point without data follows its neighbours.
  constexpr double kSmoothness = 1e-2, kTie = 1e-9;
  for (Eigen::Index k = 0; k + 3 < point_count_; ++k) {
    band.addOuter(k, Eigen::Vector4d(-1.0, 3.0, -3.0, 1.0), kSmoothness);
    band.addOuter(k, Eigen::Vector4d(1.0, 1.0, 1.0, 1.0), kTie);
  }
  Solution solution;
  solution.points = Eigen::MatrixX3d::Zero(point_count_, 3);
  solution.shared = Eigen::VectorXd::Zero(n);
  solution.covariance = Eigen::MatrixXd::Zero(n, n);
  solution.points_by_scale = Eigen::MatrixX3d::Zero(point_count_, 3);
  if (!band.factorise()) return solution;
  std::array<Eigen::MatrixXd, 3> solved = coupling;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    band.solveInPlace(solved[axis]);
    matrix.noalias() -= coupling[axis].leftCols(n).transpose() * solved[axis].leftCols(n);
    vector.noalias() -= coupling[axis].leftCols(n).transpose() * solved[axis].col(n);
  }
  solution.shared = matrix.ldlt().solve(vector);
  solution.covariance = matrix.inverse();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    solution.points.col(static_cast<Eigen::Index>(axis)) =
        solved[axis].col(n) - solved[axis].leftCols(n) * solution.shared;
  }
  if (!layout_.with_scale) return solution;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    solution.points_by_scale.col(static_cast<Eigen::Index>(axis)) =
        -solved[axis].leftCols(n) * solution.covariance.col(layout_.scale());
  }
  return solution;
}

Vector3d Alignment::errorOf(const Row& row, const Solution& solution) const {
  const Vector3d spline = solution.points.middleRows<4>(row.segment).transpose() * pointWeights(row);
  return spline + sharedCoefficients(row) * solution.shared - target(row);
}

// Errors within a second may have a common cause, such as a small rotation error that rotates gravity:
// returns the larger of the sigma for independent errors, and of the scatter of sums over seconds.
double Alignment::scaleSigma(const Solution& solution) const {
  const double independent = std::sqrt(solution.covariance(layout_.scale(), layout_.scale()));
  const double segments_per_second = 1.0 / knot_spacing_s_;
  std::vector<double> pulls;
  for (const Row& row : rows_) {
    const Vector3d sensitivity =
        solution.points_by_scale.middleRows<4>(row.segment).transpose() * pointWeights(row) +
        sharedCoefficients(row) * solution.covariance.col(layout_.scale());
    const auto second = static_cast<std::size_t>(row.segment / segments_per_second);
    if (second >= pulls.size()) pulls.resize(second + 1, 0.0);
    pulls[second] += rowWeight(row) * sensitivity.dot(errorOf(row, solution));
  }
  double squares = 0.0;
  for (const double pull : pulls) squares += pull * pull;
  return std::max(independent, std::sqrt(squares));
}

// Weights for the next round: robust weights, and a scale for each kind from its fit.
void Alignment::reweigh(const Solution& solution) {
  std::vector<double> positions, accelerations;
  for (Row& row : rows_) {
    row.weight = errorOf(row, solution).norm();  // temporarily
    (row.position ? positions : accelerations).push_back(row.weight);
  }
  // The norm of three equal normal errors has its median at 1.54 sigma. To balance both kinds of rows, each
  // sigma is limited to between a fifth of its option and ten times that.
  constexpr double kMedianNorm = 1.54, kMin = 0.2, kMax = 10.0;
  const auto within = [&](double sigma, double option) {
    return std::clamp(sigma / kMedianNorm, kMin * option, kMax * option);
  };
  const double acceleration_m_s2 = medianOf(std::move(accelerations));
  acceleration_misfit_m_s2_ = acceleration_m_s2 / kMedianNorm;
  sigmas_ = {within(medianOf(std::move(positions)), options_.position_sigma_m),
             within(acceleration_m_s2, options_.acceleration_sigma_m_s2)};
  cost_ = 0.0;
  const double scale = options_.outlier_sigma;  // Cauchy's weights
  for (Row& row : rows_) {
    const double sigma = row.position ? options_.position_sigma_m : options_.acceleration_sigma_m_s2;
    cost_ += std::log1p(row.weight * row.weight / (scale * scale * sigma * sigma));
    const double error =
        row.weight / (scale * (row.position ? sigmas_.position_m : sigmas_.acceleration_m_s2));
    row.weight = cauchyWeight(error * error);
  }
}

}  // namespace

GravityAlignment alignGravity(std::span<const CameraTrack> cameras, std::span<const ImuSample> samples,
                              std::int64_t start_ns, const So3Spline& rotation,
                              const InitialisationOptions& options, const RunContext& context) {
  constexpr int kRounds = 6;
  Alignment alignment(cameras, samples, start_ns, rotation, options, context);
  const Solution solution = alignment.solve(kRounds);
  GravityAlignment result;
  result.imu_in_world_m = {rotation.start_s, rotation.knot_spacing_s, {}};
  for (Eigen::Index k = 0; k < solution.points.rows(); ++k)
    result.imu_in_world_m.control_points.push_back(solution.points.row(k).transpose());
  const Layout& layout = alignment.layout();
  for (std::size_t c = 0; c < cameras.size(); ++c)
    result.cameras_in_imu_m.push_back(solution.shared.segment<3>(layout.lever(c)));
  result.gravity_in_world_m_s2 =
      solution.shared.segment<3>(layout.gravity).normalized() * options.gravity_m_s2;
  result.accelerometer_bias_m_s2 = solution.shared.segment<3>(layout.bias());
  result.lever_std_m = std::sqrt(solution.covariance.diagonal().head(layout.gravity).maxCoeff());
  alignment.summarise(result);
  alignment.releaseScale();
  const Solution scaled = alignment.solve(kRounds);
  result.board_scale = scaled.shared(layout.scale());
  result.board_scale_std = alignment.scaleSigma(scaled);
  return result;
}

int signOfScale(const GravityAlignment& gravity, const InitialisationOptions& options) {
  constexpr double kHalfSize = 0.5;  // far from the accuracy of any board's size
  const double scale = gravity.board_scale;
  if (std::abs(scale) < std::max(kHalfSize, options.scale_error_sigmas * gravity.board_scale_std)) return 0;
  return scale < 0.0 ? -1 : 1;
}

double accelerationMisfit_m_s2(std::span<const CameraTrack> cameras, std::span<const ImuSample> samples,
                               std::int64_t start_ns, const So3Spline& rotation,
                               const InitialisationOptions& options, const RunContext& context) {
  constexpr int kRounds = 3;
  Alignment alignment(cameras, samples, start_ns, rotation, options, context);
  alignment.solve(kRounds);
  return alignment.accelerationMisfit_m_s2();
}

double findTurnAboutAxis(const Vector3d& axis_in_imu, std::span<const CameraTrack> cameras,
                         std::span<const ImuSample> samples, std::int64_t start_ns, const So3Spline& rotation,
                         const InitialisationOptions& options, const RunContext& context) {
  constexpr int kDirections = 24, kRounds = 3, kHalvings = 7;
  Alignment alignment(cameras, samples, start_ns, rotation, options, context);
  double turned_rad = 0.0;
  const auto costAt = [&](double angle_rad) {
    alignment.turn(so3Exp(axis_in_imu * (angle_rad - turned_rad)));
    turned_rad = angle_rad;
    alignment.restart();
    alignment.solve(kRounds);
    return alignment.cost();
  };
  double step_rad = 2.0 * std::numbers::pi / kDirections;
  double best_rad = 0.0, least = costAt(0.0);
  const auto consider = [&](double angle_rad) {
    const double cost = costAt(angle_rad);
    if (cost < least) {
      least = cost;
      best_rad = angle_rad;
    }
  };
  for (int k = 1; k < kDirections; ++k) consider(k * step_rad);
  for (int k = 0; k < kHalvings; ++k) {
    step_rad *= 0.5;
    const double middle_rad = best_rad;
    consider(middle_rad - step_rad);
    consider(middle_rad + step_rad);
  }
  return best_rad;
}

}  // namespace evical
