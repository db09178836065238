// Uniform cubic B-spline in R^3, same knots and segments as so3_spline.h.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace evical {

struct VectorSpline {
  double start_s = 0.0;
  double knot_spacing_s = 0.02;
  std::vector<Eigen::Vector3d> control_points;

  int segmentCount() const { return static_cast<int>(control_points.size()) - 3; }
  double endTime_s() const { return start_s + knot_spacing_s * segmentCount(); }
  bool contains(double time_s) const { return time_s >= start_s && time_s <= endTime_s(); }
};

}  // namespace evical
