#include "core/geometry/vector_spline.h"

#include "core/geometry/so3_spline.h"
#include "core/geometry/spline_basis.h"

#include <Eigen/SparseCholesky>

namespace evical {

VectorSample evaluateVectorSegment(const double* p0, const double* p1, const double* p2, const double* p3,
                                   double u, double knot_spacing_s) {
  const ControlPointWeights w = controlPointWeights(u, knot_spacing_s);
  Eigen::Matrix<double, 3, 4> points;
  points << Eigen::Map<const Eigen::Vector3d>(p0), Eigen::Map<const Eigen::Vector3d>(p1),
      Eigen::Map<const Eigen::Vector3d>(p2), Eigen::Map<const Eigen::Vector3d>(p3);
  VectorSample sample;
  sample.value = points * w.value;
  sample.velocity = points * w.first_s;
  sample.acceleration = points * w.second_s2;
  sample.value_weights = w.value;
  sample.velocity_weights = w.first_s;
  sample.acceleration_weights = w.second_s2;
  return sample;
}

VectorSample evaluate(const VectorSpline& spline, double time_s) {
  const SplinePlace place =
      placeInSpline(spline.start_s, spline.knot_spacing_s, spline.segmentCount(), time_s);
  const auto* p = &spline.control_points[static_cast<std::size_t>(place.segment)];
  VectorSample sample = evaluateVectorSegment(p[0].data(), p[1].data(), p[2].data(), p[3].data(), place.u,
                                              spline.knot_spacing_s);
  sample.segment = place.segment;
  return sample;
}

VectorSpline makeUniformVectorSpline(double begin_s, double end_s, double knot_spacing_s,
                                     const Eigen::Vector3d& value) {
  const auto count = static_cast<std::size_t>(segmentsToCover(begin_s, end_s, knot_spacing_s)) + 3;
  return {begin_s, knot_spacing_s, std::vector<Eigen::Vector3d>(count, value)};
}

VectorSpline fitVectorSpline(std::span<const double> times_s, std::span<const Eigen::Vector3d> values,
                             double begin_s, double end_s, double knot_spacing_s, double smoothness) {
  VectorSpline spline = makeUniformVectorSpline(begin_s, end_s, knot_spacing_s);
  if (times_s.empty()) return spline;
  const auto count = static_cast<Eigen::Index>(spline.control_points.size());
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(count, 3);
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](Eigen::Index first, const Eigen::VectorXd& weights, const Eigen::Vector3d& value,
                       double scale) {
    for (Eigen::Index a = 0; a < weights.size(); ++a) {
      right.row(first + a) += scale * weights[a] * value.transpose();
      for (Eigen::Index b = 0; b <= a; ++b)
        entries.emplace_back(first + a, first + b, scale * weights[a] * weights[b]);
    }
  };
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const SplinePlace place = placeInSpline(begin_s, knot_spacing_s, spline.segmentCount(), times_s[i]);
    add(place.segment, controlPointWeights(place.u, knot_spacing_s).value, values[i], 1.0);
  }
  for (Eigen::Index k = 0; k + 2 < count; ++k)
    add(k, Eigen::Vector3d(1.0, -2.0, 1.0), Eigen::Vector3d::Zero(), smoothness);
  Eigen::SparseMatrix<double> information(count, count);
  information.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver(information);
  const Eigen::MatrixX3d solution = solver.solve(right);
  for (Eigen::Index k = 0; k < count; ++k)
    spline.control_points[static_cast<std::size_t>(k)] = solution.row(k);
  return spline;
}

}  // namespace evical
