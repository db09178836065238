// Residuals of circles, gyroscope and accelerometer.
#include "core/report/html/html_text.h"
#include "core/report/html/report_page.h"
#include "core/report/html/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace evical::html {
namespace {

std::vector<CircleResidual> usedResiduals(const ReportData& data, std::size_t camera) {
  std::vector<CircleResidual> used;
  for (const CircleResidual& residual : data.named.result->circle_residuals)
    if (residual.used && residual.camera == static_cast<int>(camera) && residual.residual_px.allFinite())
      used.push_back(residual);
  return used;
}

void writeScatter(const std::vector<CircleResidual>& residuals, std::size_t index, double rms_px,
                  ReportPage& page) {
  constexpr std::size_t kMax = 3000;
  PlotTable scatter(fmt::format("plots/camera{}_residuals.csv", index + 1), {"time_s", "dx_px", "dy_px"});
  for (std::size_t i = 0; i < residuals.size(); i += strideFor(residuals.size(), kMax))
    scatter.add({residuals[i].time_s, residuals[i].residual_px.x(), residuals[i].residual_px.y()});
  PlotFrame frame;
  frame.title = "reprojection residuals";
  frame.x_label = "predicted - measured, x [px]";
  frame.y_label = "y [px]";
  frame.width = 420.0;
  frame.height = 380.0;
  frame.equal_scale = true;
  const double shown_px = std::max(1e-3, 4.0 * rms_px);
  frame.x = frame.y = {-shown_px, shown_px};
  SvgPlot plot(frame);
  plot.points(scatter.values[0].empty() ? std::vector<double>{} : scatter.values[1], scatter.values[2],
              "c2 faint", 2.4);
  plot.circle(0.0, 0.0, rms_px, "ink");
  page.figure(
      plot.svg(),
      fmt::format(
          "One in {} points; the ring is the RMS, {} px. The distribution should be round and centred.",
          strideFor(residuals.size(), kMax), significant(rms_px)),
      &scatter);
  page.keep(scatter);
}

void writeBias(const CameraMeasures& camera, std::size_t index, ReportPage& page) {
  constexpr int kMin = 20;  // fewest circles for a mean
  if (camera.cells.empty()) return;
  PlotTable bias(fmt::format("plots/camera{}_bias.csv", index + 1),
                 {"x_px", "y_px", "dx_px", "dy_px", "circles"});
  double largest_px = 1e-6;
  for (const SensorCell& cell : camera.cells) {
    if (cell.residuals < kMin) continue;
    const Eigen::Vector2d middle = 0.5 * (cell.low_px + cell.high_px);
    bias.add({middle.x(), middle.y(), cell.mean_residual_px.x(), cell.mean_residual_px.y(),
              static_cast<double>(cell.residuals)});
    largest_px = std::max(largest_px, cell.mean_residual_px.norm());
  }
  PlotFrame frame;
  frame.title = "mean residual over the image";
  frame.x_label = "x [px]";
  frame.y_label = "y [px]";
  frame.x = {0.0, static_cast<double>(camera.resolution_px.width_px)};
  frame.y = {0.0, static_cast<double>(camera.resolution_px.height_px)};
  frame.y_down = true;
  frame.width = 420.0;
  frame.height = std::clamp(68.0 + 346.0 * frame.y.high / frame.x.high, 160.0, 420.0);
  SvgPlot plot(frame);
  const double stretch = 0.9 * frame.x.high / CameraMeasures::kCols / largest_px;
  for (std::size_t i = 0; i < bias.rows(); ++i) {
    const auto& v = bias.values;
    plot.arrow(v[0][i], v[1][i], v[0][i] + stretch * v[2][i], v[1][i] + stretch * v[3][i], "c0");
  }
  plot.points(bias.values[0], bias.values[1], "muted", 3.0);
  page.figure(plot.svg(),
              fmt::format("Mean residual in each part of the image; the longest arrow is {} px. If all "
                          "arrows point inwards or outwards, the intrinsics do not fit.",
                          significant(largest_px, 2)),
              &bias);
  page.keep(bias);
}

void writePerWindow(const std::vector<CircleResidual>& residuals, std::size_t index, ReportPage& page) {
  constexpr std::size_t kMax = 2000;
  struct Sum {
    double time_s = 0.0, squares = 0.0;
    int count = 0;
  };
  std::map<int, Sum> views;
  for (const CircleResidual& residual : residuals) {
    Sum& sum = views[residual.view];
    sum.time_s += residual.time_s;
    sum.squares += residual.residual_px.squaredNorm();
    ++sum.count;
  }
  PlotTable windows(fmt::format("plots/camera{}_rms_per_window.csv", index + 1),
                    {"time_s", "rms_px", "circles"});
  std::size_t i = 0;
  const std::size_t stride = strideFor(views.size(), kMax);
  for (const auto& [view, sum] : views) {
    if (i++ % stride == 0)
      windows.add(
          {sum.time_s / sum.count, std::sqrt(sum.squares / sum.count), static_cast<double>(sum.count)});
  }
  PlotFrame frame;
  frame.title = "reprojection RMS of each event window";
  frame.x_label = "time [s]";
  frame.y_label = "RMS [px]";
  frame.x = rangeOf(windows.values[0], 0.01);
  frame.y = {0.0, rangeOf(windows.values[1]).high};
  frame.height = 190.0;
  SvgPlot plot(frame);
  plot.points(windows.values[0], windows.values[1], "c2", 2.8);
  page.figure(
      plot.svg(),
      "RMS of each event window. Spikes: misidentified boards, or shocks to the rig. Slow drifts: motion "
      "that the trajectory's spline cannot follow.",
      &windows);
  page.keep(windows);
}

// Measured and predicted signal of one sensor of an IMU.
struct Signal {
  std::string file, title, unit;
  const std::vector<Eigen::Vector3d>& measured;
  const std::vector<Eigen::Vector3d>& predicted;
  const AxisMoments& residual;
  double sigma = 0.0;
};

PlotTable signalTable(const Signal& signal, const std::vector<double>& time_s) {
  constexpr std::size_t kMax = 1500;
  PlotTable table(fmt::format("plots/{}.csv", signal.file),
                  {"time_s", "x_measured", "y_measured", "z_measured", "x_spline", "y_spline", "z_spline",
                   "x_residual", "y_residual", "z_residual"});
  for (std::size_t i = 0; i < time_s.size(); i += strideFor(time_s.size(), kMax)) {
    const Eigen::Vector3d &m = signal.measured[i], &p = signal.predicted[i];
    table.add(
        {time_s[i], m.x(), m.y(), m.z(), p.x(), p.y(), p.z(), m.x() - p.x(), m.y() - p.y(), m.z() - p.z()});
  }
  return table;
}

// Histogram of all samples; the normal curve is that of the given noise density.
PlotTable histogramTable(const Signal& signal) {
  constexpr int kBins = 61;
  const double widest = std::max({4.0 * signal.sigma, 4.0 * signal.residual.deviation.maxCoeff(), 1e-9});
  const double width = 2.0 * widest / kBins;
  PlotTable table(fmt::format("plots/{}_histogram.csv", signal.file), {"residual", "x", "y", "z", "normal"});
  std::vector<std::array<double, 3>> counts(kBins);
  for (std::size_t i = 0; i < signal.measured.size(); ++i) {
    const Eigen::Vector3d residual = signal.measured[i] - signal.predicted[i];
    for (int k = 0; k < 3; ++k) {
      const double bin = std::floor((residual[k] + widest) / width);
      if (bin >= 0.0 && bin < kBins)
        counts[static_cast<std::size_t>(bin)][static_cast<std::size_t>(k)] += 1.0;
    }
  }
  const double scale = 1.0 / (width * std::max<double>(1.0, static_cast<double>(signal.measured.size())));
  for (int bin = 0; bin < kBins; ++bin) {
    const double at = -widest + (bin + 0.5) * width, in_sigmas = at / std::max(signal.sigma, 1e-12);
    const double normal = std::exp(-0.5 * in_sigmas * in_sigmas) /
                          (std::max(signal.sigma, 1e-12) * std::sqrt(2.0 * std::numbers::pi));
    const auto& count = counts[static_cast<std::size_t>(bin)];
    table.add({at, scale * count[0], scale * count[1], scale * count[2], normal});
  }
  return table;
}

PlotFrame timeFrame(const PlotTable& table, const std::string& title, const std::string& unit,
                    std::size_t first, std::size_t last) {
  PlotFrame frame;
  frame.title = title;
  frame.x_label = "time [s]";
  frame.y_label = unit;
  frame.x = rangeOf(table.values[0], 0.0);
  frame.y = rangeOf(table.values[first]);
  for (std::size_t k = first; k <= last; ++k) frame.y = joined(frame.y, rangeOf(table.values[k]));
  return frame;
}

void writeSignal(const Signal& signal, const std::vector<double>& time_s, ReportPage& page) {
  constexpr std::array<const char*, 3> kColours = {"c0", "c1", "c2"};
  const PlotTable table = signalTable(signal, time_s), histogram = histogramTable(signal);
  const std::size_t stride = strideFor(time_s.size(), 1500);
  SvgPlot both(timeFrame(table, signal.title + ": measurement and spline", signal.unit, 1, 6));
  SvgPlot residuals([&] {
    PlotFrame frame = timeFrame(table, signal.title + " residuals", signal.unit, 7, 9);
    frame.height = 190.0;
    return frame;
  }());
  PlotFrame frame;
  frame.title = signal.title + ", histogram of residuals";
  frame.x_label = "measured - spline [" + signal.unit + "]";
  frame.y_label = "density";
  frame.x = rangeOf(histogram.values[0], 0.0);
  frame.y = {0.0, 0.0};
  for (std::size_t k = 1; k <= 4; ++k)
    frame.y.high = std::max(frame.y.high, rangeOf(histogram.values[k]).high);
  frame.height = 220.0;
  SvgPlot bars(frame);
  for (std::size_t k = 0; k < 3; ++k) {
    both.points(table.values[0], table.values[k + 1], std::string(kColours[k]) + " faint", 2.4);
    both.line(table.values[0], table.values[k + 4], kColours[k]);
    residuals.points(table.values[0], table.values[k + 7], kColours[k], 1.8);
    bars.line(histogram.values[0], histogram.values[k + 1], kColours[k]);
  }
  bars.line(histogram.values[0], histogram.values[4], "ink dashed");
  both.legend({{"c0", "x"}, {"c1", "y"}, {"c2", "z: dots measured, line spline"}});
  residuals.legend({{"c0", "x"}, {"c1", "y"}, {"c2", "z"}});
  bars.legend({{"c0", "x"}, {"c1", "y"}, {"c2", "z"}, {"ink", "given noise density"}});
  page.figure(
      both.svg(),
      fmt::format("{}: one in {} samples, and the prediction of the trajectory.", signal.title, stride),
      &table);
  page.figure(residuals.svg(),
              "Residuals. They should look like noise. Waves: a spline that is too stiff, or a time offset "
              "that drifts. Bursts: shocks or vibration.",
              &table);
  const double found = std::sqrt(signal.residual.deviation.squaredNorm() / 3.0);
  page.figure(
      bars.svg(),
      fmt::format("All samples: standard deviation {} {}, {} times that of the noise density (dashed). If it "
                  "is much wider, the given noise density is too small, or there is vibration.",
                  significant(found), signal.unit,
                  signal.sigma > 0.0 ? significant(found / signal.sigma, 2) : "\u2013"),
      &histogram);
  page.keep(table);
  page.keep(histogram);
}

}  // namespace

void writeReprojection(const ReportData& data, const Measures& measures, ReportPage& page) {
  if (data.named.result->circle_residuals.empty()) return;
  page.beginSection("reprojection", "Reprojection");
  for (std::size_t i = 0; i < data.named.result->cameras.size(); ++i) {
    const CameraFit& fit = data.named.result->cameras[i];
    const std::vector<CircleResidual> residuals = usedResiduals(data, i);
    if (residuals.empty()) continue;
    page.heading("Camera " + cameraName(data, i));
    page.text(paragraph(
        "",
        fmt::format("{} px RMS over {} points of {} event windows or frames; {} points rejected as outliers. "
                    "The residuals are {} times those expected by the front end.{}",
                    significant(fit.reprojection_rms_px), fit.circles_used, fit.windows_used,
                    fit.circles_rejected, significant(fit.normalised_rms, 2),
                    fit.neighbour_agreement > 0.0
                        ? fmt::format(" Errors of neighbouring points agree to {:.2f} (correlation).",
                                      fit.neighbour_agreement)
                        : "")));
    page.beginRow();
    writeScatter(residuals, i, fit.reprojection_rms_px, page);
    if (i < measures.cameras.size()) writeBias(measures.cameras[i], i, page);
    page.endRow();
    writePerWindow(residuals, i, page);
  }
  page.endSection();
}

void writeInertial(const ReportData& data, const Measures& measures, ReportPage& page) {
  if (std::all_of(measures.imus.begin(), measures.imus.end(),
                  [](const auto& imu) { return imu.signals.rate_rad_s.time_s.empty(); }))
    return;
  page.beginSection("inertial", "Gyroscope and accelerometer: residuals");
  for (std::size_t i = 0; i < measures.imus.size(); ++i) {
    const ImuMeasures& imu = measures.imus[i];
    const auto& [rate, force] = imu.signals;
    if (rate.time_s.empty()) continue;
    page.heading("IMU " + imuName(data, i));
    writeSignal({fmt::format("imu{}_gyroscope", i + 1), "Gyroscope", "rad/s", rate.measured, rate.predicted,
                 imu.rate_residual, imu.rate_sigma_rad_s},
                rate.time_s, page);
    writeSignal({fmt::format("imu{}_accelerometer", i + 1), "Accelerometer", "m/s\u00b2", force.measured,
                 force.predicted, imu.force_residual, imu.force_sigma_m_s2},
                force.time_s, page);
  }
  page.endSection();
}

}  // namespace evical::html
