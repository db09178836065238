#include "core/optimisation/uncertainty/drift_uncertainty.h"

namespace evical {
void reportDrift(const ProjectedInformation& information, const std::vector<Quantity>& drift_blocks,
                 const Eigen::MatrixXd& covariance, UncertaintyReport& report) {
  for (std::size_t k = 0; k < drift_blocks.size(); ++k) {
    const Quantity& knot = drift_blocks[k];
    const auto row = static_cast<Eigen::Index>(3 * k);
    const auto mean = columnOf(knot.address(), information.quantities, information.first_column);
    if (!mean) continue;
    Eigen::MatrixXd by_quantities = -information.drift_by_quantities.middleRows<3>(row);
    by_quantities.middleCols<3>(*mean) += Eigen::Matrix3d::Identity();
    const Eigen::Vector3d variance = information.drift_covariance.diagonal().segment<3>(row) +
                                     (by_quantities * covariance * by_quantities.transpose()).diagonal();
    ImuUncertainty& imu = report.imus[knot.sensor];
    const bool gyroscope = knot.info->id == QuantityId::GyroscopeBias;
    (gyroscope ? imu.gyroscope_drift_std_rad_s : imu.accelerometer_drift_std_m_s2)
        .push_back(variance.cwiseMax(0.0).cwiseSqrt());
  }
}

}  // namespace evical
