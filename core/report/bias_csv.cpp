#include "core/report/bias_csv.h"

#include "core/report/csv_text.h"

#include <fmt/format.h>

#include <iterator>

namespace evical {
namespace {

void append(const Eigen::Vector3d& values, std::string& text) {
  for (const double value : values) fmt::format_to(std::back_inserter(text), ",{:.6e}", value);
}

Eigen::Vector3d at(const std::vector<Eigen::Vector3d>& sigmas, std::size_t knot) {
  return knot < sigmas.size() ? sigmas[knot] : Eigen::Vector3d::Zero();
}

}  // namespace

std::string biasesCsv(const NamedResult& named) {
  std::string text;
  const CalibrationResult& result = *named.result;
  for (std::size_t i = 0; i < result.state.imus.size(); ++i) {
    const ImuState& imu = result.state.imus[i];
    const ImuUncertainty sigma =
        i < result.uncertainty.imus.size() ? result.uncertainty.imus[i] : ImuUncertainty{};
    for (std::size_t k = 0; k < imu.bias_drift.knots(); ++k) {
      const double time_s = imu.bias_drift.knotTime_s(k);
      text += fmt::format("{},{:.6f}", quotedCsv(named.imus.at(i).name), time_s);
      append(imu.gyroscopeBiasAt_rad_s(time_s), text);
      append(at(sigma.gyroscope_drift_std_rad_s, k), text);
      append(imu.accelerometerBiasAt_m_s2(time_s), text);
      append(at(sigma.accelerometer_drift_std_m_s2, k), text);
      text += "\n";
    }
  }
  if (text.empty()) return text;
  return "imu,time_s,gyroscope_x_rad_s,gyroscope_y_rad_s,gyroscope_z_rad_s,gyroscope_std_x_rad_s,"
         "gyroscope_std_y_rad_s,gyroscope_std_z_rad_s,accelerometer_x_m_s2,accelerometer_y_m_s2,"
         "accelerometer_z_m_s2,accelerometer_std_x_m_s2,accelerometer_std_y_m_s2,accelerometer_std_z_m_s2\n" +
         text;
}

}  // namespace evical
