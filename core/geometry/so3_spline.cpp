#include "core/geometry/so3_spline.h"

#include "core/geometry/so3.h"
#include "core/geometry/spline_basis.h"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace evical {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// skew(v) * m without forming the skew matrix.
Matrix3d crossColumns(const Vector3d& v, const Matrix3d& m) {
  Matrix3d product;
  product.row(0) = v.y() * m.row(2) - v.z() * m.row(1);
  product.row(1) = v.z() * m.row(0) - v.x() * m.row(2);
  product.row(2) = v.x() * m.row(1) - v.y() * m.row(0);
  return product;
}

// Derivatives with respect to d_1 .. d_3 become derivatives with respect to the control points:
// d_j moves by inverse_jacobian_j delta_j - inverse_jacobian_j^T delta_{j-1}.
void chainToControlPoints(const std::array<Matrix3d, 3>& by_step,
                          const std::array<Matrix3d, 3>& inverse_jacobians,
                          std::array<Matrix3d, 4>& by_control_point) {
  by_control_point[0].noalias() = -(by_step[0] * inverse_jacobians[0].transpose());
  for (std::size_t j = 1; j < 3; ++j) {
    by_control_point[j].noalias() = by_step[j - 1] * inverse_jacobians[j - 1];
    by_control_point[j].noalias() -= by_step[j] * inverse_jacobians[j].transpose();
  }
  by_control_point[3].noalias() = by_step[2] * inverse_jacobians[2];
}

}  // namespace

SplinePlace placeInSpline(double start_s, double knot_spacing_s, int segment_count, double time_s) {
  const double position = (time_s - start_s) / knot_spacing_s;
  const double segment =
      std::clamp(std::floor(position), 0.0, std::max(0.0, static_cast<double>(segment_count - 1)));
  return {static_cast<int>(segment), position - segment};
}

SplinePlace placeInSpline(const So3Spline& spline, double time_s) {
  return placeInSpline(spline.start_s, spline.knot_spacing_s, spline.segmentCount(), time_s);
}

int segmentsToCover(double begin_s, double end_s, double knot_spacing_s) {
  return std::max(1, static_cast<int>(std::ceil((end_s - begin_s) / knot_spacing_s - 1e-9)));
}

So3Spline makeUniformSo3Spline(double begin_s, double end_s, double knot_spacing_s,
                               const Quaterniond& rotation) {
  const auto count = static_cast<std::size_t>(segmentsToCover(begin_s, end_s, knot_spacing_s)) + 3;
  return {begin_s, knot_spacing_s, std::vector<Quaterniond>(count, rotation)};
}

So3Segment::So3Segment(const double* r0_xyzw, const double* r1_xyzw, const double* r2_xyzw,
                       const double* r3_xyzw, double knot_spacing_s, bool with_jacobians)
    : knot_spacing_s_(knot_spacing_s) {
  initialise({Quaterniond(r0_xyzw), Quaterniond(r1_xyzw), Quaterniond(r2_xyzw), Quaterniond(r3_xyzw)},
             with_jacobians);
}

So3Segment::So3Segment(const So3Spline& spline, int segment, bool with_jacobians)
    : knot_spacing_s_(spline.knot_spacing_s) {
  const auto* r = &spline.control_points[static_cast<std::size_t>(segment)];
  initialise({r[0], r[1], r[2], r[3]}, with_jacobians);
}

void So3Segment::initialise(const std::array<Quaterniond, 4>& rotations, bool with_jacobians) {
  first_ = rotations[0].toRotationMatrix();
  for (std::size_t j = 0; j < 3; ++j) {
    steps_[j] = quaternionLog(rotations[j].conjugate() * rotations[j + 1]);
    if (with_jacobians) inverse_jacobians_[j] = so3RightJacobianInverse(steps_[j]);
  }
}

void So3Segment::evaluate(double u, RotationOrder order, RotationSample& sample,
                          RotationJacobians* jacobians) const {
  const CumulativeWeights l = cumulativeWeights(u, knot_spacing_s_);
  Factors factors;
  for (std::size_t j = 0; j < 3; ++j) {
    const double weight = l.value[static_cast<Eigen::Index>(j)];
    so3ExpAndRightJacobian(weight * steps_[j], factors.rotations[j], factors.by_step[j]);
    if (jacobians) factors.by_step[j] *= weight;
  }
  const std::array<Matrix3d, 3>& a = factors.rotations;
  const Matrix3d tail = a[1] * a[2];
  const Matrix3d all = a[0] * tail;
  sample.rotation.noalias() = first_ * all;
  if (jacobians) {
    const std::array<Matrix3d, 3> by_step = {tail.transpose() * factors.by_step[0],
                                             a[2].transpose() * factors.by_step[1], factors.by_step[2]};
    chainToControlPoints(by_step, inverse_jacobians_, jacobians->rotation);
    jacobians->rotation[0] += all.transpose();
  }
  if (order != RotationOrder::Rotation) evaluateRates(l, factors, order, sample, jacobians);
}

// The recursions of docs/maths.md, 2, and their derivatives with respect to d_1 .. d_3 alongside.
void So3Segment::evaluateRates(const CumulativeWeights& l, const Factors& factors, RotationOrder order,
                               RotationSample& sample, RotationJacobians* jacobians) const {
  Vector3d velocity = l.first_s[0] * steps_[0];
  Vector3d acceleration = l.second_s2[0] * steps_[0];
  std::array<Matrix3d, 3> velocity_by_step, acceleration_by_step;
  if (jacobians) {
    velocity_by_step[0] = l.first_s[0] * Matrix3d::Identity();
    acceleration_by_step[0] = l.second_s2[0] * Matrix3d::Identity();
  }
  for (std::size_t j = 1; j < 3; ++j) {
    const auto row = static_cast<Eigen::Index>(j);
    const Matrix3d back = factors.rotations[j].transpose();
    const Vector3d own_velocity = l.first_s[row] * steps_[j];
    const Vector3d turned_velocity = back * velocity, turned_acceleration = back * acceleration;
    velocity = turned_velocity + own_velocity;
    acceleration = turned_acceleration + l.second_s2[row] * steps_[j] + velocity.cross(own_velocity);
    if (!jacobians) continue;
    for (std::size_t i = 0; i < j; ++i) velocity_by_step[i] = (back * velocity_by_step[i]).eval();
    velocity_by_step[j] = crossColumns(turned_velocity, factors.by_step[j]);
    velocity_by_step[j].diagonal().array() += l.first_s[row];
    if (order != RotationOrder::Acceleration) continue;
    for (std::size_t i = 0; i < j; ++i) {
      acceleration_by_step[i] =
          (back * acceleration_by_step[i]).eval() - crossColumns(own_velocity, velocity_by_step[i]);
    }
    acceleration_by_step[j] = crossColumns(turned_acceleration, factors.by_step[j]) +
                              l.first_s[row] * skew(velocity) -
                              crossColumns(own_velocity, velocity_by_step[j]);
    acceleration_by_step[j].diagonal().array() += l.second_s2[row];
  }
  sample.angular_velocity_rad_s = velocity;
  sample.angular_acceleration_rad_s2 = acceleration;
  if (!jacobians) return;
  chainToControlPoints(velocity_by_step, inverse_jacobians_, jacobians->velocity);
  if (order == RotationOrder::Acceleration) {
    chainToControlPoints(acceleration_by_step, inverse_jacobians_, jacobians->acceleration);
  }
}

RotationSample evaluate(const So3Spline& spline, double time_s, RotationOrder order,
                        RotationJacobians* jacobians) {
  const SplinePlace place = placeInSpline(spline, time_s);
  RotationSample sample;
  So3Segment(spline, place.segment, jacobians != nullptr).evaluate(place.u, order, sample, jacobians);
  return sample;
}

namespace {

// Control points at the data, linearly interpolated on the sphere: a start value from which Gauss-Newton
// converges.
void interpolateControlPoints(std::span<const double> times_s, std::span<const Quaterniond> rotations,
                              So3Spline& spline) {
  std::vector<std::size_t> order(times_s.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return times_s[a] < times_s[b]; });
  std::size_t next = 0;
  for (std::size_t k = 0; k < spline.control_points.size(); ++k) {
    const double time_s = spline.start_s + (static_cast<double>(k) - 1.0) * spline.knot_spacing_s;
    while (next < order.size() && times_s[order[next]] < time_s) ++next;
    if (next == 0 || next == order.size()) {
      spline.control_points[k] = rotations[next == 0 ? order.front() : order.back()];
      continue;
    }
    const std::size_t before = order[next - 1], after = order[next];
    const double gap_s = times_s[after] - times_s[before];
    const double fraction = gap_s > 0.0 ? (time_s - times_s[before]) / gap_s : 0.0;
    spline.control_points[k] = rotations[before].slerp(fraction, rotations[after]).normalized();
  }
}

class NormalEquations {
 public:
  explicit NormalEquations(std::size_t control_points)
      : gradient_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * control_points))) {}

  template <std::size_t Count>
  void add(std::size_t first, const std::array<Matrix3d, Count>& jacobians, const Vector3d& residual,
           double weight) {
    for (std::size_t a = 0; a < Count; ++a) {
      const auto row = static_cast<Eigen::Index>(3 * (first + a));
      gradient_.segment<3>(row) += weight * jacobians[a].transpose() * residual;
      for (std::size_t b = 0; b <= a; ++b) {
        const auto col = static_cast<Eigen::Index>(3 * (first + b));
        const Matrix3d product = weight * jacobians[a].transpose() * jacobians[b];
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) entries_.emplace_back(row + i, col + j, product(i, j));
        }
      }
    }
  }

  Eigen::VectorXd step() {
    Eigen::SparseMatrix<double> information(gradient_.size(), gradient_.size());
    information.setFromTriplets(entries_.begin(), entries_.end());
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver(information);
    return -solver.solve(gradient_);
  }

 private:
  Eigen::VectorXd gradient_;
  std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace

So3Spline fitSo3Spline(std::span<const double> times_s, std::span<const Quaterniond> rotations,
                       double begin_s, double end_s, double knot_spacing_s) {
  So3Spline spline = makeUniformSo3Spline(begin_s, end_s, knot_spacing_s);
  if (times_s.empty()) return spline;
  interpolateControlPoints(times_s, rotations, spline);
  constexpr int kIterations = 5;        // converges quadratically; the last step is rounding
  constexpr double kSmoothness = 1e-8;  // constrains points without data, does not move the others
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    NormalEquations equations(spline.control_points.size());
    for (std::size_t i = 0; i < times_s.size(); ++i) {
      const SplinePlace place = placeInSpline(spline, times_s[i]);
      RotationJacobians jacobians;
      const RotationSample sample = evaluate(spline, times_s[i], RotationOrder::Rotation, &jacobians);
      const Vector3d residual = so3Log(rotations[i].conjugate().toRotationMatrix() * sample.rotation);
      const Matrix3d inverse_jacobian = so3RightJacobianInverse(residual);
      for (Matrix3d& jacobian : jacobians.rotation) jacobian = (inverse_jacobian * jacobian).eval();
      equations.add(static_cast<std::size_t>(place.segment), jacobians.rotation, residual, 1.0);
    }
    for (std::size_t k = 0; k + 2 < spline.control_points.size(); ++k) {
      const auto* r = &spline.control_points[k];
      const Vector3d before = quaternionLog(r[0].conjugate() * r[1]),
                     after = quaternionLog(r[1].conjugate() * r[2]);
      const Matrix3d identity = Matrix3d::Identity();
      equations.add(k, std::array<Matrix3d, 3>{identity, -2.0 * identity, identity}, after - before,
                    kSmoothness);
    }
    const Eigen::VectorXd step = equations.step();
    for (std::size_t k = 0; k < spline.control_points.size(); ++k) {
      const Vector3d delta = step.segment<3>(static_cast<Eigen::Index>(3 * k));
      spline.control_points[k] = (spline.control_points[k] * quaternionExp(delta)).normalized();
    }
    if (step.lpNorm<Eigen::Infinity>() < 1e-12) break;
  }
  return spline;
}

}  // namespace evical
