#include "core/export/export_target.h"

#include "core/base/error.h"
#include "core/base/files_together.h"
#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/export/exporters.h"
#include "core/export/rig.h"
#include "core/foreign/readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <system_error>

namespace evical {
namespace {

constexpr std::array kTargets{
    ExportTarget{"kalibr", "Kalibr", "camchain-imucam.yaml, camchain.yaml, imu.yaml",
                 "Read or converted by most", true, exportKalibr, readKalibr},
    ExportTarget{"openvins", "OpenVINS", "kalibr_imucam_chain.yaml, kalibr_imu_chain.yaml", "Several cameras",
                 true, exportOpenVins, readOpenVins},
    ExportTarget{"vins-fusion", "VINS-Fusion, ESVIO", "vins.yaml and a camera file each",
                 "1 or 2 cameras; ESVIO: events", true, exportVinsFusion, readVinsFusion},
    ExportTarget{"orb-slam3", "ORB-SLAM3", "the calibration part of a settings file", "SLAM with maps", true,
                 exportOrbSlam3, readOrbSlam3},
    ExportTarget{"basalt", "Basalt", "calibration.json", "Odometry and mapping", true, exportBasalt,
                 readBasalt},
    ExportTarget{"ros", "ROS", "camera_info, static transforms (tf2, launch), URDF",
                 "Robots: drivers, transforms", false, exportRos, readRos},
    ExportTarget{"svo", "SVO, EVO", "camera rig and IMU files", "Odometry; EVO: events", true, exportSvo,
                 readSvo},
    ExportTarget{"ultimate-slam", "Ultimate SLAM", "camera rig, imu.yaml, time shift flag",
                 "Events, frames and IMU", true, exportUltimateSlam, readUltimateSlam},
    ExportTarget{"esvo", "ESVO", "left.yaml, right.yaml", "Two event cameras; no IMU", false, exportEsvo,
                 readEsvo},
    ExportTarget{"esvo2", "ESVO2", "left.yaml, right.yaml with T_b_c", "Two event cameras", true, exportEsvo2,
                 readEsvo2},
    ExportTarget{"dv-processing", "DV, dv-processing", "calibration.json", "iniVation's programs and library",
                 false, exportDvProcessing, readDvProcessing},
    ExportTarget{"metavision", "Metavision up to SDK 4", "intrinsics.json",
                 "Prophesee's programs; lenses only", false, exportMetavision, readMetavision},
    ExportTarget{"ekalibr", "eKalibr", "parameters and camera intrinsics", "Another calibrator", false,
                 exportEkalibr, readEkalibr},
    ExportTarget{"kimera", "Kimera-VIO", "camera and IMU parameters", "Meshing; two cameras", true,
                 exportKimera, readKimera},
    ExportTarget{"dm-vio", "DM-VIO, DSO", "camera.txt, camchain.yaml, noise", "Only one camera", true,
                 exportDmVio, readDmVio},
    ExportTarget{"rtabmap", "RTAB-Map", "cameras, stereo pair, IMU's local transform",
                 "SLAM with two cameras", false, exportRtabmap, readRtabmap},
    ExportTarget{"opencv", "OpenCV", "cameras and stereo pair (FileStorage)",
                 "Your own programs in C++ or Python", false, exportOpenCv, readOpenCv},
    ExportTarget{"matlab", "MATLAB, Octave", "a function that creates all of it", "Your own programs", false,
                 exportMatlab, readMatlab},
    ExportTarget{"dsec", "DSEC", "cam_to_cam.yaml", "This data set; two cameras", false, exportDsec,
                 readDsec},
    ExportTarget{"m3ed", "M3ED", "calibration.h5", "This data set", false, exportM3ed, readM3ed},
    ExportTarget{"evimo2", "EVIMO, EVIMO2", "params.txt, calib.txt, extrinsics.txt of each camera",
                 "These data sets", false, exportEvimo2, readEvimo2},
    ExportTarget{"tum-vie", "TUM-VIE", "camera-calibrationA.json", "This data set", false, exportTumVie,
                 readTumVie},
    ExportTarget{"numpy", "NumPy", "calibration.npz", "Your own programs in Python", false, exportNumpy,
                 readNumpy},
};

void checkResult(const NamedResult& result) {
  if (result.result->status == CalibrationStatus::Failed)
    throw badInput("result", fmt::format("is of a failed calibration: {}", result.result->reason),
                   "Calibrate again; there is nothing to export");
  if (result.cameras.empty()) throw badInput("result", "has no camera", "Export a result with cameras");
}

}  // namespace

std::span<const ExportTarget> exportTargets() {
  return kTargets;
}

const ExportTarget& exportTarget(std::string_view name, std::string_view place) {
  for (const ExportTarget& target : kTargets)
    if (name == target.name) return target;
  std::vector<std::string> names;
  for (const ExportTarget& target : kTargets) names.emplace_back(target.name);
  throw badInput(std::string(place), fmt::format("nothing can be exported to '{}'", name),
                 nameAdvice(name, names));
}

namespace {

// A sensor's name may be that of another file of the target: one would replace the other.
void checkDistinct(const ExportedFiles& exported) {
  std::set<std::filesystem::path> paths;
  for (const FileContent& file : exported.files)
    if (!paths.insert(file.path).second)
      throw badInput("result",
                     fmt::format("has a sensor of the name that another file has: {}", file.path.string()),
                     "Rename the sensor in the session, and calibrate again");
}

struct Attempt {
  ExportedFiles files;
  std::optional<CalibrationError> last_refusal;
};

Attempt attempt(const NamedResult& result, std::span<const std::string> targets) {
  checkResult(result);
  Attempt all;
  std::set<std::string> done;
  for (const std::string& name : targets) {
    if (!done.insert(name).second) continue;
    const ExportTarget& target = exportTarget(name, howTo(HowTo::Option, {"to"}));
    ExportedFiles one;
    try {
      one = target.write(result);
      checkDistinct(one);
    } catch (const CalibrationError& refusal) {
      all.last_refusal = refusal;
      all.files.refused.push_back(fmt::format("{}: not exported: {}", target.name, refusal.what()));
      continue;
    }
    all.files.targets.emplace_back(target.name);
    for (FileContent& file : one.files)
      all.files.files.push_back({std::filesystem::path(target.name) / file.path, std::move(file.content)});
    for (const std::string& note : one.notes)
      all.files.notes.push_back(fmt::format("{}: {}", target.name, note));
  }
  for (std::string& remark : timingRemarks(result)) all.files.notes.push_back(std::move(remark));
  return all;
}

}  // namespace

ExportedFiles exportResult(const NamedResult& result, std::span<const std::string> targets) {
  Attempt all = attempt(result, targets);
  if (all.files.targets.empty() && all.last_refusal) throw CalibrationError(*all.last_refusal);
  return std::move(all.files);
}

ExportedFiles exportWhatCanBe(const NamedResult& result, std::span<const std::string> targets) {
  return attempt(result, targets).files;
}

void writeExportedFiles(const std::filesystem::path& folder, std::span<const FileContent> files) {
  FilesTogether together;
  for (const FileContent& file : files) together.writeInto(folder, file);
  together.place();
}

}  // namespace evical
