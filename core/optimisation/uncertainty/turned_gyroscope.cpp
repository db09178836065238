#include "core/optimisation/uncertainty/turned_gyroscope.h"

#include "core/numerics/angles.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

// Free for the test's sake, not because there is a prior to be weighed.
bool isLookedFor(const Quantity& quantity, const CalibrationInput& input) {
  if (quantity.info->release != QuantityRelease::GyroscopeRotation) return false;
  const auto& prior = input.imus[quantity.sensor].prior.gyroscope_rotation;
  return !(prior && prior->sigma);
}

class ScaledInverse {
 public:
  explicit ScaledInverse(const Eigen::MatrixXd& information)
      : scale_(information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse()),
        solver_(scale_.asDiagonal() * information * scale_.asDiagonal()) {}

  Eigen::VectorXd times(const Eigen::VectorXd& vector) const {
    return scale_.cwiseProduct(solver_.solve(scale_.cwiseProduct(vector)));
  }
  double sigma(Eigen::Index i) const {
    return std::sqrt(std::max(0.0, times(Eigen::VectorXd::Unit(scale_.size(), i))[i]));
  }

 private:
  Eigen::VectorXd scale_;
  Eigen::LDLT<Eigen::MatrixXd> solver_;
};

}  // namespace

std::string turnedGyroscopes(const CalibrationInput& input, const ProjectedInformation& information,
                             const ProjectedInformation& credible, const OptimisationOptions& options) {
  std::string doubts;
  if (information.quantities.empty()) return doubts;
  const Eigen::VectorXd step = -ScaledInverse(information.total).times(information.gradient);
  // Sigmas that take residuals for uncorrelated: under the turn that is looked for they are not, and sigmas
  // that allow for that would hide it.
  const ScaledInverse covariance(credible.total);
  for (std::size_t i = 0; i < information.quantities.size(); ++i) {
    const Quantity& quantity = information.quantities[i];
    if (!isLookedFor(quantity, input)) continue;
    const Eigen::Index first = information.first_column[i];
    const double turn_deg = kDegPerRad * step.segment<3>(first).norm();
    double certainty = 0.0;
    for (Eigen::Index axis = first; axis < first + 3; ++axis)
      certainty = std::max(certainty, std::abs(step[axis]) / std::max(covariance.sigma(axis), 1e-12));
    if (turn_deg < options.needed_rotation_deg || certainty < options.turned_gyroscope_sigmas) continue;
    doubts += fmt::format(
        "{}{}: the gyroscope seems to be turned by about {:.2g} deg against the accelerometer, and other "
        "rotations may be off by as much; calibrate with optimisation.gyroscope_rotation: true",
        doubts.empty() ? "" : "; ", input.imus[quantity.sensor].name, turn_deg);
  }
  return doubts;
}

ProjectedInformation withoutLookedForRotation(const CalibrationInput& input,
                                              ProjectedInformation information) {
  std::vector<Eigen::Index> kept;
  std::vector<Quantity> quantities;
  std::vector<Eigen::Index> first_column = {0};
  for (std::size_t i = 0; i < information.quantities.size(); ++i) {
    if (isLookedFor(information.quantities[i], input)) continue;
    quantities.push_back(information.quantities[i]);
    for (Eigen::Index k = information.first_column[i]; k < information.first_column[i + 1]; ++k)
      kept.push_back(k);
    first_column.push_back(static_cast<Eigen::Index>(kept.size()));
  }
  const auto shrinkMatrix = [&](Eigen::MatrixXd& matrix) { matrix = matrix(kept, kept).eval(); };
  const auto shrinkVector = [&](Eigen::VectorXd& vector) { vector = vector(kept).eval(); };
  information.quantities = std::move(quantities);
  information.first_column = std::move(first_column);
  shrinkMatrix(information.total);
  shrinkMatrix(information.from_noise);
  shrinkVector(information.gradient);
  for (MeasurementGroup& group : information.groups) shrinkMatrix(group.information);
  for (Eigen::VectorXd& score : information.scores) shrinkVector(score);
  for (Eigen::VectorXd& effect : information.pixel_errors) shrinkVector(effect);
  if (information.drift_by_quantities.size() > 0)
    information.drift_by_quantities = information.drift_by_quantities(Eigen::all, kept).eval();
  return information;
}

}  // namespace evical
