#include "core/optimisation/uncertainty/uncertainty_report.h"

#include "core/data/quantity.h"

namespace evical {
UncertaintyReport makeReport(const CalibrationInput& input, const QuantityCovariance& quantities) {
  UncertaintyReport report;
  report.cameras.resize(input.cameras.size());
  report.imus.resize(input.imus.size());
  report.further_boards.resize(input.further_boards.size());
  report.standard_deviations = quantities.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Eigen::VectorXd inverse = report.standard_deviations.cwiseMax(1e-300).cwiseInverse();
  report.correlation = inverse.asDiagonal() * quantities.covariance * inverse.asDiagonal();
  report.correlation.diagonal().setOnes();
  for (std::size_t i = 0; i < quantities.quantities.size(); ++i) {
    QuantityAddress number = quantities.quantities[i].address();
    if (number.id == QuantityId::Intrinsics)
      number.model = input.cameras[number.sensor].lens.detection_intrinsics->model;
    // Unused numbers of intrinsics and gravity, without a column, come last.
    for (Eigen::Index k = quantities.first_column[i]; k < quantities.first_column[i + 1];
         ++k, ++number.component)
      report.columns.push_back(number);
  }
  setSigmas(report);
  return report;
}

}  // namespace evical
