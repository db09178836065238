// Homography of a plane onto another, as by a camera without distortion.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace evical {

// A homography takes no fewer points.
inline constexpr std::size_t kLeastForHomography = 4;

// Homography from points to points (normalised direct linear transform); nothing if degenerate.
std::optional<Eigen::Matrix3d> fitHomography(const std::vector<Eigen::Vector2d>& from,
                                             const std::vector<Eigen::Vector2d>& to);

}  // namespace evical
