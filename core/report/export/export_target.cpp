#include "core/report/export/export_target.h"

#include "core/base/error.h"
#include "core/base/nearest_name.h"
#include "core/report/export/exporters.h"
#include "core/report/export/read_back/readers.h"
#include "core/report/export/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <system_error>

namespace evical {
namespace {

constexpr std::array kTargets{
    ExportTarget{"kalibr", "Kalibr: camchain-imucam.yaml, camchain.yaml, imu.yaml", exportKalibr, readKalibr},
    ExportTarget{"openvins", "OpenVINS: kalibr_imucam_chain.yaml, kalibr_imu_chain.yaml", exportOpenVins,
                 readOpenVins},
    ExportTarget{"vins-fusion", "VINS-Fusion, ESVIO: vins.yaml and a camera file each", exportVinsFusion,
                 readVinsFusion},
    ExportTarget{"orb-slam3", "ORB-SLAM3: the calibration part of a settings file", exportOrbSlam3,
                 readOrbSlam3},
    ExportTarget{"basalt", "Basalt: calibration.json", exportBasalt, readBasalt},
    ExportTarget{"ros", "ROS: camera_info, static transforms (tf2, launch), URDF", exportRos, readRos},
    ExportTarget{"svo", "SVO, EVO: camera rig and IMU files", exportSvo, readSvo},
    ExportTarget{"ultimate-slam", "Ultimate SLAM: camera rig, imu.yaml, time shift flag", exportUltimateSlam,
                 readUltimateSlam},
    ExportTarget{"esvo", "ESVO: left.yaml, right.yaml", exportEsvo, readEsvo},
    ExportTarget{"esvo2", "ESVO2: left.yaml, right.yaml with T_b_c", exportEsvo2, readEsvo2},
    ExportTarget{"dv-processing", "DV, dv-processing: calibration.json", exportDvProcessing,
                 readDvProcessing},
    ExportTarget{"metavision", "Metavision up to SDK 4: intrinsics.json", exportMetavision, readMetavision},
    ExportTarget{"ekalibr", "eKalibr: parameters and camera intrinsics", exportEkalibr, readEkalibr},
    ExportTarget{"kimera", "Kimera-VIO: camera and IMU parameters", exportKimera, readKimera},
    ExportTarget{"dm-vio", "DM-VIO, DSO: camera.txt, camchain.yaml, noise", exportDmVio, readDmVio},
    ExportTarget{"rtabmap", "RTAB-Map: cameras, stereo pair, IMU's local transform", exportRtabmap,
                 readRtabmap},
    ExportTarget{"opencv", "OpenCV: cameras and stereo pair (FileStorage)", exportOpenCv, readOpenCv},
    ExportTarget{"matlab", "MATLAB, Octave: a function that makes all of it", exportMatlab, readMatlab},
    ExportTarget{"dsec", "DSEC: cam_to_cam.yaml", exportDsec, readDsec},
    ExportTarget{"m3ed", "M3ED: calibration.h5", exportM3ed, readM3ed},
    ExportTarget{"evimo2", "EVIMO, EVIMO2: params.txt, calib.txt, extrinsics.txt of each camera",
                 exportEvimo2, readEvimo2},
    ExportTarget{"tum-vie", "TUM-VIE: camera-calibrationA.json", exportTumVie, readTumVie},
    ExportTarget{"numpy", "NumPy: calibration.npz", exportNumpy, readNumpy},
};

void checkResult(const NamedResult& result) {
  if (result.result->status == CalibrationStatus::Failed)
    throw badInput("result", fmt::format("is of a failed calibration: {}", result.result->reason),
                   "Calibrate again; there is nothing to export");
  if (result.cameras.empty()) throw badInput("result", "has no camera", "There is nothing to export");
}

}  // namespace

std::span<const ExportTarget> exportTargets() {
  return kTargets;
}

const ExportTarget& exportTarget(std::string_view name, const std::string& place) {
  for (const ExportTarget& target : kTargets)
    if (name == target.name) return target;
  std::vector<std::string> names;
  for (const ExportTarget& target : kTargets) names.emplace_back(target.name);
  throw badInput(place, fmt::format("nothing can be exported to '{}'", name), nameAdvice(name, names));
}

ExportedFiles exportResult(const NamedResult& result, std::span<const std::string> targets) {
  checkResult(result);
  ExportedFiles all;
  const std::size_t different = std::set<std::string>(targets.begin(), targets.end()).size();
  std::size_t refusals = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (std::find(targets.begin(), targets.begin() + static_cast<std::ptrdiff_t>(i), targets[i]) !=
        targets.begin() + static_cast<std::ptrdiff_t>(i))
      continue;
    const ExportTarget& target = exportTarget(targets[i], "--to");
    ExportedFiles one;
    try {
      one = target.write(result);
    } catch (const CalibrationError& refusal) {
      if (++refusals == different) throw;
      all.refused.push_back(fmt::format("{}: not exported: {}", target.name, refusal.what()));
      continue;
    }
    all.targets.emplace_back(target.name);
    for (FileContent& file : one.files)
      all.files.push_back({std::filesystem::path(target.name) / file.path, std::move(file.content)});
    for (const std::string& note : one.notes) all.notes.push_back(fmt::format("{}: {}", target.name, note));
  }
  for (std::string& remark : timingRemarks(result)) all.notes.push_back(std::move(remark));
  return all;
}

void writeExportedFiles(const std::filesystem::path& folder, std::span<const FileContent> files) {
  std::vector<FileContent> placed;
  std::vector<std::filesystem::path> made;
  for (const FileContent& file : files) placed.push_back({folder / file.path, file.content});
  std::error_code ignored;
  try {
    for (const FileContent& file : placed) {
      const std::filesystem::path parent = file.path.parent_path();
      for (auto missing = parent; !missing.empty() && !std::filesystem::exists(missing, ignored);
           missing = missing.parent_path())
        made.push_back(missing);
      makeOutputFolder(parent);
    }
    writeFilesWhole(placed);
  } catch (const CalibrationError&) {
    std::sort(made.begin(), made.end());
    for (auto path = made.rbegin(); path != made.rend(); ++path) std::filesystem::remove(*path, ignored);
    throw;
  }
}

}  // namespace evical
