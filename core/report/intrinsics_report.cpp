#include "core/report/intrinsics_report.h"

#include "core/base/yaml_node.h"
#include "core/format/intrinsics_yaml.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/report/result_table.h"
#include "core/report/result_yaml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace evical {
namespace {

std::array<double, 9> sigmasOf(const IntrinsicsResult& result) {
  std::array<double, 9> sigmas{};
  const IntrinsicsVector values = result.standardDeviations();
  std::copy(values.begin(), values.end(), sigmas.begin());
  return sigmas;
}

std::string list(const double* values, std::size_t count) {
  std::string text;
  for (std::size_t k = 0; k < count; ++k) text += fmt::format("{}{:.6g}", k == 0 ? "" : ", ", values[k]);
  return "[" + text + "]";
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : ".inf";
}

}  // namespace

std::string intrinsicsStdYaml(const CameraIntrinsics& camera, const std::array<double, 9>& sigmas,
                              int indent) {
  const std::string blanks(static_cast<std::size_t>(indent), ' ');
  const auto count = static_cast<std::size_t>(distortionCount(camera));
  return fmt::format("{0}focal_length_px: {1}\n{0}principal_point_px: {2}\n{0}distortion: {3}\n", blanks,
                     list(sigmas.data(), 2), list(sigmas.data() + 2, 2), list(sigmas.data() + 4, count));
}

std::string intrinsicsRows(const CameraIntrinsics& camera, const std::array<double, 9>& sigmas) {
  const std::array<const char*, 5> names = distortionNames(camera.model);
  std::string text = tableRow("focal length x", camera.focal_length_px.x(), sigmas[0], "px", 4) +
                     tableRow("focal length y", camera.focal_length_px.y(), sigmas[1], "px", 4) +
                     tableRow("principal point x", camera.principal_point_px.x(), sigmas[2], "px", 4) +
                     tableRow("principal point y", camera.principal_point_px.y(), sigmas[3], "px", 4);
  for (std::size_t k = 0; k < static_cast<std::size_t>(distortionCount(camera)); ++k)
    text += tableRow(names[k], camera.distortion[k], sigmas[4 + k], "", 6);
  return text;
}

namespace {

// Fixed parameters have zero correlation.
std::string correlationYaml(const IntrinsicsResult& result) {
  const IntrinsicsVector sigmas = result.standardDeviations();
  std::string text = "correlation:  # fx, fy, cx, cy, distortion\n";
  const int count = 4 + distortionCount(result.intrinsics);
  for (int row = 0; row < count; ++row) {
    text += "  - [";
    for (int column = 0; column < count; ++column) {
      const double both = sigmas[row] * sigmas[column];
      const double correlation = both > 0.0      ? result.covariance(row, column) / both
                                 : row == column ? 1.0
                                                 : 0.0;
      text += fmt::format("{}{:.4f}", column == 0 ? "" : ", ", correlation);
    }
    text += "]\n";
  }
  return text;
}

// One character for each cell, by its number of circles.
std::string coveragePicture(const ImageMap& image) {
  constexpr std::array kShades = {'.', '-', '+', '#'};  // none, up to 5, up to 20, more
  std::string text;
  for (int row = 0; row < image.rows; ++row) {
    text += "    ";
    for (int column = 0; column < image.columns; ++column) {
      const int circles = image.cells[static_cast<std::size_t>(row * image.columns + column)].circles;
      text += kShades.at(circles == 0 ? 0 : circles <= 5 ? 1 : circles <= 20 ? 2 : 3);
      text += ' ';
    }
    text += '\n';
  }
  return text;
}

}  // namespace

std::string intrinsicsResultYaml(const NamedIntrinsics& named) {
  const IntrinsicsResult& r = named.result;
  std::string text = fmt::format("evical_intrinsics: 1\nstatus: {}\nreason: {}\ncamera: {}\nintrinsics:\n",
                                 statusName(r.status), yamlLine(r.reason), yamlText(named.camera));
  text +=
      intrinsicsYaml(r.intrinsics, 2) + "intrinsics_std:\n" + intrinsicsStdYaml(r.intrinsics, sigmasOf(r), 2);
  text += correlationYaml(r);
  text += fmt::format("projection_std_px: {{rms: {}, max: {}}}\n", number(r.image.rms_px),
                      number(r.image.max_px));
  text += fmt::format("edge_localisation_bias_px: {:.6g}\nedge_localisation_bias_std_px: {:.6g}\n",
                      r.edge_localisation_bias_px, r.edge_localisation_bias_std_px);
  text += fmt::format("reprojection_rms_px: {:.6g}\nnormalised_rms: {:.6g}\n", r.reprojection_rms_px,
                      r.normalised_rms);
  text += fmt::format(
      "views: {{found: {}, used: {}}}\ncircles: {{used: {}, rejected: {}}}\nlargest_tilt_deg: {:.1f}\n",
      r.views_found, r.views_used, r.circles_used, r.circles_rejected, r.largest_tilt_deg);
  text += named.story.tried.empty() ? "" : "models_tried:  # errors: their median spread, in sigmas\n";
  for (const TriedModel& tried : named.story.tried)
    text += fmt::format("  - {{model: {}, errors: {:.4g}, circles: {{used: {}, of: {}}}}}\n",
                        cameraModelName(tried.model), tried.spread_sigma, tried.circles_used, tried.circles);
  text += fmt::format("passes: {}\nmoved_px: {:.6g}\n", r.passes, r.moved_px);
  for (const auto& [key, texts] : {std::pair("advice", &r.advice), std::pair("notes", &named.notes)}) {
    text += fmt::format("{}:{}\n", key, texts->empty() ? " []" : "");
    for (const std::string& each : *texts) text += fmt::format("  - {}\n", yamlLine(each));
  }
  return text + fmt::format("timing_s: {{total: {:.3f}}}\nprogram: {{version: {}}}\n", r.elapsed_s,
                            yamlLine(named.version));
}

std::string intrinsicsTable(const NamedIntrinsics& named) {
  const IntrinsicsResult& r = named.result;
  std::string text =
      fmt::format("Camera {}: {}, {} x {} px\n", named.camera, cameraModelName(r.intrinsics.model),
                  r.intrinsics.resolution_px.width_px, r.intrinsics.resolution_px.height_px);
  text += intrinsicsRows(r.intrinsics, sigmasOf(r));
  text += fmt::format("    {:<26}{:>12.4f} px RMS over the image, at most {:.4f}\n", "projection, +-",
                      r.image.rms_px, r.image.max_px);
  text += fmt::format("    {:<26}{:>12.4f} px RMS, {:.2f} times its sigmas\n", "reprojection",
                      r.reprojection_rms_px, r.normalised_rms);
  if (r.edge_localisation_bias_std_px > 0.0)
    text += fmt::format("    {:<26}{:>12.4f} +- {:.4f} px\n", "edge localisation bias",
                        r.edge_localisation_bias_px, r.edge_localisation_bias_std_px);
  text += fmt::format("    {:<26}{:>12} of {}, {} points, {} rejected; tilted by up to {:.0f} deg\n", "views",
                      r.views_used, r.views_found, r.circles_used, r.circles_rejected, r.largest_tilt_deg);
  if (named.story.tried.size() > 1)
    for (const TriedModel& tried : named.story.tried)
      text += fmt::format("    {:<26}{:>12.2f} times their sigmas, {} of {} points\n",
                          fmt::format("errors, {}", cameraModelName(tried.model)), tried.spread_sigma,
                          tried.circles_used, tried.circles);
  text += "Points by part of the image (. none, - few, + some, # many):\n" + coveragePicture(r.image);
  for (const std::string& advice : r.advice) text += fmt::format("Advice: {}\n", advice);
  text += fmt::format("Time: {:.1f} s in {} pass{}\nVerdict: {}", r.elapsed_s, r.passes,
                      r.passes == 1 ? "" : "es", statusName(r.status));
  text += r.reason.empty() ? "\n" : fmt::format(" - {}\n", r.reason);
  for (const std::string& note : named.notes) text += fmt::format("Note: {}\n", note);
  return text;
}

std::string imageMapCsv(const ImageMap& map) {
  std::string text = "column,row,x_px,y_px,circles,sigma_px\n";
  for (std::size_t k = 0; k < map.cells.size(); ++k) {
    const ImageCell& cell = map.cells[k];
    const auto columns = static_cast<std::size_t>(map.columns);
    text += fmt::format("{},{},{:.1f},{:.1f},{},{:.5f}\n", k % columns, k / columns, cell.middle_px.x(),
                        cell.middle_px.y(), cell.circles, cell.sigma_px);
  }
  return text;
}

}  // namespace evical
