#include "core/synthetic/scene_light.h"

#include "core/geometry/camera_model.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace evical {

BoardPattern::BoardPattern(const Board& board, const TagPrint& print)
    : board_(board),
      spacing_m_(static_cast<float>(board.spacing_m)),
      radius_m_(static_cast<float>(board.radius_m)),
      squares_(board, print) {
  const Eigen::Vector2f extent = board.extent_m().cast<float>();
  const auto beyond_m = static_cast<float>(board.printBeyond_m());
  low_m_ = Eigen::Vector2f::Constant(-beyond_m);
  high_m_ = extent + Eigen::Vector2f::Constant(beyond_m);
}

bool BoardPattern::isInk(const Eigen::Vector2f& p) const {
  if ((p.array() < low_m_.array()).any() || (p.array() > high_m_.array()).any()) return false;
  return board_.hasCircles() ? inCircle(p) : squares_.isInk(p.cast<double>());
}

bool BoardPattern::inCircle(const Eigen::Vector2f& p) const {
  const int row = static_cast<int>(std::lround(p.y() / spacing_m_));
  const bool asymmetric = board_.type == BoardType::AsymmetricCircles;
  for (int r = std::max(0, row - 1); r <= std::min(board_.rows - 1, row + 1); ++r) {
    const float column = p.x() / spacing_m_;
    const int c = asymmetric ? static_cast<int>(std::lround(0.5f * (column - static_cast<float>(r % 2))))
                             : static_cast<int>(std::lround(column));
    if (c < 0 || c >= board_.cols) continue;
    if ((p - board_.point_m(r, c).cast<float>()).squaredNorm() < radius_m_ * radius_m_) return true;
  }
  return false;
}

namespace {

constexpr int kSide = 9;        // of the grid of samples of a pixel at an edge
constexpr float kReach = 2.3f;  // of that grid, in sigmas of the blur
constexpr std::array<std::array<float, 2>, 12> kAround = {{{1, 0},
                                                           {-1, 0},
                                                           {0, 1},
                                                           {0, -1},
                                                           {0.7f, 0.7f},
                                                           {-0.7f, 0.7f},
                                                           {0.7f, -0.7f},
                                                           {-0.7f, -0.7f},
                                                           {0.5f, 0},
                                                           {-0.5f, 0},
                                                           {0, 0.5f},
                                                           {0, -0.5f}}};

// The sheet ends at this distance from the outer circles' centres, or from the ink of other boards.
float marginOf(const Scenario& scenario) {
  const Board& board = scenario.board;
  return static_cast<float>(scenario.scene.margin_m - (board.hasCircles() ? board.printBeyond_m() : 0.0));
}

Eigen::Matrix3f planeFromRay(const RigidTransform& camera_from_world, double depth_m) {
  const Eigen::Matrix3d r = camera_from_world.rotation.toRotationMatrix();
  Eigen::Matrix3d h;
  h << r.col(0), r.col(1), camera_from_world.translation_m + depth_m * r.col(2);
  return h.inverse().cast<float>();
}

// Derivative of a ray of length 1 by its pixel; the length is constant.
Eigen::Matrix<float, 3, 2> rayPerPixel(const CameraIntrinsics& lens, const Eigen::Vector3d& ray) {
  Eigen::Matrix<double, 2, 3> by_ray;
  if (!project(lens, ray, &by_ray)) return Eigen::Matrix<float, 3, 2>::Zero();
  Eigen::Matrix<double, 3, 2> across;
  across.col(0) = ray.unitOrthogonal();
  across.col(1) = ray.cross(across.col(0));
  return (across * (by_ray * across).inverse()).cast<float>();
}

}  // namespace

SceneLight::SceneLight(const Scenario& scenario, std::size_t camera, double optics_blur_px)
    : scenario_(scenario),
      pattern_(scenario.board, scenario.tag_print),
      sheet_low_m_(pattern_.low_m().array() - marginOf(scenario)),
      sheet_high_m_(pattern_.high_m().array() + marginOf(scenario)),
      blur_px_(static_cast<float>(std::sqrt(optics_blur_px * optics_blur_px + 1.0 / 12.0))),
      texture_({scenario.seed, scenario.scene.clutter_contrast, scenario.scene.clutter_object_share,
                scenario.scene.clutter_round_share, scenario.scene.clutter_squares_px * texelsPerPixel(),
                blur_px_ * texelsPerPixel()}) {
  const SceneModel& scene = scenario.scene;
  const bool dark = scenario.board.circles == CircleShade::Dark;
  paper_ = static_cast<float>(dark ? scene.bright_reflectance : scene.dark_reflectance);
  ink_ = static_cast<float>(dark ? scene.dark_reflectance : scene.bright_reflectance);
  const CameraIntrinsics& lens = scenario.cameras[camera].intrinsics;
  for (int y = 0; y < lens.resolution_px.height_px; ++y) {
    for (int x = 0; x < lens.resolution_px.width_px; ++x) {
      const auto ray = unprojectRay(lens, Eigen::Vector2d(x, y));  // none: as beyond a fisheye's circle
      rays_.push_back(ray.value_or(Eigen::Vector3d::Zero()).cast<float>());
      ray_per_px_.push_back(ray ? rayPerPixel(lens, *ray) : Eigen::Matrix<float, 3, 2>::Zero());
    }
  }
  const double px_per_m =
      idealFocalLength_px(lens).x() / (scenario.motion.distance_m + scenario.scene.clutter_distance_m);
  texels_per_m_ = static_cast<float>(texelsPerPixel() * px_per_m);
  placeWeights();
}

double SceneLight::texelsPerPixel() const {
  constexpr double kTexelsOfDetail = 2.0;
  return kTexelsOfDetail / scenario_.scene.clutter_detail_px;
}

void SceneLight::placeWeights() {
  float sum = 0.0f;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const Eigen::Vector2f at =
          2.0f * kReach / (kSide - 1) * Eigen::Vector2f(x, y) - Eigen::Vector2f::Constant(kReach);
      offsets_px_.push_back(blur_px_ * at);
      weights_.push_back(std::exp(-0.5f * at.squaredNorm()));
      sum += weights_.back();
    }
  }
  for (float& weight : weights_) weight /= sum;
}

SceneLight::Planes SceneLight::at(const RigidTransform& world_from_camera) const {
  const RigidTransform camera_from_world = inverse(world_from_camera);
  return {planeFromRay(camera_from_world, 0.0),
          planeFromRay(camera_from_world, scenario_.scene.clutter_distance_m)};
}

SceneLight::Light SceneLight::of(std::size_t pixel, const Planes& planes) const {
  const Place place = placeOn(planes.board_from_ray, pixel);
  Shares shares = {1.0f, 0.0f, 0.0f};
  if (place.ahead) shares = sharesOf(place);
  const float background = shares[0] > 0.0f ? shares[0] * backgroundOf(pixel, planes.behind_from_ray) : 0.0f;
  return {background + shares[1] * paper_ + shares[2] * ink_, background + (shares[1] + shares[2]) * paper_};
}

SceneLight::Place SceneLight::placeOn(const Eigen::Matrix3f& plane_from_ray, std::size_t pixel) const {
  const Eigen::Vector3f h = plane_from_ray * rays_[pixel];
  Place place;
  place.ahead = h.z() > 0.0f;
  if (!place.ahead) return place;
  place.at_m = h.hnormalized();
  place.per_px =
      (plane_from_ray.topRows<2>() - place.at_m * plane_from_ray.row(2)) / h.z() * ray_per_px_[pixel];
  return place;
}

SceneLight::Shares SceneLight::sharesOf(const Place& place) const {
  Shares shares = {};
  const int middle = shadeAt(place.at_m);
  const float reach = kReach * blur_px_;
  bool same = true;
  for (const auto& [x, y] : kAround)
    same = same && shadeAt(place.at_m + place.per_px * Eigen::Vector2f(reach * x, reach * y)) == middle;
  if (same) {
    shares[static_cast<std::size_t>(middle)] = 1.0f;
    return shares;
  }
  for (std::size_t k = 0; k < offsets_px_.size(); ++k)
    shares[static_cast<std::size_t>(shadeAt(place.at_m + place.per_px * offsets_px_[k]))] += weights_[k];
  return shares;
}

float SceneLight::backgroundOf(std::size_t pixel, const Eigen::Matrix3f& behind) const {
  constexpr float kMiddle = 0.25f;  // reflectance
  const Eigen::Vector3f h = behind * rays_[pixel];
  if (!(h.z() > 0.0f)) return kMiddle;
  const Eigen::Vector2f at = texels_per_m_ * h.hnormalized();
  return std::min(1.0f, kMiddle * std::exp(texture_(at.x(), at.y())));
}

}  // namespace evical
