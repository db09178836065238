// One edge's equation for a camera's motion (docs/maths.md, 16.2): g . (A w + B v / Z) = 1. Internal to this
// folder.
#pragma once

#include "core/data/edge_slope.h"
#include "core/egomotion/egomotion_options.h"
#include "core/egomotion/lens_rays.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace evical {

using ImageMotion = Eigen::Matrix<double, 2, 3>;  // d(image velocity) / d(angular or linear velocity)

// Image motion of a point at rest, for a camera with angular velocity w and velocity v in its own frame: the
// point has the velocity -v - w x P in it.
ImageMotion rotationalMotion(const Eigen::Vector2d& place);
ImageMotion translationalMotion(const Eigen::Vector2d& place);  // at depth 1

struct EdgeRow {
  Eigen::Vector2d slope;     // s by place
  Eigen::Matrix2d variance;  // of the slope
  std::size_t patch = 0;
  double time_s = 0.0;          // since the window's begin
  double depth_variance = 0.0;  // of g . u, from depths that differ within the patch
  ImageMotion by_rotation, by_translation;
  Eigen::Vector3d known_rate_rad_s = Eigen::Vector3d::Zero();  // of the camera, in addition to the fitted one
};

// Every second, third ... slope if a window has more than options.most_slopes. Those outside the lens's view
// are omitted.
std::vector<EdgeRow> edgeRows(std::span<const EdgeSlope> slopes, const LensRays& lens, std::int64_t begin_ns,
                              const EgomotionOptions& options);

// (g . u - 1) / sqrt(u' V u): difference between the slope along the motion and one over the speed, in
// sigmas. Divided by the effect of the slope's noise on u, it has no bias from noise in g (total least
// squares).
struct EdgeResidual {
  double value = 0.0;
  double error = 0.0;  // g . u - 1
  Eigen::Vector2d by_flow = Eigen::Vector2d::Zero();
  Eigen::Vector2d translational = Eigen::Vector2d::Zero();  // part of the flow
};
EdgeResidual edgeResidual(const EdgeRow& row, const Eigen::Vector3d& rate_rad_s,
                          const Eigen::Vector3d& velocity_1_s);  // by this row's depth

}  // namespace evical
