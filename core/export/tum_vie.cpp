#include "core/base/error.h"
#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/stereo.h"

#include <fmt/format.h>

namespace evical {
namespace {

constexpr const char* kTumVieProgram = "TUM-VIE";
constexpr KnownModels kTumVieModels{kTumVieProgram, false, false,
                                    true};  // its tools use k1 to k4 of all cameras

// Frame cameras left and right, then event cameras: its tools use the number. A missing frame camera is
// replaced by the event camera of its side.
std::vector<RigCamera> inTheirOrder(const DataSetCameras& placed, ExportNotes& notes) {
  if (!placed.right_event)
    throw badInput("result", fmt::format("has one event camera, and {} requires two", kTumVieProgram),
                   "Use the target basalt, whose layout is the same");
  if (!placed.left_frame || !placed.right_frame)
    notes.push_back(fmt::format(
        "{} expects four cameras, frame cameras first: missing ones are replaced by the event camera of "
        "their side",
        kTumVieProgram));
  return {placed.left_frame.value_or(*placed.left_event), placed.right_frame.value_or(*placed.right_event),
          *placed.left_event, *placed.right_event};
}

}  // namespace

ExportedFiles exportTumVie(const NamedResult& result) {
  ExportedFiles exported;
  Rig rig = rigOf(result);
  neededImu(rig, kTumVieProgram);
  DataSetCameras placed = dataSetCameras(rig, kTumVieProgram, exported.notes);
  for (auto* const camera :
       {&placed.left_frame, &placed.right_frame, &placed.left_event, &placed.right_event})
    if (*camera) (*camera)->intrinsics = cameraFor(**camera, kTumVieModels, exported.notes);
  rig.cameras = inTheirOrder(placed, exported.notes);
  std::string names;
  for (const RigCamera& camera : rig.cameras)
    names += (names.empty() ? "" : ", ") + stringIn(Language::Json, camera.name);
  exported.files.push_back(
      {"camera-calibrationA.json", basaltCalibration(rig, kTumVieProgram, exported.notes,
                                                     fmt::format(",\n    \"camera_names\": [{}]", names))});
  std::vector<std::string> lines{
      "Cameras: 0 and 1 are frame cameras, left and right, 2 and 3 event cameras.",
      "mocap-imu-calibrationA.json is not written: Evical does not use markers of a motion capture system.",
      "calib_accel_bias and calib_gyro_bias are for raw samples. The samples in TUM-VIE's imu_data.txt are "
      "already "
      "corrected."};
  const std::vector<std::string> meanings = basaltMeanings(rig.imus.front());
  lines.insert(lines.end(), meanings.begin(), meanings.end());
  lines.insert(lines.end(), exported.notes.begin(), exported.notes.end());
  exported.files.push_back({"README.txt", readMe(rig, lines)});
  return exported;
}

}  // namespace evical
