#include "core/pipeline/compare/combined_estimates.h"

#include "core/numerics/chi_squared.h"
#include "core/numerics/dense.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {
namespace {

using Indices = std::vector<Eigen::Index>;

// Rounding error of eigenvalues of matrices with unit diagonal.
constexpr double kRounding = 1e-10;

Eigen::VectorXd scaleOf(const Eigen::MatrixXd& symmetric) {
  constexpr double kMin = 1e-300;
  return symmetric.diagonal().cwiseMax(kMin).cwiseSqrt();
}

// Inverse of a matrix that may be singular up to rounding.
Eigen::MatrixXd inverseOfPositive(const Eigen::MatrixXd& symmetric) {
  const Eigen::VectorXd scale = scaleOf(symmetric).cwiseInverse();
  const SymmetricEigen eigen = symmetricEigen(scale.asDiagonal() * symmetric * scale.asDiagonal());
  const Eigen::VectorXd values = eigen.values.cwiseMax(kRounding * eigen.values.maxCoeff());
  return scale.asDiagonal() *
         productTransposed(eigen.vectors * values.cwiseInverse().asDiagonal(), eigen.vectors) *
         scale.asDiagonal();
}

// `all` minus a part of it; negative eigenvalues from rounding or noise are set to zero.
Eigen::MatrixXd without(const Eigen::MatrixXd& all, const Eigen::MatrixXd& part) {
  const Eigen::VectorXd scale = scaleOf(all), inverse = scale.cwiseInverse();
  const SymmetricEigen eigen = symmetricEigen(inverse.asDiagonal() * (all - part) * inverse.asDiagonal());
  return scale.asDiagonal() *
         productTransposed(eigen.vectors * eigen.values.cwiseMax(0.0).asDiagonal(), eigen.vectors) *
         scale.asDiagonal();
}

Eigen::MatrixXd part(const Eigen::MatrixXd& matrix, const Indices& chosen) {
  return matrix(chosen, chosen);
}

}  // namespace

EstimateCombination::EstimateCombination(std::span<const PartialEstimate> estimates, CommonKnowledge known)
    : estimates_(estimates.begin(), estimates.end()), known_(std::move(known)) {
  const Eigen::Index size = known_.value.size();
  for (const PartialEstimate& each : estimates_) {
    const Eigen::MatrixXd prior = part(known_.information, each.unknowns);
    Measured& all = measured_.emplace_back(Measured{
        Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size), Eigen::MatrixXd::Zero(size, size)});
    all.information(each.unknowns, each.unknowns) = without(each.weight, prior);
    all.vector(each.unknowns) =
        each.weight * each.value - prior * Eigen::VectorXd(known_.value(each.unknowns));
    all.scatter(each.unknowns, each.unknowns) = without(congruence(each.weight, each.covariance), prior);
  }
}

EstimateCombination::Solution EstimateCombination::solve(std::span<const std::size_t> chosen) const {
  constexpr double kNothing = 1e-12;  // a sigma of 1e6 for unknowns without information
  Eigen::MatrixXd information = known_.information;
  Solution solution{
      {}, Eigen::MatrixXd::Zero(information.rows(), information.cols()), known_.information * known_.value};
  for (const std::size_t k : chosen) {
    information += measured_[k].information;
    solution.scatter += measured_[k].scatter;
    solution.vector += measured_[k].vector;
  }
  for (Eigen::Index i = 0; i < information.rows(); ++i)
    if (!(information(i, i) > 0.0)) solution.scatter(i, i) = information(i, i) = kNothing;
  solution.inverse = inverseOfPositive(information);
  return solution;
}

CombinedEstimate EstimateCombination::combine(std::span<const std::size_t> chosen) const {
  const Solution solution = solve(chosen);
  return {solution.inverse * solution.vector,
          congruence(solution.inverse, solution.scatter + known_.information)};
}

Eigen::MatrixXd EstimateCombination::gain(std::size_t one, std::span<const std::size_t> chosen) const {
  const PartialEstimate& each = estimates_[one];
  return product(solve(chosen).inverse(Eigen::all, each.unknowns), each.weight);
}

EstimateDistance EstimateCombination::distance(std::size_t one, std::span<const std::size_t> others) const {
  const PartialEstimate& alone = estimates_[one];
  Indices both;
  for (const Eigen::Index unknown : alone.unknowns)
    if (std::any_of(others.begin(), others.end(),
                    [&](std::size_t k) { return std::ranges::count(estimates_[k].unknowns, unknown) > 0; }))
      both.push_back(unknown);
  if (both.empty()) return {};
  const Solution rest = solve(others);
  const Eigen::Index size = known_.value.size();
  Eigen::MatrixXd own_inverse = Eigen::MatrixXd::Zero(size, size);
  own_inverse(alone.unknowns, alone.unknowns) = inverseOfPositive(alone.weight);
  Eigen::VectorXd own = Eigen::VectorXd::Zero(size);
  own(alone.unknowns) = alone.value;
  const Eigen::MatrixXd of_one = own_inverse(both, Eigen::all), of_rest = rest.inverse(both, Eigen::all);
  const Eigen::VectorXd difference =
      Eigen::VectorXd(own(both)) - Eigen::VectorXd((rest.inverse * rest.vector)(both));
  const Eigen::MatrixXd covariance =
      congruence(of_one, measured_[one].scatter) + congruence(of_rest, rest.scatter) +
      congruence(of_one - of_rest, known_.information) + part(known_.moving, both);
  constexpr double kMin = 1e-7;  // smaller eigenvalues: directions with common priors only
  const Eigen::VectorXd scale = scaleOf(covariance).cwiseInverse();
  const SymmetricEigen eigen = symmetricEigen(scale.asDiagonal() * covariance * scale.asDiagonal());
  EstimateDistance distance;
  for (Eigen::Index i = 0; i < eigen.values.size(); ++i) {
    if (eigen.values[i] < kMin) continue;
    const double along = eigen.vectors.col(i).dot(scale.cwiseProduct(difference));
    distance.chi_square += along * along / eigen.values[i];
    ++distance.freedom;
  }
  return distance;
}

Eigen::VectorXd EstimateCombination::varyingSigmas(std::size_t one) const {
  const PartialEstimate& each = estimates_[one];
  return congruence(inverseOfPositive(each.weight), part(measured_[one].scatter, each.unknowns))
      .diagonal()
      .cwiseMax(0.0)
      .cwiseSqrt();
}

double probabilityBeyond(const EstimateDistance& distance) {
  return distance.freedom == 0 ? 1.0 : chiSquaredTail(distance.chi_square, distance.freedom);
}

}  // namespace evical
