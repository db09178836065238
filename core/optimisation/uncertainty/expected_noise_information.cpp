#include "core/optimisation/uncertainty/expected_noise_information.h"

#include "core/optimisation/normal_equations.h"

#include <ceres/manifold.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

namespace evical {
namespace {

// Moves the splines temporarily.
class SplineShift {
 public:
  explicit SplineShift(const UnknownColumns& columns) {
    for (const Unknown& each : columns.unknowns()) {
      if (!each.spline) continue;
      splines_.push_back(&each);
      numbers_.insert(numbers_.end(), each.values, each.values + each.size);
    }
  }
  SplineShift(const SplineShift&) = delete;
  SplineShift& operator=(const SplineShift&) = delete;
  ~SplineShift() {
    const double* number = numbers_.data();
    for (const Unknown* each : splines_) {
      std::copy_n(number, each->size, each->values);
      number += each->size;
    }
  }

  // Moves the splines' numbers from their original values by a step in tangent columns.
  void moveBy(const Eigen::VectorXd& shift) {
    const double* number = numbers_.data();
    for (const Unknown* each : splines_) {
      const double* const step = shift.data() + each->first;
      if (each->manifold) {
        each->manifold->Plus(number, step, each->values);
      } else {
        std::transform(number, number + each->size, step, each->values, std::plus<>());
      }
      number += each->size;
    }
  }

 private:
  std::vector<const Unknown*> splines_;
  std::vector<double> numbers_;
};

// Information of the quantities at the current splines.
Eigen::MatrixXd informationHere(const UnknownColumns& columns, int threads, const RunContext& context) {
  const Eigen::Index quantities = columns.quantitySize(), knots = columns.driftSize();
  NormalEquations equations(columns);
  assemble(columns, threads, context.stop, equations);
  const Eigen::MatrixXd left = equations.matrix.schurComplement();
  if (knots == 0) return left;
  const Eigen::LDLT<Eigen::MatrixXd> solver(left.bottomRightCorner(knots, knots));
  Eigen::MatrixXd of_quantities = left.topLeftCorner(quantities, quantities);
  of_quantities.triangularView<Eigen::Lower>() -=
      left.topRightCorner(quantities, knots) * solver.solve(left.bottomLeftCorner(knots, quantities));
  return of_quantities.selfadjointView<Eigen::Lower>();
}

}  // namespace

// Both signs, so that linear terms cancel.
Eigen::MatrixXd informationFromNoise(const UnknownColumns& columns, const BandCholesky& splines,
                                     const Eigen::MatrixXd& total, int threads, const RunContext& context) {
  constexpr std::uint64_t kSeed = 20260102;  // arbitrary
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd shift(columns.splineSize());
  for (double& each : shift) each = normal(random);
  splines.correlateInPlace(shift);
  SplineShift moved(columns);
  moved.moveBy(shift);
  const Eigen::MatrixXd ahead = informationHere(columns, threads, context);
  moved.moveBy(-shift);
  return 0.5 * (ahead + informationHere(columns, threads, context)) - total;
}

}  // namespace evical
