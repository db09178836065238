// Uniform cumulative cubic B-spline on SO(3) (Sommer et al., CVPR 2020). Between knots i and i + 1, with u in [0, 1):
//   R(t) = R_i A_1 A_2 A_3,  A_j = Exp(l_j(u) d_j),  d_j = Log(R_{i+j-1}^T R_{i+j})
// The spline is defined for start_s <= t <= endTime(); segment s uses control points s .. s + 3.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace evical {

struct So3Spline {
  double start_s = 0.0;         // time of the first segment's begin
  double knot_spacing_s = 0.02;
  std::vector<Eigen::Quaterniond> control_points;

  int segmentCount() const { return static_cast<int>(control_points.size()) - 3; }
  double endTime_s() const { return start_s + knot_spacing_s * segmentCount(); }
  bool contains(double time_s) const { return time_s >= start_s && time_s <= endTime_s(); }
};

// A time in a uniform spline: the segment (clamped to those there are) and u within it.
struct SplinePlace {
  int segment = 0;
  double u = 0.0;
};
SplinePlace placeInSpline(double start_s, double knot_spacing_s, int segment_count, double time_s);

}  // namespace evical
