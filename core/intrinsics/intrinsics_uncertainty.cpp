#include "core/intrinsics/intrinsics_uncertainty.h"

#include "core/geometry/projection_difference.h"
#include "core/intrinsics/circle_centre_cost.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace evical {
namespace {

constexpr int kShared = kIntrinsicsCount + 1;  // and the edge localisation bias
using SharedMatrix = Eigen::Matrix<double, kShared, kShared>;
using SharedVector = Eigen::Matrix<double, kShared, 1>;
using PoseMatrix = Eigen::Matrix<double, 6, 6>;

// Index of a pixel's cell, in an image of columns x rows cells, row by row.
int cellAt(const Eigen::Vector2d& pixel, const Resolution& size_px, int columns, int rows) {
  const int column = static_cast<int>(pixel.x() * columns / size_px.width_px);
  const int row = static_cast<int>(pixel.y() * rows / size_px.height_px);
  return std::clamp(row, 0, rows - 1) * columns + std::clamp(column, 0, columns - 1);
}

// Errors common to all views at the same place in the image: for each place the error along x, then the one
// along y.
constexpr int kPlaceColumns = 8, kPlaceRows = 6, kPlaceErrors = 2 * kPlaceColumns * kPlaceRows;
using PlaceMatrix = Eigen::Matrix<double, kShared, kPlaceErrors>;

// Information of one view after elimination of its pose.
struct ViewInformation {
  double time_s = 0.0;
  SharedMatrix information = SharedMatrix::Zero();
  SharedVector score = SharedVector::Zero();
  PlaceMatrix by_place = PlaceMatrix::Zero();  // of the score, by each place's error in px
  double squares = 0.0;
  int residuals = 0;
};

ViewInformation viewInformation(const SensorView& view, const RigidTransform& pose, const Bundle& bundle,
                                const Board& board, const IntrinsicsOptions& options) {
  Eigen::Matrix<double, kIntrinsicsCount, 1> intrinsics;
  writeIntrinsics(bundle.intrinsics, intrinsics.data());
  Eigen::Matrix<double, kPoseBlock, 1> pose_block;
  writePose(pose, pose_block.data());
  const std::array<const double*, 3> blocks = {intrinsics.data(), &bundle.edge_localisation_bias_px,
                                               pose_block.data()};
  PoseMatrix a = PoseMatrix::Zero();
  Eigen::Matrix<double, kShared, 6> b = Eigen::Matrix<double, kShared, 6>::Zero();
  Eigen::Matrix<double, 6, 1> pose_score = Eigen::Matrix<double, 6, 1>::Zero();
  Eigen::Matrix<double, 6, kPlaceErrors> pose_by_place = Eigen::Matrix<double, 6, kPlaceErrors>::Zero();
  ViewInformation out;
  out.time_s = view.time_s;
  for (const SensorCircle& circle : view.circles) {
    if (!circle.used) continue;
    Eigen::Vector2d residual, by_lead;
    Eigen::Matrix<double, 2, kIntrinsicsCount, Eigen::RowMajor> by_intrinsics;
    Eigen::Matrix<double, 2, kPoseBlock, Eigen::RowMajor> by_block;
    std::array<double*, 3> jacobians = {by_intrinsics.data(), by_lead.data(), by_block.data()};
    const CircleCentreCost cost(bundle.intrinsics.model, circle, board.radius_m, bundle.scale);
    cost.Evaluate(blocks.data(), residual.data(), jacobians.data());
    Eigen::Matrix<double, 2, kShared> by_shared;
    by_shared << by_intrinsics, by_lead;
    Eigen::Matrix<double, 2, 6> by_pose;
    by_pose << by_block.leftCols<3>(), by_block.rightCols<3>();
    const double weight = std::min(1.0, options.huber_sigma / std::max(residual.norm(), 1e-12));
    a += weight * by_pose.transpose() * by_pose;
    b += weight * by_shared.transpose() * by_pose;
    out.information += weight * by_shared.transpose() * by_shared;
    out.score += weight * by_shared.transpose() * residual;
    pose_score += weight * by_pose.transpose() * residual;
    const int place =
        2 * cellAt(circle.centre_px, bundle.intrinsics.resolution_px, kPlaceColumns, kPlaceRows);
    out.by_place.middleCols<2>(place) += weight * by_shared.transpose() * cost.whitening_px();
    pose_by_place.middleCols<2>(place) += weight * by_pose.transpose() * cost.whitening_px();
    out.squares += weight * residual.squaredNorm();
    out.residuals += circle.only_known ? 1 : 2;
  }
  if (out.residuals == 0) return out;
  const Eigen::LDLT<PoseMatrix> solver(a);
  out.information -= b * solver.solve(b.transpose());
  out.score -= b * solver.solve(pose_score);
  out.by_place -= b * solver.solve(pose_by_place);
  return out;
}

// Views that are close in time have correlated errors.
SharedMatrix scoreCovariance(const std::vector<ViewInformation>& views, double correlation_time_s) {
  std::vector<double> times_s;
  std::vector<SharedVector> scores;
  for (const ViewInformation& view : views) {
    times_s.push_back(view.time_s);
    scores.push_back(view.score);
  }
  return neweyWestByTime(times_s, scores, kShared, correlation_time_s);
}

// Inverse over the free parameters only.
SharedMatrix inverseOf(const SharedMatrix& information, const std::vector<int>& free) {
  const auto size = static_cast<Eigen::Index>(free.size());
  const Eigen::MatrixXd part = information(free, free);
  const Eigen::VectorXd scale = part.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * part * scale.asDiagonal();
  constexpr double kFloor = 1e-14;  // directions without information get a very large sigma
  const Eigen::MatrixXd inverse = (scaled + kFloor * Eigen::MatrixXd::Identity(size, size))
                                      .ldlt()
                                      .solve(Eigen::MatrixXd::Identity(size, size));
  SharedMatrix whole = SharedMatrix::Zero();
  whole(free, free) = scale.asDiagonal() * inverse * scale.asDiagonal();
  return whole;
}

}  // namespace

BundleUncertainty bundleUncertainty(const Bundle& bundle, const Board& board,
                                    const IntrinsicsOptions& options) {
  std::vector<int> free;
  const FreeIntrinsics is_free = freeIntrinsics(bundle.intrinsics.model, options);
  for (int i = 0; i < kIntrinsicsCount; ++i)
    if (is_free[static_cast<std::size_t>(i)]) free.push_back(i);
  free.push_back(kIntrinsicsCount);
  SharedMatrix information = SharedMatrix::Zero();
  double squares = 0.0;
  int residuals = 0, unknowns = static_cast<int>(free.size());
  std::vector<ViewInformation> views;
  PlaceMatrix by_place = PlaceMatrix::Zero();
  for (std::size_t v = 0; v < bundle.views.size(); ++v) {
    ViewInformation view = viewInformation(bundle.views[v], bundle.poses[v], bundle, board, options);
    if (view.residuals == 0) continue;
    information += view.information;
    by_place += view.by_place;
    squares += view.squares;
    residuals += view.residuals;
    unknowns += 6;
    views.push_back(view);
  }
  BundleUncertainty out;
  if (residuals <= unknowns) return out;
  const double variance = squares / (residuals - unknowns);
  information(kIntrinsicsCount, kIntrinsicsCount) += std::pow(options.edge_localisation_bias_sigma_px, -2);
  const SharedMatrix inverse = inverseOf(information, free);
  SharedMatrix covariance = variance * inverse;
  // Correction for few views: the estimate absorbs part of their common errors.
  const auto count = static_cast<double>(views.size()), shared = static_cast<double>(free.size());
  const double few = count > 2.0 * shared ? count / (count - shared) : 2.0;
  const SharedMatrix correlated =
      few * inverse * scoreCovariance(views, options.correlation_time_s) * inverse.transpose();
  const SharedVector growth =
      (correlated.diagonal().array() / covariance.diagonal().array().max(1e-300)).max(1.0).sqrt().matrix();
  covariance = (growth.asDiagonal() * covariance * growth.asDiagonal()).eval();
  const PlaceMatrix by_place_errors = options.place_error_px * inverse * by_place;
  covariance += by_place_errors * by_place_errors.transpose();
  out.covariance = covariance.topLeftCorner<kIntrinsicsCount, kIntrinsicsCount>();
  out.edge_localisation_bias_std_px = std::sqrt(covariance(kIntrinsicsCount, kIntrinsicsCount));
  out.normalised_rms = bundle.scale * std::sqrt(variance);
  return out;
}

void setSigmas(const CameraIntrinsics& intrinsics, const IntrinsicsMatrix& covariance, ImageMap& map) {
  const ProjectionChange change(intrinsics, map.columns, map.rows);
  double squares = 0.0;
  int seen = 0;
  map.max_px = 0.0;
  for (std::size_t k = 0; k < map.cells.size(); ++k) {
    ImageCell& cell = map.cells[k];
    cell.middle_px = change.places()[k].pixel;
    cell.sigma_px = std::numeric_limits<double>::infinity();
    if (!change.places()[k].by_intrinsics) continue;
    const IntrinsicsJacobian& j = *change.places()[k].by_intrinsics;
    cell.sigma_px = std::sqrt(std::max(0.0, (j * covariance * j.transpose()).trace()));
    squares += cell.sigma_px * cell.sigma_px;
    map.max_px = std::max(map.max_px, cell.sigma_px);
    ++seen;
  }
  map.rms_px = seen == 0 ? std::numeric_limits<double>::infinity() : std::sqrt(squares / seen);
}

ImageMap imageMap(const Bundle& bundle, const IntrinsicsMatrix& covariance) {
  ImageMap map;
  map.columns = 16;
  map.rows = 12;
  map.cells.resize(static_cast<std::size_t>(map.columns * map.rows));
  setSigmas(bundle.intrinsics, covariance, map);
  const Resolution size = bundle.intrinsics.resolution_px;
  for (const SensorView& view : bundle.views) {
    for (const SensorCircle& circle : view.circles) {
      if (!circle.used) continue;
      ++map.cells[static_cast<std::size_t>(cellAt(circle.centre_px, size, map.columns, map.rows))].circles;
    }
  }
  return map;
}

}  // namespace evical
