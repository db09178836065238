#include "core/report/html/html_text.h"
#include "core/report/html/report_page.h"
#include "core/report/html/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace evical::html {
namespace {

constexpr std::array<const char*, 3> kAxisColours = {"c0", "c1", "c2"};

// Biases of one sensor at the knots, minus their means.
struct Drift {
  std::string file, title, unit;
  const BiasDrift& knots;
  const std::vector<Eigen::Vector3d>&values, &sigmas;
};

PlotTable biasTable(const Drift& drift) {
  PlotTable table("plots/" + drift.file + ".csv",
                  {"time_s", "x [" + drift.unit + "]", "y [" + drift.unit + "]", "z [" + drift.unit + "]",
                   "std_x", "std_y", "std_z"});
  for (std::size_t k = 0; k < drift.values.size(); ++k) {
    const Eigen::Vector3d& value = drift.values[k];
    const Eigen::Vector3d sigma = k < drift.sigmas.size() ? drift.sigmas[k] : Eigen::Vector3d::Zero();
    table.add({drift.knots.knotTime_s(k), value.x(), value.y(), value.z(), sigma.x(), sigma.y(), sigma.z()});
  }
  return table;
}

void writeDrift(const Drift& drift, ReportPage& page) {
  const PlotTable table = biasTable(drift);
  PlotFrame frame;
  frame.title = drift.title + ": bias minus its mean";
  frame.x_label = "time [s]";
  frame.y_label = drift.unit;
  frame.x = rangeOf(table.values[0], 0.0);
  frame.y = rangeOf(table.values[1]);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> low, high;
    for (std::size_t k = 0; k < table.rows(); ++k) {
      low.push_back(table.values[axis + 1][k] - table.values[axis + 4][k]);
      high.push_back(table.values[axis + 1][k] + table.values[axis + 4][k]);
    }
    frame.y = joined(frame.y, joined(rangeOf(low), rangeOf(high)));
  }
  SvgPlot plot(frame);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    plot.line(table.values[0], table.values[axis + 1], kAxisColours[axis]);
    for (std::size_t k = 0; k < table.rows(); ++k) {
      const double time_s = table.values[0][k], value = table.values[axis + 1][k];
      const double sigma = table.values[axis + 4][k];
      plot.segment(time_s, value - sigma, time_s, value + sigma, kAxisColours[axis]);
    }
  }
  plot.legend({{"c0", "x"}, {"c1", "y"}, {"c2", "z"}});
  page.figure(plot.svg(), "The bias is linear between knots; bars are one standard deviation at the knots.",
              &table);
  page.keep(table);
}

}  // namespace

void writeBiases(const ReportData& data, ReportPage& page) {
  const std::vector<ImuState>& imus = data.named.result->state.imus;
  if (std::all_of(imus.begin(), imus.end(), [](const ImuState& imu) { return imu.bias_drift.knots() == 0; }))
    return;
  page.beginSection("biases", "Biases over time");
  for (std::size_t i = 0; i < imus.size(); ++i) {
    const BiasDrift& drift = imus[i].bias_drift;
    if (drift.knots() == 0) continue;
    const std::vector<ImuUncertainty>& sigmas = data.named.result->uncertainty.imus;
    const ImuUncertainty sigma = i < sigmas.size() ? sigmas[i] : ImuUncertainty{};
    page.heading("IMU " + imuName(data, i));
    writeDrift({fmt::format("imu{}_gyroscope_bias", i + 1), "Gyroscope", "rad/s", drift,
                drift.gyroscope_rad_s, sigma.gyroscope_drift_std_rad_s},
               page);
    writeDrift({fmt::format("imu{}_accelerometer_bias", i + 1), "Accelerometer", "m/s\u00b2", drift,
                drift.accelerometer_m_s2, sigma.accelerometer_drift_std_m_s2},
               page);
  }
  page.endSection();
}

}  // namespace evical::html
