#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/stereo.h"
#include "core/format/hdf5_content.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
namespace {

constexpr const char* kM3edProgram = "M3ED";
constexpr KnownModels kM3edModels{kM3edProgram, true, false,
                                  false};  // its tools interpret the coefficients as OpenCV's

std::vector<double> rowsOf(const Eigen::Matrix4d& matrix) {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = matrix;
  return {rows.data(), rows.data() + rows.size()};
}

Hdf5Dataset placeM3edOf(const std::string& group, const RigidTransform& left_from_this) {
  return {group + "/calib/T_to_prophesee_left", {4, 4}, rowsOf(matrixOf(left_from_this))};
}

void addM3edCamera(const std::string& group, const RigCamera& camera, const RigCamera& left,
                   std::vector<Hdf5Dataset>& datasets, ExportNotes& notes) {
  const CameraIntrinsics own = cameraFor(camera, kM3edModels, notes);
  const std::string calib = group + "/calib/";
  datasets.push_back({calib + "camera_name", {}, camera.name});
  datasets.push_back({calib + "camera_model", {}, std::string("pinhole")});
  datasets.push_back({calib + "distortion_coeffs", {4}, distortionOf(own, 4)});
  datasets.push_back({calib + "distortion_model", {}, std::string("radtan")});
  datasets.push_back({calib + "intrinsics",
                      {4},
                      std::vector<double>{own.focal_length_px.x(), own.focal_length_px.y(),
                                          own.principal_point_px.x(), own.principal_point_px.y()}});
  datasets.push_back({calib + "resolution",
                      {2},
                      std::vector<std::int64_t>{own.resolution_px.width_px, own.resolution_px.height_px}});
  datasets.push_back(placeM3edOf(
      group, &camera == &left ? RigidTransform{}
                              : inverse(left.reference_from_camera) * camera.reference_from_camera));
}

void noteOffsets(const Rig& rig, ExportNotes& notes) {
  std::string text = fmt::format("{} has one clock for all sensors: add to the stamps of", kM3edProgram);
  for (const RigCamera& camera : rig.cameras)
    text += fmt::format("{} {} {} s", &camera == &rig.cameras.front() ? "" : ",", camera.name,
                        real(camera.time_offset_s));
  notes.push_back(text);
}

}  // namespace

ExportedFiles exportM3ed(const NamedResult& result) {
  ExportedFiles exported;
  ExportNotes& notes = exported.notes;
  const Rig rig = rigOf(result);
  const DataSetCameras placed = dataSetCameras(rig, kM3edProgram, notes);
  const RigCamera& left = *placed.left_event;
  std::vector<Hdf5Dataset> datasets;
  const auto add = [&](const char* group, const std::optional<RigCamera>& camera) {
    if (camera) addM3edCamera(group, *camera, left, datasets, notes);
  };
  add("/prophesee/left", placed.left_event);
  add("/prophesee/right", placed.right_event);
  add("/ovc/left", placed.left_frame);
  add("/ovc/right", placed.right_frame);
  if (!rig.imus.empty()) {
    datasets.push_back(placeM3edOf("/ovc/imu", inverse(left.reference_from_camera)));
    noteLostImus(rig, kM3edProgram, notes);
    noteLostMapping(rig.imus.front(), kM3edProgram, notes);
  }
  noteOffsets(rig, notes);
  std::vector<std::string> lines{
      "The calibration's groups of an M3ED file; T_to_prophesee_left transforms points of the sensor to "
      "the left event camera.",
      "To copy into a file of events: for each group, h5copy -p -i calibration.h5 -s GROUP/calib -o FILE -d "
      "GROUP/calib."};
  lines.insert(lines.end(), notes.begin(), notes.end());
  const std::string text = readMe(rig, lines);
  const auto fill = [&](const Hdf5Sink& sink) { std::for_each(datasets.begin(), datasets.end(), sink); };
  exported.files.push_back(
      {"calibration.h5", wholeText([&](const TextSink& sink) { writeHdf5(fill, text, sink); })});
  exported.files.push_back({"README.txt", text});
  return exported;
}

}  // namespace evical
