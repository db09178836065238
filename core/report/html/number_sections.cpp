// Verdict, results with their sigmas, geometry of the sensors.
#include "core/base/element.h"
#include "core/base/plain_text.h"
#include "core/data/intrinsics_result.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/numerics/angles.h"
#include "core/report/html/html_text.h"
#include "core/report/html/report_page.h"
#include "core/report/html/svg_plot.h"
#include "core/report/result_table.h"
#include "core/report/shown_quantity.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

namespace evical::html {
namespace {

std::string tile(const std::string& label, const std::string& value, const std::string& detail) {
  return fmt::format("<div class=\"tile\"><span>{}</span><b>{}</b><small>{}</small></div>\n", label, value,
                     detail);
}

using Rows = std::vector<std::vector<std::string>>;

std::string htmlUnit(std::string unit) {
  if (const std::size_t square = unit.find("^2"); square != std::string::npos)
    unit.replace(square, 2, "\u00b2");
  return unit;
}

// Row of the three numbers of a quantity that `chosen` selects.
template <class Chosen>
std::vector<std::string> vectorRow(const std::string& name, const ShownQuantity& quantity,
                                   const std::string& unit, Chosen&& chosen) {
  std::vector<std::string> row = {name};
  for (const ShownNumber& number : quantity.numbers)
    if (chosen(number)) row.push_back(withSigma(number.value, number.sigma));
  row.push_back(unit);
  return row;
}

void addAngles(Rows& rows, const Eigen::Quaterniond& rotation) {
  const Eigen::Vector3d angles = rollPitchYaw_deg(rotation);
  const std::string warning = anglesWarning(angles);
  rows.push_back({"roll, pitch, yaw", number(angles.x(), 3), number(angles.y(), 3), number(angles.z(), 3),
                  warning.empty() ? "deg" : "deg (" + warning + ")"});
}

// One row of three numbers, two rows for a matrix. Angles are below the rotation to the reference.
void addVectors(Rows& rows, const ShownQuantity& quantity, const Eigen::Quaterniond& rotation) {
  const std::string title = quantity.info->title, unit = htmlUnit(unitAndRemark(quantity));
  if (quantity.info->shape == QuantityShape::UpperTriangle) {
    rows.push_back(vectorRow(title + " scale", quantity, unit, isScale));
    rows.push_back(vectorRow(title + " misalignment xy, xz, yz", quantity, "rad",
                             [](const ShownNumber& each) { return !isScale(each); }));
    return;
  }
  rows.push_back(vectorRow(title, quantity, unit, [](const ShownNumber&) { return true; }));
  if (quantity.info->shape == QuantityShape::Rotation) addAngles(rows, rotation);
}

std::vector<std::string> scalarRow(const ShownQuantity& quantity) {
  return {quantity.info->title, withSigma(quantity.numbers[0].value, quantity.numbers[0].sigma),
          htmlUnit(unitAndRemark(quantity))};
}

std::string largestSigma(const Eigen::Vector3d& sigma, const char* unit) {
  const double largest = sigma.maxCoeff();
  return largest > 0.0 ? fmt::format("\u00b1 {} {}", significant(largest, 2), unit) : "given";
}

void addGiven(const UncertaintyReport& uncertainty, const std::string& sensor, ReportPage& page) {
  const std::string given = givenOf(uncertainty, sensor);
  if (!given.empty())
    page.text(paragraph("small", "Given by the session, not estimated: " + escaped(given) + "."));
}

std::string cameraTiles(const ReportData& data, const Measures& measures, std::size_t i) {
  const CameraUncertainty sigma = elementOrNone(data.named.result->uncertainty.cameras, i);
  const CameraState& state = data.named.result->state.cameras[i];
  const std::string name = escaped(cameraName(data, i));
  std::string text;
  text += tile(name + ": rotation", largestSigma(kDegPerRad * sigma.rotation_std_rad, "deg"),
               fmt::format("largest sigma; required {}", plain(data.needs.rotation_deg)));
  text += tile(name + ": translation", largestSigma(1e3 * sigma.translation_std_m, "mm"),
               fmt::format("largest sigma; required {}", plain(data.needs.translation_mm)));
  text += tile(name + ": time offset",
               withSigma(1e3 * state.time_offset_s, 1e3 * sigma.time_offset_std_s) + " ms",
               fmt::format("required sigma {}", plain(data.needs.time_offset_ms)));
  const CameraFit fit = elementOrNone(data.named.result->cameras, i);
  text += tile(name + ": reprojection", significant(fit.reprojection_rms_px) + " px",
               fmt::format("RMS of {} points", fit.circles_used));
  if (i < measures.cameras.size())
    text += tile(name + ": board found", number(100.0 * measures.cameras[i].detectionRate(), 0) + " %",
                 fmt::format("of {} event windows or frames", measures.cameras[i].windows));
  return text;
}

void writeCameraNumbers(const ReportData& data, std::size_t i, ReportPage& page) {
  const CameraState& state = data.named.result->state.cameras[i];
  page.heading("Camera " + cameraName(data, i));
  page.text(paragraph(
      "", fmt::format("<code>p_reference = reference_from_camera \u00b7 p_camera</code>, reference: "
                      "{}; <code>t_reference = t_camera + time_offset</code>. \u00b1 is one "
                      "standard deviation.",
                      escaped(data.named.reference))));
  Rows vectors, scalars;
  for (const ShownQuantity& quantity : shownCamera(data.named, i)) {
    if (quantity.info->shape == QuantityShape::Intrinsics) continue;
    if (quantity.info->shape == QuantityShape::Scalar)
      scalars.push_back(scalarRow(quantity));
    else
      addVectors(vectors, quantity, state.reference_from_camera.rotation);
  }
  page.text(table({"", "x", "y", "z", "unit"}, vectors));
  page.text(table({"", "value", "unit"}, scalars));
  addGiven(data.named.result->uncertainty, cameraName(data, i), page);
  const std::optional<CameraIntrinsics>& intrinsics = state.lens.inUse();
  if (!intrinsics) return;
  const auto names = distortionNames(intrinsics->model);
  std::string distortion;
  for (std::size_t k = 0; k < static_cast<std::size_t>(distortionCount(*intrinsics)); ++k)
    distortion +=
        fmt::format("{}{} {}", k == 0 ? "" : ", ", names[k], significant(intrinsics->distortion[k], 4));
  page.text(paragraph(
      "small",
      fmt::format("Intrinsics {}: {}, {} x {} px, focal length {}, {} px, principal point {}, {} px, "
                  "distortion {}.",
                  state.lens.solved         ? "refined in the joint optimisation"
                  : state.lens.foundFirst() ? "calibrated first"
                                            : "given",
                  cameraModelTitle(intrinsics->model), intrinsics->resolution_px.width_px,
                  intrinsics->resolution_px.height_px, number(intrinsics->focal_length_px.x(), 3),
                  number(intrinsics->focal_length_px.y(), 3), number(intrinsics->principal_point_px.x(), 3),
                  number(intrinsics->principal_point_px.y(), 3), distortion)));
}

void writeImuNumbers(const ReportData& data, std::size_t i, ReportPage& page) {
  const ImuState& state = data.named.result->state.imus[i];
  const bool reference = imuName(data, i) == data.named.reference;
  page.heading("IMU " + imuName(data, i) + (reference ? " (reference)" : ""));
  Rows rows;
  for (const ShownQuantity& quantity : shownImu(data.named, i, !reference)) {
    if (quantity.info->shape != QuantityShape::Scalar) {
      addVectors(rows, quantity, state.reference_from_imu.rotation);
      continue;
    }
    std::vector<std::string> row = scalarRow(quantity);
    row.insert(row.end() - 1, 2, "");
    rows.push_back(row);
  }
  page.text(table({"", "x", "y", "z", "unit"}, rows));
  addGiven(data.named.result->uncertainty, imuName(data, i), page);
}

struct PlacedSensor {
  std::string name;
  RigidTransform reference_from_sensor;
  bool camera = false;
};

// View along the third axis of the reference; `across` and `up` are the axes of the picture.
std::string sensorView(const std::vector<PlacedSensor>& sensors, int across, int up, double extent_mm) {
  PlotFrame frame;
  frame.title = fmt::format("sensors in the plane of {} and {}", kAxes.at(static_cast<std::size_t>(across)),
                            kAxes.at(static_cast<std::size_t>(up)));
  frame.x_label = fmt::format("{} of the reference [mm]", kAxes.at(static_cast<std::size_t>(across)));
  frame.y_label = fmt::format("{} [mm]", kAxes.at(static_cast<std::size_t>(up)));
  frame.width = 300.0;
  frame.height = 280.0;
  frame.equal_scale = true;
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();
  for (const PlacedSensor& sensor : sensors) {
    const Eigen::Vector3d t_mm = 1e3 * sensor.reference_from_sensor.translation_m;
    low = low.cwiseMin(Eigen::Vector2d(t_mm[across], t_mm[up]));
    high = high.cwiseMax(Eigen::Vector2d(t_mm[across], t_mm[up]));
  }
  constexpr double kEndOn = 0.3;  // projected axes shorter than this point towards the reader, or away
  const double arm_mm = 0.45 * extent_mm, margin_mm = 1.25 * arm_mm;
  frame.x = {low.x() - margin_mm, high.x() + margin_mm};
  frame.y = {low.y() - margin_mm, high.y() + margin_mm};
  SvgPlot plot(frame);
  plot.legend({{"c0", "x"}, {"c1", "y"}, {"c2", "z axis"}});
  for (const PlacedSensor& sensor : sensors) {
    const Eigen::Vector3d t_mm = 1e3 * sensor.reference_from_sensor.translation_m;
    if (t_mm.norm() > 0.0) plot.segment(0.0, 0.0, t_mm[across], t_mm[up], "dashed");
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d tip_mm =
          t_mm + arm_mm * (sensor.reference_from_sensor.rotation * Eigen::Vector3d::Unit(axis));
      plot.arrow(t_mm[across], t_mm[up], tip_mm[across], tip_mm[up], fmt::format("c{} thick", axis));
      const double seen_mm = std::hypot(tip_mm[across] - t_mm[across], tip_mm[up] - t_mm[up]);
      if (seen_mm < kEndOn * arm_mm)
        plot.circle(t_mm[across], t_mm[up], 0.14 * arm_mm, fmt::format("c{} thick", axis));
    }
    const std::vector<double> x = {t_mm[across]}, y = {t_mm[up]};
    plot.points(x, y, sensor.camera ? "ink" : "muted", 9.0);
    plot.text(t_mm[across], t_mm[up], sensor.name, "middle", sensor.camera ? -16.0 : 22.0);
  }
  return plot.svg();
}

// Suggested setting, as the command line prints it; the window has a button for it.
std::string repairText(const std::optional<Repair>& repair) {
  if (!repair) return {};
  return paragraph("repair", "Possible fix: calibrate again with " +
                                 element("code", "", escaped("--set " + shellWord(repair->text()))) +
                                 ", or with the button next to the verdict in the desktop program.");
}

}  // namespace

void writeVerdict(const ReportData& data, const Measures& measures, ReportPage& page) {
  const CalibrationResult& result = *data.named.result;
  const char* const status = statusName(result.status);
  const char* const meaning =
      result.status == CalibrationStatus::Ok ? "The calibration meets the required sigmas."
      : result.status == CalibrationStatus::Doubtful
          ? "The calibration has a result, but do not rely on it before you have read the reason."
          : "The calibration has no result.";
  page.text(fmt::format("<div class=\"verdict {0}\"><b>{0}</b><div><p>{1}</p>{2}{3}</div></div>\n", status,
                        meaning, result.reason.empty() ? "" : paragraph("reason", escaped(result.reason)),
                        repairText(result.repair)));
  std::string tiles;
  for (std::size_t i = 0; i < result.state.cameras.size(); ++i) tiles += cameraTiles(data, measures, i);
  if (result.state.cameras.empty())
    for (std::size_t i = 0; i < measures.cameras.size(); ++i)
      tiles += tile(escaped(cameraName(data, i)) + ": board found",
                    number(100.0 * measures.cameras[i].detectionRate(), 0) + " %",
                    fmt::format("of {} event windows or frames", measures.cameras[i].windows));
  if (measures.duration_s > 0.0)
    tiles += tile("recording", number(measures.duration_s, 1) + " s", escaped(data.recording));
  if (!tiles.empty()) page.text("<div class=\"tiles\">\n" + tiles + "</div>\n");
}

void writeBoardNumbers(const ReportData& data, ReportPage& page) {
  for (std::size_t i = 0; i < data.named.boards.size(); ++i) {
    Rows vectors, scalars;
    for (const ShownQuantity& quantity : shownBoard(data.named, i)) {
      if (quantity.info->shape == QuantityShape::Scalar)
        scalars.push_back(scalarRow(quantity));
      else
        addVectors(vectors, quantity, data.named.result->state.boardAt(i).world_from_board.rotation);
    }
    if (vectors.empty() && scalars.empty()) continue;
    page.heading(escaped(boardTitle(data.named, i)));
    if (!vectors.empty()) page.text(table({"", "x", "y", "z", "unit"}, vectors));
    if (!scalars.empty()) page.text(table({"", "value", "unit"}, scalars));
  }
}

void writeNumbers(const ReportData& data, ReportPage& page) {
  const CalibrationResult& result = *data.named.result;
  if (result.state.cameras.empty() && result.state.imus.empty()) return;
  page.beginSection("results", "Results");
  for (std::size_t i = 0; i < result.state.cameras.size(); ++i) writeCameraNumbers(data, i, page);
  for (std::size_t i = 0; i < result.state.imus.size(); ++i) writeImuNumbers(data, i, page);
  writeBoardNumbers(data, page);
  const Eigen::Vector3d& g = result.state.gravity_in_world_m_s2;
  const double norm_std_m_s2 = result.uncertainty.gravity_norm_std_m_s2;
  page.text(paragraph(
      "",
      fmt::format("Gravity in the board's frame: {}, {}, {} m/s\u00b2 (direction \u00b1 {} deg{}).",
                  number(g.x(), 4), number(g.y(), 4), number(g.z(), 4),
                  significant(kDegPerRad * result.uncertainty.gravity_direction_std_rad, 2),
                  norm_std_m_s2 > 0.0 ? fmt::format(", norm {} m/s\u00b2", withSigma(g.norm(), norm_std_m_s2))
                                      : "")));
  page.endSection();
}

void writeSensors(const ReportData& data, ReportPage& page) {
  const CalibrationState& state = data.named.result->state;
  std::vector<PlacedSensor> sensors;
  double extent_mm = 0.0;
  for (std::size_t i = 0; i < state.imus.size(); ++i)
    sensors.push_back({imuName(data, i), state.imus[i].reference_from_imu, false});
  for (std::size_t i = 0; i < state.cameras.size(); ++i)
    sensors.push_back({cameraName(data, i), state.cameras[i].reference_from_camera, true});
  for (const PlacedSensor& sensor : sensors)
    extent_mm = std::max(extent_mm, 1e3 * sensor.reference_from_sensor.translation_m.norm());
  if (state.cameras.empty()) return;
  extent_mm = std::max(extent_mm, 5.0);
  page.beginSection("sensors", "Geometry of the sensors");
  page.beginRow();
  page.figure(sensorView(sensors, 0, 1, extent_mm), "Seen along the reference's z axis.");
  page.figure(sensorView(sensors, 0, 2, extent_mm), "Seen along its y axis.");
  page.figure(sensorView(sensors, 1, 2, extent_mm), "Seen along its x axis.");
  page.endRow();
  page.text(paragraph("note",
                      "Each sensor with its axes (a ring: the axis points towards you or away). Cameras look "
                      "along their z axis (x right, y down in the image). Compare with the device: a camera "
                      "that looks the wrong way indicates swapped axes or streams; a dashed arm much longer "
                      "than the device indicates a wrong board size."));
  page.endSection();
}

}  // namespace evical::html
