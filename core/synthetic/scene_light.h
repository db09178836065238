// Light of a pixel in a blurred image of any board and its background, at one instant. The scene is
// SceneRenderer's, whose tiles support circles only.
#pragma once

#include "core/synthetic/clutter_texture.h"
#include "core/synthetic/scenario.h"

#include "core/geometry/board.h"
#include "core/geometry/printed_pattern.h"
#include "core/geometry/so3.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <vector>

namespace evical {

// Printed pattern of any board: circles, or squares.
class BoardPattern {
 public:
  BoardPattern(const Board& board, const TagPrint& print);

  // True on ink, at metres on the board; paper beyond its edge.
  bool isInk(const Eigen::Vector2f& p) const;

  // The printed part's corners.
  const Eigen::Vector2f& low_m() const { return low_m_; }
  const Eigen::Vector2f& high_m() const { return high_m_; }

 private:
  bool inCircle(const Eigen::Vector2f& p) const;

  Board board_;
  float spacing_m_, radius_m_;
  Eigen::Vector2f low_m_, high_m_;
  PrintedPattern squares_;  // without circles
};

class SceneLight {
 public:
  // `optics_blur_px`: the point spread's sigma; plus the pixel's area.
  SceneLight(const Scenario& scenario, std::size_t camera, double optics_blur_px);

  // From rays to metres on the planes.
  struct Planes {
    Eigen::Matrix3f board_from_ray, behind_from_ray;
  };
  Planes at(const RigidTransform& world_from_camera) const;

  // Mean reflectances of a pixel: with the board's pattern, and with plain paper instead.
  struct Light {
    float shown = 0.0f, hidden = 0.0f;
  };
  Light of(std::size_t pixel, const Planes& planes) const;

 private:
  // Ray to plane, and its derivative by the pixel.
  struct Place {
    Eigen::Vector2f at_m = Eigen::Vector2f::Zero();
    Eigen::Matrix2f per_px = Eigen::Matrix2f::Zero();
    bool ahead = false;
  };
  // Shares of a pixel: background of the sheet, its paper, its ink.
  using Shares = std::array<float, 3>;

  double texelsPerPixel() const;
  void placeWeights();
  Place placeOn(const Eigen::Matrix3f& plane_from_ray, std::size_t pixel) const;
  bool onSheet(const Eigen::Vector2f& p) const {
    return (p.array() > sheet_low_m_).all() && (p.array() < sheet_high_m_).all();
  }
  int shadeAt(const Eigen::Vector2f& p) const { return onSheet(p) ? (pattern_.isInk(p) ? 2 : 1) : 0; }
  Shares sharesOf(const Place& place) const;
  float backgroundOf(std::size_t pixel, const Eigen::Matrix3f& behind) const;

  Scenario scenario_;
  BoardPattern pattern_;
  Eigen::Array2f sheet_low_m_, sheet_high_m_;  // its corners
  float blur_px_, paper_, ink_;
  ClutterTexture texture_;
  float texels_per_m_ = 1.0f;
  std::vector<Eigen::Vector3f> rays_;  // of length 1; zero without one
  std::vector<Eigen::Matrix<float, 3, 2>> ray_per_px_;
  std::vector<Eigen::Vector2f> offsets_px_;
  std::vector<float> weights_;
};

}  // namespace evical
