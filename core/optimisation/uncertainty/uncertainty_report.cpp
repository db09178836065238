#include "core/optimisation/uncertainty/uncertainty_report.h"

#include "core/data/quantity.h"

#include <fmt/format.h>

#include <cmath>

namespace evical {
namespace {

std::string ownerName(const Quantity& quantity, const CalibrationInput& input) {
  switch (quantity.info->owner) {
    case QuantityOwner::Camera:
      return input.cameras[quantity.sensor].name;
    case QuantityOwner::Imu:
      return input.imus[quantity.sensor].name;
    case QuantityOwner::Board:
      return input.boardName(quantity.sensor);
    case QuantityOwner::Rig:
      break;
  }
  return quantity.info->name;
}

// "left.rotation.x [rad]"; of intrinsics and gravity those that are held stand at the end.
void appendNames(const Quantity& quantity, Eigen::Index size, const CalibrationInput& input,
                 std::vector<std::string>& names) {
  const QuantityInfo& info = *quantity.info;
  const std::string sensor = ownerName(quantity, input);
  const std::vector<QuantityPart> parts =
      info.shape == QuantityShape::Intrinsics
          ? quantityParts(info, input.cameras[quantity.sensor].lens.seen_with)
          : quantityParts(info);
  for (std::size_t k = 0; k < static_cast<std::size_t>(size); ++k)
    names.push_back(fmt::format("{}.{} [{}]", sensor, parts.at(k).name, parts[k].unit));
}

template <class Rows, class Uncertainty>
void storeSigma(const Rows& rows, const QuantityInfo& info, const Eigen::VectorXd& sigma,
                Uncertainty& uncertainty) {
  forEachQuantity(rows, [&](const auto& row) {
    if (&row.info == &info) setQuantityNumbers(sigma, row.sigma(uncertainty));
  });
}

void storeStandardDeviations(const Quantity& quantity, const Eigen::VectorXd& sigma,
                             UncertaintyReport& report) {
  switch (quantity.info->owner) {
    case QuantityOwner::Camera:
      storeSigma(kCameraQuantities, *quantity.info, sigma, report.cameras[quantity.sensor]);
      break;
    case QuantityOwner::Imu:
      storeSigma(kImuQuantities, *quantity.info, sigma, report.imus[quantity.sensor]);
      break;
    case QuantityOwner::Board:
      storeSigma(kBoardQuantities, *quantity.info, sigma, report.boardAt(quantity.sensor));
      break;
    case QuantityOwner::Rig:
      report.gravity_direction_std_rad = sigma.head<2>().norm() / std::sqrt(2.0);
      if (sigma.size() == 3) report.gravity_norm_std_m_s2 = sigma[2];
      break;
  }
}

}  // namespace

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
    const Eigen::Index first = quantities.first_column[i], size = quantities.first_column[i + 1] - first;
    appendNames(quantities.quantities[i], size, input, report.names);
    storeStandardDeviations(quantities.quantities[i], report.standard_deviations.segment(first, size),
                            report);
  }
  return report;
}

}  // namespace evical
