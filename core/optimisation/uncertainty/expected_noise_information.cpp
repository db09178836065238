#include "core/optimisation/uncertainty/expected_noise_information.h"

#include "core/optimisation/normal_equations.h"

#include <Eigen/Cholesky>

#include <cstdint>
#include <random>

namespace evical {
namespace {

// Information of the quantities at the current splines.
Eigen::MatrixXd informationHere(const UnknownColumns& columns, int threads, const RunContext& context,
                                NormalEquations& equations) {
  const Eigen::Index quantities = columns.quantitySize(), knots = columns.driftSize();
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
  Eigen::VectorXd of_splines(columns.splineSize());
  for (double& each : of_splines) each = normal(random);
  splines.correlateInPlace(of_splines);
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(columns.size());
  shift.head(of_splines.size()) = of_splines;
  const UnknownNumbers numbers(columns);
  const Eigen::VectorXd solution = numbers.read();
  NormalEquations equations(columns);
  numbers.writeMoved(solution, shift);
  const Eigen::MatrixXd ahead = informationHere(columns, threads, context, equations);
  numbers.writeMoved(solution, -shift);
  const Eigen::MatrixXd behind = informationHere(columns, threads, context, equations);
  numbers.write(solution);
  return 0.5 * (ahead + behind) - total;
}

}  // namespace evical
