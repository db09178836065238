#include "core/frames/ideal_views.h"

#include "core/geometry/camera_model.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/QR>

#include <cmath>
#include <numbers>

namespace evical {
namespace {

constexpr int kEdgePoints = 16;

struct FittedEllipse {
  Eigen::Vector2d centre;
  Eigen::Matrix2d shape;  // d^T shape^-1 d = 1
};

// The conic through points around an initial centre, by least squares: exact for points of an ellipse.
std::optional<FittedEllipse> ellipseThrough(const Eigen::Matrix<double, kEdgePoints, 2>& points,
                                            const Eigen::Vector2d& around, double size) {
  Eigen::Matrix<double, kEdgePoints, 5> rows;
  for (int k = 0; k < kEdgePoints; ++k) {
    const Eigen::Vector2d d = (points.row(k).transpose() - around) / size;
    rows.row(k) << d.x() * d.x(), d.x() * d.y(), d.y() * d.y(), d.x(), d.y();
  }
  const Eigen::Matrix<double, 5, 1> c =
      rows.colPivHouseholderQr().solve(Eigen::Matrix<double, kEdgePoints, 1>::Ones());
  Eigen::Matrix2d form;
  form << c(0), 0.5 * c(1), 0.5 * c(1), c(2);
  if (!(form.determinant() > 0.0 && c(0) > 0.0)) return std::nullopt;
  const Eigen::Vector2d centre = -0.5 * form.inverse() * c.tail<2>();
  const double level = 1.0 + centre.dot(form * centre);
  return FittedEllipse{around + size * centre, size * size * level * form.inverse()};
}

std::optional<FittedEllipse> idealEllipse(const CircleObservation& seen, const Eigen::Vector2d& ideal_centre,
                                          const CameraIntrinsics& camera) {
  const Eigen::Rotation2Dd turn(seen.angle_rad);
  Eigen::Matrix<double, kEdgePoints, 2> edge;
  for (int k = 0; k < kEdgePoints; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kEdgePoints;
    const Eigen::Vector2d on_axes(seen.semi_axes_px.x() * std::cos(angle),
                                  seen.semi_axes_px.y() * std::sin(angle));
    const std::optional<Eigen::Vector2d> ideal = idealPixel(camera, seen.centre_px + turn * on_axes);
    if (!ideal) return std::nullopt;
    edge.row(k) = ideal->transpose();
  }
  return ellipseThrough(edge, ideal_centre, seen.semi_axes_px.x());
}

}  // namespace

std::optional<CircleObservation> inIdealPixels(const CircleObservation& of_sensor,
                                               const CameraIntrinsics& camera) {
  const std::optional<Eigen::Vector2d> centre = idealPixel(camera, of_sensor.centre_px);
  if (!centre) return std::nullopt;
  CircleObservation ideal = of_sensor;
  ideal.centre_px = *centre;
  const Eigen::Matrix2d scale = idealPixelScale(camera, *centre);
  ideal.covariance_px2 = scale * of_sensor.covariance_px2 * scale.transpose();
  ideal.velocity_px_s = scale * of_sensor.velocity_px_s;
  if (!(of_sensor.semi_axes_px.y() > 0.0)) return ideal;
  const std::optional<FittedEllipse> ellipse = idealEllipse(of_sensor, *centre, camera);
  if (!ellipse) return std::nullopt;
  ideal.centre_px = ellipse->centre;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(ellipse->shape);
  ideal.semi_axes_px = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().reverse();
  ideal.angle_rad = std::atan2(eigen.eigenvectors()(1, 1), eigen.eigenvectors()(0, 1));
  return ideal;
}

BoardObservations inIdealPixels(const BoardObservations& of_sensor, const CameraIntrinsics& camera) {
  BoardObservations ideal = of_sensor;
  for (BoardView& view : ideal.views) {
    std::vector<CircleObservation> seen;
    for (const CircleObservation& circle : view.circles)
      if (const auto moved = inIdealPixels(circle, camera)) seen.push_back(*moved);
    if (seen.size() < view.circles.size()) view.kind = ViewKind::Partial;
    view.circles = std::move(seen);
  }
  return ideal;
}

BoardObservations throughLens(BoardObservations of_sensor, int height_px,
                              const std::optional<CameraIntrinsics>& lens) {
  for (BoardView& view : of_sensor.views)
    for (CircleObservation& point : view.circles)
      point.rows_below_middle = point.centre_px.y() - 0.5 * (height_px - 1);
  return lens ? inIdealPixels(of_sensor, *lens) : of_sensor;
}

}  // namespace evical
