// Uniform cubic B-spline in R^3, with the knots and segments of so3_spline.h.
#pragma once

#include <Eigen/Core>

#include <span>
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

// Value and time derivatives, with their weights of the control points segment .. segment + 3:
// the Jacobian with respect to control point k is weight[k] times the identity.
struct VectorSample {
  Eigen::Vector3d value, velocity, acceleration;
  Eigen::Vector4d value_weights, velocity_weights, acceleration_weights;
  int segment = 0;
};
VectorSample evaluate(const VectorSpline& spline, double time_s);

// The same from the four control points of a segment, three doubles each.
VectorSample evaluateVectorSegment(const double* p0, const double* p1, const double* p2, const double* p3,
                                   double u, double knot_spacing_s);

// All control points equal; covers [begin_s, end_s], starting at begin_s.
VectorSpline makeUniformVectorSpline(double begin_s, double end_s, double knot_spacing_s,
                                     const Eigen::Vector3d& value = Eigen::Vector3d::Zero());

// Linear least squares fit to values at times within [begin_s, end_s]. `smoothness` is the weight of the
// integrated squared second difference of the control points relative to one sample; the default only bridges
// stretches without data.
VectorSpline fitVectorSpline(std::span<const double> times_s, std::span<const Eigen::Vector3d> values,
                             double begin_s, double end_s, double knot_spacing_s, double smoothness = 1e-8);

}  // namespace evical
