// Homography between planes, such as the image of a plane in a camera without distortion.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace evical {

// Smallest number of points for a homography.
inline constexpr std::size_t kMinForHomography = 4;

// Homography from points to points (normalised direct linear transform); empty if degenerate.
std::optional<Eigen::Matrix3d> fitHomography(const std::vector<Eigen::Vector2d>& from,
                                             const std::vector<Eigen::Vector2d>& to);

}  // namespace evical
