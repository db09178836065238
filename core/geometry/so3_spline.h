// Uniform cumulative cubic B-spline on SO(3) (Sommer et al., "Efficient derivative computation for cumulative
// B-splines on Lie groups", CVPR 2020). Between knots i and i + 1, with u in [0, 1):
//   R(t) = R_i A_1 A_2 A_3,  A_j = Exp(l_j(u) d_j),  d_j = Log(R_{i+j-1}^T R_{i+j})
// The spline is defined for start_s <= t <= endTime(); segment s uses control points s .. s + 3, so control
// point k weighs most at start_s + (k - 1) * knot_spacing_s.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <span>
#include <vector>

namespace evical {

struct CumulativeWeights;  // spline_basis.h

struct So3Spline {
  double start_s = 0.0;  // start time of the first segment
  double knot_spacing_s = 0.02;
  std::vector<Eigen::Quaterniond> control_points;

  int segmentCount() const { return static_cast<int>(control_points.size()) - 3; }
  double endTime_s() const { return start_s + knot_spacing_s * segmentCount(); }
  bool contains(double time_s) const { return time_s >= start_s && time_s <= endTime_s(); }
};

// A time in a uniform spline: the segment (clamped to the existing ones) and u within it. Outside the spline,
// u leaves [0, 1], and evaluation extrapolates the first or last segment's polynomial.
struct SplinePlace {
  int segment = 0;
  double u = 0.0;
};
SplinePlace placeInSpline(double start_s, double knot_spacing_s, int segment_count, double time_s);
SplinePlace placeInSpline(const So3Spline& spline, double time_s);

// Number of segments of this spacing that cover [begin_s, end_s].
int segmentsToCover(double begin_s, double end_s, double knot_spacing_s);

// All control points equal; covers [begin_s, end_s], starting at begin_s.
So3Spline makeUniformSo3Spline(double begin_s, double end_s, double knot_spacing_s,
                               const Eigen::Quaterniond& rotation = Eigen::Quaterniond::Identity());

struct RotationSample {
  Eigen::Matrix3d rotation;                     // R(t)
  Eigen::Vector3d angular_velocity_rad_s;       // in the body frame
  Eigen::Vector3d angular_acceleration_rad_s2;  // in the body frame
};

// Derivatives with respect to the segment's four control points, each perturbed as R_k Exp(delta).
// `rotation[k]` maps delta to the perturbation of the value: R(t) -> R(t) Exp(rotation[k] delta).
struct RotationJacobians {
  std::array<Eigen::Matrix3d, 4> rotation, velocity, acceleration;
};

// Orders of derivatives to compute; each includes those before it.
enum class RotationOrder { Rotation, Velocity, Acceleration };

// Common values of all times in one segment. Build it once if many samples fall into the same segment.
class So3Segment {
 public:
  // Quaternions as Eigen stores them (x y z w), like Ceres parameter blocks.
  So3Segment(const double* r0_xyzw, const double* r1_xyzw, const double* r2_xyzw, const double* r3_xyzw,
             double knot_spacing_s, bool with_jacobians);
  So3Segment(const So3Spline& spline, int segment, bool with_jacobians);

  // `u` in [0, 1): place in the segment. `jacobians` only if built with them; fields beyond `order` are
  // unchanged.
  void evaluate(double u, RotationOrder order, RotationSample& sample,
                RotationJacobians* jacobians = nullptr) const;

 private:
  // A_1 .. A_3, and their derivatives with respect to d_1 .. d_3.
  struct Factors {
    std::array<Eigen::Matrix3d, 3> rotations, by_step;
  };
  void evaluateRates(const CumulativeWeights& weights, const Factors& factors, RotationOrder order,
                     RotationSample& sample, RotationJacobians* jacobians) const;
  void initialise(const std::array<Eigen::Quaterniond, 4>& rotations, bool with_jacobians);

  double knot_spacing_s_;
  Eigen::Matrix3d first_;
  std::array<Eigen::Vector3d, 3> steps_;              // d_1 .. d_3
  std::array<Eigen::Matrix3d, 3> inverse_jacobians_;  // right Jacobian's inverse at d_j
};

RotationSample evaluate(const So3Spline& spline, double time_s,
                        RotationOrder order = RotationOrder::Acceleration,
                        RotationJacobians* jacobians = nullptr);

// Least squares fit to rotations at times (in any order) within the spline's range, by Gauss-Newton from the
// interpolated rotations; weak regularisation towards constant angular velocity bridges stretches without
// data.
So3Spline fitSo3Spline(std::span<const double> times_s, std::span<const Eigen::Quaterniond> rotations,
                       double begin_s, double end_s, double knot_spacing_s);

}  // namespace evical
