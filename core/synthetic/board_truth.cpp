#include "core/synthetic/board_truth.h"

#include "core/geometry/camera_model.h"
#include "core/synthetic/board_surface.h"
#include "core/synthetic/scenario_boards.h"
#include "core/synthetic/session_errors.h"
#include "core/synthetic/visitors.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

namespace evical {
namespace {

// The reference IMU's time of the camera's stamp `stamp_s`.
double worldTime_s(const SimulatedCamera& camera, double stamp_s) {
  return stamp_s + camera.time_offset_s - camera.delay_s();
}

// A plane z = height + slope . (x, y).
struct Sheet {
  double height_m = 0.0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
};

// The plane that touches the board's sheet at a point of it.
Sheet touching(const BoardSurface& surface, const Eigen::Vector2d& point_m) {
  if (!surface.isBent()) return {};
  const Eigen::Vector2d slope = surface.slope(point_m);
  return {surface.behind_m(point_m) - slope.dot(point_m), slope};
}

Eigen::Matrix3d idealFromSheet(const RigidTransform& world_from_camera, const Sheet& sheet,
                               const CameraIntrinsics& intrinsics) {
  const RigidTransform camera_from_world = inverse(world_from_camera);
  const Eigen::Matrix3d r = camera_from_world.rotation.toRotationMatrix();
  Eigen::Matrix3d h;
  h << r.col(0) + sheet.slope.x() * r.col(2), r.col(1) + sheet.slope.y() * r.col(2),
      camera_from_world.translation_m + sheet.height_m * r.col(2);
  Eigen::Matrix3d k = Eigen::Matrix3d::Identity();
  k.diagonal().head<2>() = idealFocalLength_px(intrinsics);
  k.topRightCorner<2, 1>() = intrinsics.principal_point_px;
  return k * h;
}

struct Ellipse {
  Eigen::Vector2d centre;
  double largest_radius;
};

std::optional<Ellipse> imageOfCircle(const Eigen::Matrix3d& h, const Eigen::Vector2d& c, double radius_m) {
  const double r2 = radius_m * radius_m;
  if (!((h * Eigen::Vector3d(c.x(), c.y(), 1.0)).z() > radius_m)) return std::nullopt;
  Eigen::Matrix3d dual;
  dual << c.x() * c.x() - r2, c.x() * c.y(), c.x(), c.x() * c.y(), c.y() * c.y() - r2, c.y(), c.x(), c.y(),
      1.0;
  const Eigen::Matrix3d q = h * dual * h.transpose();
  const Eigen::Vector2d centre = q.topRightCorner<2, 1>() / q(2, 2);
  const Eigen::Matrix2d axes2 = centre * centre.transpose() - q.topLeftCorner<2, 2>() / q(2, 2);
  const double half_trace = 0.5 * axes2.trace();
  const double spread = std::sqrt(std::max(half_trace * half_trace - axes2.determinant(), 0.0));
  return Ellipse{centre, std::sqrt(std::max(half_trace + spread, 0.0))};
}

bool insideImage(const Ellipse& ellipse, const CameraIntrinsics& camera) {
  const Eigen::Vector2d centre = pixelFromIdeal(camera, ellipse.centre);
  const double scale = std::sqrt(std::abs(idealPixelScale(camera, ellipse.centre).determinant()));
  const double r = ellipse.largest_radius / std::max(scale, 1e-6);
  return centre.x() > r && centre.y() > r && centre.x() < camera.resolution_px.width_px - 1 - r &&
         centre.y() < camera.resolution_px.height_px - 1 - r;
}

}  // namespace

std::vector<TrueCircle> trueBoardView(const SinusoidMotion& motion, const Scenario& scenario,
                                      std::size_t index, double stamp_s) {
  constexpr double kStep_s = 1e-5;  // central difference: exact to 1e-6 px/s for such motions
  const SimulatedCamera& camera = scenario.cameras[index];
  const double time_s = worldTime_s(camera, stamp_s);
  const RigidTransform now = motion.boardFromCamera(index, time_s),
                       before = motion.boardFromCamera(index, time_s - kStep_s),
                       after = motion.boardFromCamera(index, time_s + kStep_s);
  std::optional<Scenario> of_further;
  if (furtherBoardOf(scenario, index)) of_further = sceneOf(scenario, index);
  const Scenario& scene = of_further ? *of_further : scenario;
  const BoardSurface surface(scene);
  const std::optional<Figure> hand = handAt(scene, time_s);
  std::vector<TrueCircle> circles;
  for (int i = 0; i < scene.board.pointCount(); ++i) {
    const Eigen::Vector2d on_board_m = trueCentre_m(scene, i);
    const Sheet sheet = touching(surface, on_board_m);
    const auto imageIn = [&](const RigidTransform& world_from_camera) {
      return imageOfCircle(idealFromSheet(world_from_camera, sheet, camera.intrinsics), on_board_m,
                           scene.board.radius_m);
    };
    const std::optional<Ellipse> ellipse = imageIn(now), earlier = imageIn(before), later = imageIn(after);
    if (!ellipse || !earlier || !later) continue;
    circles.push_back({i, ellipse->centre, (later->centre - earlier->centre) / (2.0 * kStep_s),
                       insideImage(*ellipse, camera.intrinsics),
                       hand && isHidden(*hand, now.translation_m,
                                        {on_board_m.x(), on_board_m.y(), surface.behind_m(on_board_m)},
                                        scene.board.radius_m)});
  }
  return circles;
}

int circlesInView(const SinusoidMotion& motion, const Scenario& scenario, std::size_t camera,
                  double stamp_s) {
  int count = 0;
  for (const TrueCircle& circle : trueBoardView(motion, scenario, camera, stamp_s))
    count += circle.isVisible();
  return count;
}

bool boardInView(const SinusoidMotion& motion, const Scenario& scenario, std::size_t camera, double stamp_s) {
  const int least = std::max(4, static_cast<int>(std::ceil(0.4 * boardOf(scenario, camera).pointCount())));
  return circlesInView(motion, scenario, camera, stamp_s) >= least;
}

BoardObservations simulateObservations(const Scenario& scenario, std::size_t camera, double noise_px,
                                       double period_s) {
  const SinusoidMotion motion(scenario);
  const int points = boardOf(scenario, camera).pointCount();
  std::mt19937_64 generator(scenario.seed * 15485863 + camera);
  std::normal_distribution<double> normal;
  BoardObservations observations;
  observations.camera = scenario.cameras[camera].name;
  const double offset_s = scenario.cameras[camera].time_offset_s;
  for (double time_s = 0.1 - offset_s; time_s < scenario.duration_s - 0.1 - offset_s; time_s += period_s) {
    BoardView view;
    view.time_s = time_s;
    for (const TrueCircle& truth : trueBoardView(motion, scenario, camera, time_s)) {
      if (!truth.isVisible()) continue;
      CircleObservation circle;
      circle.circle = truth.circle;
      circle.time_s = time_s;
      const double x = normal(generator), y = normal(generator);
      circle.centre_px = truth.centre_px + noise_px * Eigen::Vector2d(x, y);
      circle.covariance_px2 = Eigen::Matrix2d::Identity() * std::max(noise_px * noise_px, 1e-6);
      circle.velocity_px_s = truth.velocity_px_s;
      circle.events = 100;
      circle.residual_rms_px = noise_px;
      view.circles.push_back(circle);
    }
    const auto count = static_cast<int>(view.circles.size());
    WindowReport report;
    report.time_s = time_s;
    report.half_width_s = 0.5 * period_s;
    report.circles = count;
    const bool partial = count >= std::max(4, static_cast<int>(0.4 * points));
    view.kind = count == points ? ViewKind::Complete : ViewKind::Partial;
    report.outcome = !partial                          ? WindowOutcome::TooFewInGrid
                     : view.kind == ViewKind::Complete ? WindowOutcome::Complete
                                                       : WindowOutcome::Partial;
    observations.windows.push_back(report);
    if (partial) observations.views.push_back(std::move(view));
  }
  return observations;
}

}  // namespace evical
