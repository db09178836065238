#include "core/base/error.h"
#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/geometry/projection_difference.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
namespace {

constexpr const char* kOrbSlam3Program = "ORB-SLAM3";
constexpr std::size_t kOrbSlam3MaxCameras = 2;

// Keys that are not part of a calibration, but without which the program does not start (Settings.cc); reals
// need a point.
constexpr const char* kOrbSlam3OwnKeys =
    "Camera.fps: 20\nCamera.RGB: 1\n"
    "ORBextractor.nFeatures: 1000\nORBextractor.scaleFactor: 1.2\nORBextractor.nLevels: 8\n"
    "ORBextractor.iniThFAST: 20\nORBextractor.minThFAST: 7\n"
    "Viewer.KeyFrameSize: 0.05\nViewer.KeyFrameLineWidth: 1.0\nViewer.GraphLineWidth: 0.9\nViewer.PointSize: "
    "2.0\n"
    "Viewer.CameraSize: 0.08\nViewer.CameraLineWidth: 3.0\nViewer.ViewpointX: 0.0\nViewer.ViewpointY: -0.7\n"
    "Viewer.ViewpointZ: -3.5\nViewer.ViewpointF: 500.0\nViewer.imageViewScale: 1.0\n";

std::string orbSlam3CameraText(const CameraIntrinsics& camera, std::size_t number, bool stereo) {
  const std::string prefix = fmt::format("Camera{}.", number);
  const auto line = [&](const char* key, double value) {
    return fmt::format("{}{}: {}\n", prefix, key, real(value));
  };
  const auto& d = camera.distortion;
  std::string text = line("fx", camera.focal_length_px.x()) + line("fy", camera.focal_length_px.y()) +
                     line("cx", camera.principal_point_px.x()) + line("cy", camera.principal_point_px.y());
  if (camera.model == CameraModel::PinholeRadtan) {
    text += line("k1", d[0]) + line("k2", d[1]) + line("p1", d[2]) + line("p2", d[3]);
    return d[4] == 0.0 ? text : text + line("k3", d[4]);
  }
  text += line("k1", d[0]) + line("k2", d[1]) + line("k3", d[2]) + line("k4", d[3]);
  if (stereo)
    text += fmt::format("{0}overlappingBegin: 0\n{0}overlappingEnd: {1}\n", prefix,
                        camera.resolution_px.width_px - 1);
  return text;
}

// Both cameras of one kind: the settings have one Camera.type.
std::vector<CameraIntrinsics> camerasOf(const Rig& rig, ExportNotes& notes) {
  std::vector<CameraIntrinsics> cameras;
  for (std::size_t i = 0; i < std::min(rig.cameras.size(), kOrbSlam3MaxCameras); ++i) {
    const bool radtan = rig.cameras[0].intrinsics.model == CameraModel::PinholeRadtan;
    cameras.push_back(cameraFor(rig.cameras[i], {kOrbSlam3Program, radtan, true, !radtan}, notes));
    if (cameras[i].resolution_px != cameras[0].resolution_px)
      throw badInput(fmt::format("result: cameras.{}", rig.cameras[i].name),
                     "has a different resolution from the first camera; ORB-SLAM3 has one for both",
                     "Omit the target orb-slam3");
  }
  return cameras;
}

std::string orbSlam3ImuText(const Rig& rig, const RigImu& imu, ExportNotes& notes) {
  const ImuNoise noise = statedNoise(imu, notes);
  return opencvMatrix("IMU.T_b_c1", matrixOf(rig.cameras[0].reference_from_camera), 'f') +
         fmt::format(
             "IMU.InsertKFsWhenLost: 0\nIMU.NoiseGyro: {}\nIMU.NoiseAcc: {}\nIMU.GyroWalk: {}\nIMU.AccWalk: "
             "{}\n"
             "IMU.Frequency: {}\n",
             real(noise.gyroscope_density), real(noise.accelerometer_density),
             real(noise.gyroscope_random_walk), real(noise.accelerometer_random_walk),
             real(statedRate_hz(imu, notes)));
}

// Its Settings.h returns camera 1's distortion for camera 2, although its Settings.cc reads that of camera 2.
std::string secondLensNote(const std::vector<CameraIntrinsics>& cameras) {
  CameraIntrinsics as_read = cameras[1];
  as_read.distortion = cameras[0].distortion;
  const ProjectionDifference wrong = projectionDifference(cameras[1], as_read);
  return fmt::format(
      "ORB-SLAM3 uses camera 1's distortion for camera 2, an error of {:.2f} px RMS, {:.2f} px at most; "
      "rectify the images first if that is too large",
      wrong.rms_px, wrong.max_px);
}

}  // namespace

ExportedFiles exportOrbSlam3(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  noteLostCameras(rig, kOrbSlam3MaxCameras, kOrbSlam3Program, exported.notes);
  const std::vector<CameraIntrinsics> cameras = camerasOf(rig, exported.notes);
  const bool stereo = cameras.size() > 1;
  std::string text =
      "%YAML:1.0\n---\n" +
      headerComment(
          rig, {"ORB-SLAM3 settings. Camera.fps, Camera.RGB, ORBextractor and Viewer are not part of the "
                "calibration: adjust them.",
                "IMU.T_b_c1 transforms points of camera 1 to the IMU, Stereo.T_c1_c2 points of "
                "camera 2 to camera 1.",
                stampShifts(rig)}) +
      fmt::format("File.version: \"1.0\"\nCamera.type: \"{}\"\n",
                  cameras[0].model == CameraModel::PinholeRadtan ? "PinHole" : "KannalaBrandt8");
  for (std::size_t i = 0; i < cameras.size(); ++i) text += orbSlam3CameraText(cameras[i], i + 1, stereo);
  text += fmt::format("Camera.width: {}\nCamera.height: {}\n", cameras[0].resolution_px.width_px,
                      cameras[0].resolution_px.height_px);
  if (stereo)
    text += "Stereo.ThDepth: 40.0\n" + opencvMatrix("Stereo.T_c1_c2",
                                                    matrixOf(inverse(rig.cameras[0].reference_from_camera) *
                                                             rig.cameras[1].reference_from_camera),
                                                    'f');
  if (!rig.imus.empty()) {
    noteLostImus(rig, kOrbSlam3Program, exported.notes);
    noteLostMapping(rig.imus[0], kOrbSlam3Program, exported.notes);
    text += orbSlam3ImuText(rig, rig.imus[0], exported.notes);
  }
  text += kOrbSlam3OwnKeys;
  if (stereo) exported.notes.push_back(secondLensNote(cameras));
  if (!rig.imus.empty() || stereo) exported.notes.push_back(stampShifts(rig));
  exported.files.push_back({"settings.yaml", text});
  return exported;
}

}  // namespace evical
