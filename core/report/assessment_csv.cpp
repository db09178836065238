#include "core/report/assessment_report.h"
#include "core/report/csv_text.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <iterator>
#include <vector>

namespace evical {

std::string stopsCsv(const Maintenance& maintenance) {
  std::string text =
      "imu,from_s,to_s,force_x_m_s2,force_y_m_s2,force_z_m_s2,rate_x_rad_s,rate_y_rad_s,rate_z_rad_s,"
      "residual_m_s2,sigma_m_s2,used\n";
  for (const MaintainedImu& imu : maintenance.imus)
    for (const MaintainedStop& stop : imu.stops) {
      const Eigen::Vector3d &f = stop.force_m_s2, &w = stop.rate_rad_s;
      fmt::format_to(std::back_inserter(text),
                     "{},{:.3f},{:.3f},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.5g},{:.5g},{}\n",
                     csvWord(imu.name), stop.from_s, stop.to_s, f.x(), f.y(), f.z(), w.x(), w.y(), w.z(),
                     stop.residual_m_s2, stop.sigma_m_s2, stop.used ? 1 : 0);
    }
  return text;
}

std::string columnOf(const TrackedQuantity& quantity, const TrackedNumber& number) {
  return fmt::format("{}{}{} [{}]", quantity.name, number.name.empty() ? "" : ".", number.name,
                     quantity.unit);
}

std::string trackCsv(const MaintenanceTrack& track) {
  std::string text = "time_s";
  std::vector<const TrackedNumber*> numbers;
  for (const TrackedQuantity& quantity : track.quantities)
    for (const TrackedNumber& number : quantity.numbers) {
      const std::string name = columnOf(quantity, number);
      text += "," + csvWord(name) + "," + csvWord("std of " + name);
      numbers.push_back(&number);
    }
  text += "\n";
  for (std::size_t k = 0; k < track.times_s.size(); ++k) {
    fmt::format_to(std::back_inserter(text), "{:.3f}", track.times_s[k]);
    for (const TrackedNumber* const number : numbers)
      fmt::format_to(std::back_inserter(text), ",{:.7g},{:.4g}", number->values[k], number->sigmas[k]);
    text += "\n";
  }
  return text;
}

std::string repeatCsv(const Repeatability& repeat) {
  std::string csv =
      "sensor,number,unit,common,recordings,mean,standard_deviation,mean_std,ratio,joint,joint_std";
  for (const std::string& column : repeat.columns)
    csv += fmt::format(",{},{}", csvWord(column), csvWord(column + "_std"));
  csv += "\n";
  const auto cell = [](double value) { return std::isfinite(value) ? fmt::format(",{:.10g}", value) : ","; };
  for (const RepeatedQuantity& quantity : repeat.quantities)
    for (const RepeatedNumber& number : quantity.numbers) {
      csv += fmt::format("{},{},{},{},{}", csvWord(quantity.sensor), csvWord(number.name),
                         csvWord(number.unit), quantity.common ? 1 : 0, number.count);
      for (const double value : {number.mean, number.deviation, number.mean_sigma, number.ratio()})
        csv += cell(value);
      csv += quantity.common ? cell(number.joint) + cell(number.joint_sigma) : ",,";
      for (std::size_t k = 0; k < number.values.size(); ++k)
        csv += cell(number.values[k]) + cell(number.sigmas[k]);
      csv += "\n";
    }
  return csv;
}

}  // namespace evical
