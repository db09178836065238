// Moving figures in a simulated scene: a hand in front of the board, people behind it. Flat figures in planes
// parallel to the board, of limbs with round ends; their places follow from the scenario's seed and the time.
#pragma once

#include "core/synthetic/scenario.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace evical {

constexpr double kHandComesAndGoes_s = 1.6;  // in total

// All points within the radius of a line.
struct Limb {
  Eigen::Vector2f from_m, to_m;
  float radius_m;

  float inside_m(const Eigen::Vector2f& point_m) const {
    const Eigen::Vector2f along = to_m - from_m, away = point_m - from_m;
    const float length2 = along.squaredNorm();
    const float part = length2 > 0.0f ? std::clamp(away.dot(along) / length2, 0.0f, 1.0f) : 0.0f;
    return radius_m - (away - part * along).norm();
  }
};

struct Figure {
  static constexpr int kMaxLimbs = 8;

  int visit = 0;                // distinguishes figures of two instants
  float behind_board_m = 0.0f;  // its plane; negative: in front of the board
  Eigen::Vector2f place_m = Eigen::Vector2f::Zero();
  Eigen::Matrix2f own_from_plane = Eigen::Matrix2f::Identity();
  std::array<Limb, kMaxLimbs> limbs;
  int limb_count = 0;
  Eigen::Vector2f low_m, high_m;                        // box about all limbs, in its own coordinates
  float log_tone = 0.0f, contrast = 1.0f;               // of the texture
  Eigen::Vector2f texture_m = Eigen::Vector2f::Zero();  // offset in the texture's picture

  bool isInFront() const { return behind_board_m < 0.0f; }
  Eigen::Vector2f own_m(const Eigen::Vector2f& on_plane_m) const {
    return own_from_plane * (on_plane_m - place_m);
  }
  // Distance inwards from its outline; negative outside.
  float inside_m(const Eigen::Vector2f& own) const {
    float inside = limbs[0].inside_m(own);
    for (int k = 1; k < limb_count; ++k)
      inside = std::max(inside, limbs[static_cast<std::size_t>(k)].inside_m(own));
    return inside;
  }
};

std::optional<Figure> handAt(const Scenario& scenario, double time_s);
std::vector<Figure> peopleAt(const Scenario& scenario, double time_s);

// True if the hand is between the camera and any part of a disk about a point on the board.
bool isHidden(const Figure& hand, const Eigen::Vector3d& camera_m, const Eigen::Vector3d& centre_m,
              double radius_m);

}  // namespace evical
