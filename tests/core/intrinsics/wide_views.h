// Board views of wide lenses, corners and circles, anywhere in the image.
#pragma once

#include "core/data/board_observations.h"
#include "core/geometry/board.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/circle_conic.h"
#include "core/geometry/so3.h"

#include <Eigen/Geometry>

#include <cmath>
#include <optional>
#include <random>

namespace evical::test {

struct WideViews {
  Board board;
  CameraIntrinsics camera;
  double noise_px = 0.08;
  double furthest_deg = 95.0;  // of the board's middle off the axis
  int views = 120;
};

// The data set TUM VI's left camera; 512 x 512 pixels see 75 degrees to each side, 105 in the corners.
inline CameraIntrinsics wideCamera(CameraModel model) {
  CameraIntrinsics camera{model, {512, 512}, {191.1, 191.2}, {254.9, 256.9}, {0.63, 1.04, 0.0, 0.0, 0.0}};
  if (model == CameraModel::DoubleSphere) {
    camera.focal_length_px = {158.3, 158.2};
    camera.distortion = {-0.172, 0.593, 0.0, 0.0, 0.0};
  }
  // A fisheye of 130 degrees, as in scenario fisheye.
  if (model == CameraModel::PinholeEquidistant)
    camera = {model, {640, 480}, {283.5, 283.9}, {321.3, 241.8}, {0.012, -0.006, 0.003, -0.001, 0.0}};
  if (model == CameraModel::OmniRadtan) {
    camera.focal_length_px = {330.0, 330.5};
    camera.distortion = {1.2, -0.03, 0.01, 4e-4, -3e-4};
  }
  return camera;
}

// In the sensor's own pixels, for an unknown lens. Circles only if all of a circle is in front of the camera,
// since the front end would measure ellipse centres in the ideal pixels of the true lens.
inline BoardObservations observeWide(const WideViews& wide, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::Vector2d middle_m = 0.5 * wide.board.extent_m();
  const auto pixelOf = [&](const RigidTransform& pose, int circle) -> std::optional<Eigen::Vector2d> {
    const Eigen::Vector2d at_m = wide.board.point_m(circle);
    if (wide.board.radius_m == 0.0)
      return project(wide.camera, pose * Eigen::Vector3d(at_m.x(), at_m.y(), 0.0));
    const auto ideal = projectedCircleCentre(wide.camera, pose, at_m, wide.board.radius_m);
    const Eigen::Vector3d centre = pose * Eigen::Vector3d(at_m.x(), at_m.y(), 0.0);
    if (!ideal || centre.z() < 0.25 * centre.norm()) return std::nullopt;
    return pixelFromIdeal(wide.camera, *ideal);
  };
  BoardObservations observations;
  observations.camera = "wide";
  for (int v = 0; v < wide.views; ++v) {
    const double off_rad = wide.furthest_deg * M_PI / 180.0 * std::sqrt(0.5 + 0.5 * uniform(generator));
    const double round_rad = M_PI * uniform(generator);
    const Eigen::Vector3d axis(-std::sin(round_rad), std::cos(round_rad), 0.0);
    // Seen from the front, then tilted and rotated, then moved to its position in the image.
    const Eigen::Quaterniond off = quaternionExp(off_rad * axis);
    const Eigen::Quaterniond tilt =
        quaternionExp({0.6 * uniform(generator), 0.6 * uniform(generator), M_PI * uniform(generator)});
    const double distance_m = 0.5 + 0.2 * uniform(generator);
    RigidTransform pose{off * tilt, {}};
    pose.translation_m = off * Eigen::Vector3d(0.0, 0.0, distance_m) -
                         pose.rotation * Eigen::Vector3d(middle_m.x(), middle_m.y(), 0.0);
    BoardView view;
    view.time_s = 0.25 * v;
    for (int i = 0; i < wide.board.pointCount(); ++i) {
      const auto pixel = pixelOf(pose, i);
      if (!pixel || pixel->minCoeff() < 0.0 || pixel->x() > wide.camera.resolution_px.width_px - 1.0 ||
          pixel->y() > wide.camera.resolution_px.height_px - 1.0)
        continue;
      CircleObservation circle;
      circle.circle = i;
      circle.time_s = view.time_s;
      const double x = normal(generator), y = normal(generator);
      circle.centre_px = *pixel + wide.noise_px * Eigen::Vector2d(x, y);
      circle.velocity_px_s.setZero();
      circle.edge_localisation_bias_effect.setZero();
      circle.covariance_px2 = wide.noise_px * wide.noise_px * Eigen::Matrix2d::Identity();
      view.circles.push_back(circle);
    }
    if (!view.circles.empty()) observations.views.push_back(view);
  }
  return observations;
}

}  // namespace evical::test
