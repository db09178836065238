#include "core/intrinsics/sensor_views.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/circle_conic.h"
#include "core/geometry/so3.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace evical {
namespace {

SensorCircle sensorCircle(const CircleObservation& circle, double time_s, const Board& board,
                          const std::optional<CameraIntrinsics>& detection_intrinsics,
                          const IntrinsicsOptions& options) {
  const Eigen::Vector2d ideal = circle.centre_px + (time_s - circle.time_s) * circle.velocity_px_s;
  Eigen::Matrix2d sensor_from_ideal = Eigen::Matrix2d::Identity();
  SensorCircle out;
  out.on_board_m = board.point_m(circle.circle);
  out.centre_px = ideal;
  if (detection_intrinsics) {
    out.centre_px = pixelFromIdeal(*detection_intrinsics, ideal);
    sensor_from_ideal = idealPixelScale(*detection_intrinsics, ideal).inverse();
  }
  const double floor_px2 = options.min_centre_sigma_px * options.min_centre_sigma_px;
  out.covariance_px2 = sensor_from_ideal * circle.covariance_px2 * sensor_from_ideal.transpose() +
                       floor_px2 * Eigen::Matrix2d::Identity();
  out.only_known = onlyKnownDirection(out.covariance_px2);
  out.lead_effect = sensor_from_ideal * circle.edge_localisation_bias_effect;
  return out;
}

}  // namespace

std::vector<SensorView> sensorViews(const BoardObservations& observations, const Board& board,
                                    const std::optional<CameraIntrinsics>& detection_intrinsics,
                                    const IntrinsicsOptions& options) {
  std::vector<SensorView> views;
  constexpr int kMany = 50;                // of a board with more points, a smaller share suffices
  constexpr double kOfSingleEvents = 0.2;  // most corners have too few of them
  const double share = observations.single_events ? kOfSingleEvents : options.min_circles;
  const double least = std::max(4.0, share * std::min(board.pointCount(), kMany));
  for (const BoardView& view : observations.views) {
    if (static_cast<double>(view.circles.size()) < least) continue;
    SensorView& out = views.emplace_back();
    for (const CircleObservation& circle : view.circles)
      out.time_s += circle.time_s / static_cast<double>(view.circles.size());
    for (const CircleObservation& circle : view.circles)
      out.circles.push_back(sensorCircle(circle, out.time_s, board, detection_intrinsics, options));
  }
  return views;
}

namespace {

struct Ray {
  Eigen::Vector2d on_board_m, normalised;
};

// Gauss-Newton on the ellipses' centres; returns the sum of squares, infinite if it diverges.
double refine(const std::vector<Ray>& rays, double radius_m, RigidTransform& pose) {
  constexpr int kIterations = 6;
  double squares = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> vector = Eigen::Matrix<double, 6, 1>::Zero();
    squares = 0.0;
    for (const Ray& ray : rays) {
      Eigen::Matrix<double, 2, 6> jacobian;
      const auto centre =
          projectedCircleCentre(normalisedCamera(), pose, ray.on_board_m, radius_m, &jacobian);
      if (!centre) return std::numeric_limits<double>::infinity();
      const Eigen::Vector2d error = *centre - ray.normalised;
      matrix += jacobian.transpose() * jacobian;
      vector -= jacobian.transpose() * error;
      squares += error.squaredNorm();
    }
    if (iteration == kIterations) break;
    const Eigen::Matrix<double, 6, 1> step = matrix.ldlt().solve(vector);
    if (!step.allFinite()) return std::numeric_limits<double>::infinity();
    pose.rotation = (pose.rotation * quaternionExp(step.head<3>())).normalized();
    pose.translation_m += step.tail<3>();
  }
  return squares;
}

// Rotation to a camera that looks at the mean direction, so that x/z and y/z of all directions are defined;
// the identity if the directions are near the axis.
Eigen::Quaterniond turnTowards(const std::vector<Eigen::Vector3d>& directions) {
  constexpr double kNear = 0.5;  // cosine of 60 degrees
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double min_z = 1.0;
  for (const Eigen::Vector3d& direction : directions) {
    sum += direction;
    min_z = std::min(min_z, direction.z());
  }
  if (min_z > kNear || sum.norm() < kNear) return Eigen::Quaterniond::Identity();
  return rotationBetween(sum, Eigen::Vector3d::UnitZ());
}

}  // namespace

std::optional<RigidTransform> boardPose(const SensorView& view, const Board& board,
                                        const CameraIntrinsics& camera) {
  std::vector<Ray> rays;
  std::vector<cv::Point3d> on_board;
  std::vector<cv::Point2d> normalised;
  std::vector<Eigen::Vector3d> directions;
  std::vector<const SensorCircle*> seen;
  for (const SensorCircle& circle : view.circles) {
    const auto direction = circle.used ? unprojectRay(camera, circle.centre_px) : std::nullopt;
    if (!direction) continue;
    directions.push_back(*direction);
    seen.push_back(&circle);
  }
  const Eigen::Quaterniond turned_from_camera = turnTowards(directions);
  for (std::size_t k = 0; k < seen.size(); ++k) {
    constexpr double kMinZ = 0.08;  // 85 degrees off the axis
    const Eigen::Vector3d turned = turned_from_camera * directions[k];
    if (turned.z() < kMinZ) continue;
    const Eigen::Vector2d& at_m = seen[k]->on_board_m;
    rays.push_back({at_m, turned.hnormalized()});
    on_board.emplace_back(at_m.x(), at_m.y(), 0.0);
    normalised.emplace_back(rays.back().normalised.x(), rays.back().normalised.y());
  }
  if (rays.size() < 4) return std::nullopt;
  std::vector<cv::Mat> rotations, translations;
  try {
    cv::solvePnPGeneric(on_board, normalised, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations,
                        translations, false, cv::SOLVEPNP_IPPE);
  } catch (const cv::Exception&) {
    return std::nullopt;  // degenerate points
  }
  std::optional<RigidTransform> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < rotations.size(); ++k) {
    const double* const r = rotations[k].ptr<double>();
    const double* const t = translations[k].ptr<double>();
    RigidTransform pose{quaternionExp({r[0], r[1], r[2]}), {t[0], t[1], t[2]}};
    const double squares = refine(rays, board.radius_m, pose);
    if (!(squares < least)) continue;
    least = squares;
    best = pose;
  }
  if (best) {
    best->rotation = turned_from_camera.conjugate() * best->rotation;
    best->translation_m = turned_from_camera.conjugate() * best->translation_m;
  }
  return best;
}

}  // namespace evical
