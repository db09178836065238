// Cameras whose intrinsics were calibrated first: parameters, accuracy of the projection, missing views.
#include "core/base/element.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/report/html/html_text.h"
#include "core/report/html/report_page.h"
#include "core/report/html/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical::html {
namespace {

std::vector<std::string> parameterNames(const CameraIntrinsics& camera) {
  std::vector<std::string> names = {"fx", "fy", "cx", "cy"};
  const std::array<const char*, 5> coefficients = distortionNames(camera.model);
  names.insert(names.end(), coefficients.begin(), coefficients.begin() + distortionCount(camera));
  return names;
}

// Parameters, with a column for the batch's values if it refined them.
std::string parameterTable(const ReportData& data, std::size_t index) {
  const IntrinsicsResult& found = *data.intrinsics[index];
  const auto& cameras = data.named.result->state.cameras;
  const auto solved_std = elementOrNone(data.named.result->uncertainty.cameras, index).intrinsics_std;
  const bool solved = index < cameras.size() && cameras[index].lens.solved && solved_std;
  std::array<double, kIntrinsicsCount> values{}, solved_values{};
  writeIntrinsics(found.intrinsics, values.data());
  if (solved) writeIntrinsics(*cameras[index].lens.solved, solved_values.data());
  const IntrinsicsVector sigmas = found.standardDeviations();
  std::vector<std::vector<std::string>> rows;
  for (const std::string& name : parameterNames(found.intrinsics)) {
    const std::size_t k = rows.size();
    std::vector<std::string>& row = rows.emplace_back();
    row = {name, withSigma(values[k], sigmas[static_cast<Eigen::Index>(k)])};
    if (solved) row.push_back(withSigma(solved_values[k], (*solved_std)[k]));
    row.emplace_back(k < 4 ? "px" : "");
  }
  return solved ? table({"", "calibrated first", "refined in the joint optimisation", "unit"}, rows)
                : table({"", "value", "unit"}, rows);
}

Eigen::MatrixXd correlationOf(const IntrinsicsResult& found) {
  const auto count = static_cast<Eigen::Index>(parameterNames(found.intrinsics).size());
  const Eigen::VectorXd scale =
      found.standardDeviations().head(count).unaryExpr([](double s) { return s > 0.0 ? 1.0 / s : 0.0; });
  Eigen::MatrixXd correlation =
      scale.asDiagonal() * found.covariance.topLeftCorner(count, count) * scale.asDiagonal();
  correlation.diagonal().setOnes();
  return correlation;
}

PlotTable cellTable(const ImageMap& image, Resolution size, std::size_t index) {
  PlotTable cells(fmt::format("plots/camera{}_intrinsics.csv", index + 1),
                  {"x_low_px", "x_high_px", "y_low_px", "y_high_px", "circles", "projection_std_px"});
  const double width = static_cast<double>(size.width_px) / image.columns;
  const double height = static_cast<double>(size.height_px) / image.rows;
  for (std::size_t k = 0; k < image.cells.size(); ++k) {
    const auto columns = static_cast<std::size_t>(image.columns);
    const auto column = static_cast<double>(k % columns), row = static_cast<double>(k / columns);
    cells.add({column * width, (column + 1.0) * width, row * height, (row + 1.0) * height,
               static_cast<double>(image.cells[k].circles), image.cells[k].sigma_px});
  }
  return cells;
}

// Cells with an opacity that grows with their value; values are written in units of 1 / `per_unit`.
std::string mapSvg(const PlotTable& cells, std::size_t column, Resolution size, const char* title,
                   const char* css_class, double per_unit) {
  SvgPlot map(imageFrame(size.width_px, size.height_px, title));
  double most = 1e-12;
  for (const double value : cells.values[column])
    if (std::isfinite(value)) most = std::max(most, value);
  const auto& v = cells.values;
  for (std::size_t i = 0; i < cells.rows(); ++i) {
    const double value = v[column][i];
    if (!std::isfinite(value)) continue;
    if (value > 0.0) map.bar(v[0][i], v[1][i], v[2][i], v[3][i], css_class, 0.08 + 0.7 * value / most);
    map.text(0.5 * (v[0][i] + v[1][i]), 0.5 * (v[2][i] + v[3][i]), fmt::format("{:.0f}", per_unit * value),
             "middle", 3.0);
  }
  return map.svg();
}

void writeMaps(const IntrinsicsResult& found, std::size_t index, ReportPage& page) {
  const Resolution size = found.intrinsics.resolution_px;
  if (found.image.cells.empty() || !size.known()) return;
  const PlotTable cells = cellTable(found.image, size, index);
  page.beginRow();
  page.figure(mapSvg(cells, 5, size, "standard deviation of projected rays [0.001 px]", "warm", 1e3),
              fmt::format("Standard deviation of projected points: {} px RMS over the image, at most {} px. "
                          "Record more views in the weak parts.",
                          significant(found.image.rms_px, 2), significant(found.image.max_px, 2)),
              &cells);
  page.figure(
      mapSvg(cells, 4, size, "points of the chosen views", "c2", 1.0),
      "Parts of the image in which the lens was measured; elsewhere the model interpolates or extrapolates.",
      &cells);
  page.endRow();
  page.keep(cells);
}

void writeCamera(const ReportData& data, std::size_t index, ReportPage& page) {
  const IntrinsicsResult& found = *data.intrinsics[index];
  page.heading("Camera " + cameraName(data, index));
  page.text(paragraph(
      "", fmt::format("{}, {} x {} px, from {} of {} views ({} points, {} rejected), tilted by up to {} "
                      "deg; reprojection {} px RMS.",
                      cameraModelTitle(found.intrinsics.model), found.intrinsics.resolution_px.width_px,
                      found.intrinsics.resolution_px.height_px, found.views_used, found.views_found,
                      found.circles_used, found.circles_rejected, number(found.largest_tilt_deg, 0),
                      significant(found.reprojection_rms_px))));
  if (!found.reason.empty())
    page.text(paragraph("", fmt::format("<b class=\"bad\">Doubtful</b>: {}.", escaped(found.reason))));
  for (const std::string& advice : found.advice) page.text(paragraph("", escaped(advice) + "."));
  page.text(parameterTable(data, index));
  writeMaps(found, index, page);
  page.figure(
      heatMapSvg("correlation of the intrinsics", parameterNames(found.intrinsics), correlationOf(found)),
      "Strong colours: parameters that the views hardly separate. Their combination may still be accurate.");
}

}  // namespace

void writeIntrinsicsSection(const ReportData& data, ReportPage& page) {
  const auto calibrated = [](const auto& found) { return found.has_value(); };
  if (std::none_of(data.intrinsics.begin(), data.intrinsics.end(), calibrated)) return;
  page.beginSection("intrinsics", "Intrinsics, calibrated first");
  for (std::size_t k = 0; k < data.intrinsics.size(); ++k)
    if (data.intrinsics[k]) writeCamera(data, k, page);
  page.endSection();
}

}  // namespace evical::html
