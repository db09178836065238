#include "core/optimisation/displacement_field.h"

#include "core/optimisation/optimisation_options.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace evical {
namespace {

constexpr Eigen::Index kMaxModes = 32, kMotions = 6;

// (1 / sqrt(1 + l) - 1) / l, also for small l.
double gainOf(double l) {
  const double root = std::sqrt(1.0 + std::max(0.0, l));
  return -1.0 / (root * (1.0 + root));
}

using Factors = std::array<double, 4>;

// sums += factors[0] * rows[0] + factors[1] * rows[1] ..., rows a stride apart.
void addTo(double* __restrict sums, const Factors& factors, const double* __restrict rows,
           Eigen::Index stride, Eigen::Index count) {
  const double *r0 = rows, *r1 = r0 + stride, *r2 = r1 + stride, *r3 = r2 + stride;
  for (Eigen::Index k = 0; k < count; ++k)
    sums[k] += factors[0] * r0[k] + factors[1] * r1[k] + (factors[2] * r2[k] + factors[3] * r3[k]);
}
void addTo(double* __restrict sums, double factor, const double* __restrict row, Eigen::Index count) {
  for (Eigen::Index k = 0; k < count; ++k) sums[k] += factor * row[k];
}

// Whitened derivatives of a view's centres by motions of the camera.
Eigen::MatrixXd motionsOf(std::span<const FieldSize::Circle> view) {
  Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
  for (const FieldSize::Circle& circle : view)
    middle_px += circle.centre_px / static_cast<double>(view.size());
  double extent_px = 1.0;
  for (const FieldSize::Circle& circle : view)
    extent_px = std::max(extent_px, (circle.centre_px - middle_px).norm());
  Eigen::MatrixXd motions(2 * static_cast<Eigen::Index>(view.size()), kMotions);
  Eigen::Index row = 0;
  for (const FieldSize::Circle& circle : view) {
    const Eigen::Vector2d at = (circle.centre_px - middle_px) / extent_px;
    Eigen::Matrix<double, 2, kMotions> by_motion;
    by_motion << 1.0, 0.0, -at.y(), at.x(), at.x() * at.x(), at.x() * at.y(),  //
        0.0, 1.0, at.x(), at.y(), at.x() * at.y(), at.y() * at.y();
    motions.middleRows<2>(row) = circle.whitening_px * by_motion;
    row += 2;
  }
  return motions;
}

}  // namespace

double displacementSigma_px(CameraKind kind, const CircleObservation& circle, const ModelOptions& options) {
  if (kind != CameraKind::Events) return 0.0;
  const double speed_px_s = std::max(options.displacement_px_s, circle.velocity_px_s.norm());
  return std::hypot(options.displacement_px, options.displacement_px2_s / speed_px_s);
}

double fieldCovariance(double distance_spacings, const ModelOptions& options) {
  const double lengths = distance_spacings / options.displacement_length_spacings;
  return options.displacement_constant_share +
         (1.0 - options.displacement_constant_share) * std::exp(-0.5 * lengths * lengths);
}

// An incomplete Cholesky factor of the kernel, with the largest remaining variance next.
FieldModes fieldRoot(const Board& board, const ModelOptions& options) {
  constexpr double kNegligible = 0.01;  // of the variance
  constexpr Eigen::Index kMax = 64;
  const std::vector<Eigen::Vector2d> points_m = boardPoints_m(board);
  const auto n = static_cast<Eigen::Index>(points_m.size());
  const auto point_m = [&](Eigen::Index i) { return points_m[static_cast<std::size_t>(i)]; };
  FieldModes factor(n, 0);
  Eigen::VectorXd left = Eigen::VectorXd::Ones(n), column(n);
  for (Eigen::Index at = 0; factor.cols() < std::min(n, kMax) && left.maxCoeff(&at) > kNegligible;) {
    for (Eigen::Index i = 0; i < n; ++i)
      column[i] = fieldCovariance((point_m(i) - point_m(at)).norm() / board.spacing_m, options);
    column -= factor * factor.row(at).transpose();
    column /= std::sqrt(left[at]);
    left -= column.cwiseAbs2();
    factor.conservativeResize(Eigen::NoChange, factor.cols() + 1);
    factor.rightCols<1>() = column;
  }
  return factor;
}

// The strongest eigenvectors of the kernel: two thirds of the modes that the factor needs for the same
// remainder.
FieldModes fieldModes(const Board& board, const ModelOptions& options) {
  const FieldModes factor = fieldRoot(board, options);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(factor.transpose() * factor);
  const FieldModes all = factor * eigen.eigenvectors().rowwise().reverse();
  Eigen::VectorXd left = Eigen::VectorXd::Ones(factor.rows());
  Eigen::Index count = 0;
  while (count < std::min(all.cols(), kMaxModes) && left.maxCoeff() > options.displacement_remainder)
    left -= all.col(count++).cwiseAbs2();
  return all.leftCols(count);
}

DisplacementField::DisplacementField(const FieldModes& modes, std::span<const Circle> circles)
    : by_circle_(static_cast<Eigen::Index>(circles.size()), modes.cols()) {
  for (std::size_t i = 0; i < circles.size(); ++i)
    by_circle_.row(static_cast<Eigen::Index>(i)) = circles[i].rho * modes.row(circles[i].point);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(by_circle_.transpose() * by_circle_);
  const Eigen::VectorXd gains = eigen.eigenvalues().unaryExpr(&gainOf);
  gains_ = eigen.eigenvectors() * gains.asDiagonal() * eigen.eigenvectors().transpose();
}

// The two rows of a circle are one row of twice as many numbers. Some of them at once, for sums on the stack.
void DisplacementField::whiten(double* matrix, Eigen::Index columns) const {
  constexpr Eigen::Index kAtOnce = 32, kFour = 4;
  const Eigen::Index circles = by_circle_.rows(), modes = by_circle_.cols(), width = 2 * columns;
  if (circles == 0) return;
  std::array<double, kAtOnce * kMaxModes> sums, gained;  // filled below, as far as there are modes
  for (Eigen::Index first = 0; first < width; first += kAtOnce) {
    const Eigen::Index count = std::min(kAtOnce, width - first);
    double* const numbers = matrix + first;
    std::fill_n(sums.begin(), modes * kAtOnce, 0.0);
    std::fill_n(gained.begin(), modes * kAtOnce, 0.0);
    Eigen::Index i = 0;
    for (; i + kFour <= circles; i += kFour)
      for (Eigen::Index k = 0; k < modes; ++k)
        addTo(sums.data() + k * kAtOnce,
              {by_circle_(i, k), by_circle_(i + 1, k), by_circle_(i + 2, k), by_circle_(i + 3, k)},
              numbers + i * width, width, count);
    for (; i < circles; ++i)
      for (Eigen::Index k = 0; k < modes; ++k)
        addTo(sums.data() + k * kAtOnce, by_circle_(i, k), numbers + i * width, count);
    for (Eigen::Index k = 0; k < modes; ++k)
      for (Eigen::Index l = 0; l < modes; ++l)
        addTo(gained.data() + k * kAtOnce, gains_(k, l), sums.data() + l * kAtOnce, count);
    for (i = 0; i < circles; ++i) {
      const double* const by = by_circle_.row(i).data();
      Eigen::Index k = 0;
      for (; k + kFour <= modes; k += kFour)
        addTo(numbers + i * width, {by[k], by[k + 1], by[k + 2], by[k + 3]}, gained.data() + k * kAtOnce,
              kAtOnce, count);
      for (; k < modes; ++k) addTo(numbers + i * width, by[k], gained.data() + k * kAtOnce, count);
    }
  }
}

// Motions that the trajectory could follow are removed from each view: shift, rotation, distance and tilt of
// the camera, as a far board shows them.
void FieldSize::add(std::span<const Circle> view) {
  const auto n = static_cast<Eigen::Index>(view.size()), modes = root_.cols();
  if (n <= kMotions) return;
  Eigen::MatrixXd others = Eigen::MatrixXd::Zero(2 * n, 2 * modes + 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Circle& circle = view[static_cast<std::size_t>(i)];
    const auto row = circle.displaced.rho * root_.row(circle.displaced.point);
    for (Eigen::Index k = 0; k < modes; ++k) others(2 * i, k) = others(2 * i + 1, modes + k) = row[k];
    others.block<2, 1>(2 * i, 2 * modes) = circle.error_sigmas;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> solver(motionsOf(view));
  others.applyOnTheLeft(solver.householderQ().transpose());
  addSeparated(others.bottomRows(2 * n - kMotions));
}

// `left`: columns of the modes, and the errors. Eigenvectors instead of tridiagonal products take five times
// as long.
void FieldSize::addSeparated(const Eigen::MatrixXd& left) {
  const auto field = left.leftCols(left.cols() - 1);
  const auto error = left.rightCols<1>();
  const Eigen::Tridiagonalization<Eigen::MatrixXd> tridiagonal(field.transpose() * field);
  views_.push_back({tridiagonal.diagonal(), tridiagonal.subDiagonal(),
                    tridiagonal.matrixQ().transpose() * (field.transpose() * error)});
  count_ += static_cast<double>(left.rows());
  squares_ += error.squaredNorm();
}

// Twice the negative logarithm of the likelihood at the best scale of the circles' own sigmas, and of the
// prior. A view's errors have the covariance I + size^2 M M^T; M^T M = Q T Q^T, so their square is e^T e -
// size^2 b^T (I + size^2 T)^-1 b.
double FieldSize::misfit(double size) const {
  const double size2 = size * size;
  double sum = squares_, logs = 0.0;
  for (const Products& view : views_) {
    double pivot = 1.0, reduced = 0.0;
    for (Eigen::Index k = 0; k < view.diagonal.size(); ++k) {
      const double coupling = k == 0 ? 0.0 : size2 * view.below[k - 1];
      reduced = view.with_errors[k] - coupling / pivot * reduced;
      pivot = 1.0 + size2 * view.diagonal[k] - coupling * coupling / pivot;
      sum -= size2 * reduced * reduced / pivot;
      logs += std::log(pivot);
    }
  }
  return count_ * std::log(sum / count_) + logs + std::pow(std::log(size) / prior_sigma_, 2);
}

double FieldSize::mostProbable() const {
  constexpr double kMin = 0.1, kMax = 10.0, kStep = 1.05;
  if (count_ <= 0.0) return 1.0;
  double best = 1.0, least = misfit(best);
  for (double size = kMin; size < kMax; size *= kStep) {
    const double here = misfit(size);
    if (here >= least) continue;
    least = here;
    best = size;
  }
  return best;
}

}  // namespace evical
