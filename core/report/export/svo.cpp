#include "core/base/yaml_node.h"
#include "core/report/export/distortion_fit.h"
#include "core/report/export/export_text.h"
#include "core/report/export/exporters.h"
#include "core/report/export/kalibr_text.h"

#include <fmt/format.h>

namespace evical {
namespace {

std::string cameraText(const RigCamera& camera, std::size_t number, const CameraIntrinsics& own) {
  const Eigen::Vector4d intrinsics(own.focal_length_px.x(), own.focal_length_px.y(),
                                   own.principal_point_px.x(), own.principal_point_px.y());
  const std::vector<double> d = distortionOf(own, 4);
  return fmt::format(
      "- camera:\n    label: {}\n    id: {}\n    line-delay-nanoseconds: 0\n    image_height: {}\n"
      "    image_width: {}\n    type: pinhole\n    intrinsics:\n{}    distortion:\n      type: {}\n"
      "      parameters:\n{}  T_B_C:\n{}",
      yamlText(camera.file_name), number, own.resolution_px.height_px, own.resolution_px.width_px,
      dataMatrix(intrinsics, 6),
      own.model == CameraModel::PinholeRadtan ? "radial-tangential" : "equidistant",
      dataMatrix(Eigen::Map<const Eigen::VectorXd>(d.data(), 4), 8),
      dataMatrix(matrixOf(camera.reference_from_camera), 4));
}

std::string rigFile(const Rig& rig, const char* program, const std::string& time, ExportNotes& notes) {
  const KnownModels models{program, true, false, true};
  std::string text =
      headerComment(
          rig,
          {fmt::format("Camera rig of {}. T_B_C takes points of the camera to the IMU.", program), time}) +
      "label: \"rig\"\ncameras:\n";
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    text += cameraText(rig.cameras[i], i, cameraFor(rig.cameras[i], models, notes));
  return text;
}

std::string svoImu(const Rig& rig, const RigImu& imu, ExportNotes& notes) {
  const StatedNoise noise = statedNoise(imu, notes);
  const std::string g = real(rig.gravity_m_s2.norm());
  return headerComment(
             rig, {"IMU of SVO. t_imu = t_cam - delay_imu_cam: the sign is the opposite of Kalibr's.",
                   "acc_max and omega_max are the sensor's limits: check them against its data sheet."}) +
         fmt::format(
             "imu_params:\n  delay_imu_cam: {}\n  max_imu_delta_t: 0.01\n  acc_max: 176.0\n  omega_max: 7.8\n"
             "  sigma_omega_c: {}\n  sigma_acc_c: {}\n  sigma_omega_bias_c: {}\n  sigma_acc_bias_c: {}\n"
             "  g: {}\n  imu_rate: {}\n"
             "imu_initialization:\n  velocity: [0.0, 0.0, 0.0]\n  omega_bias: [{}]\n  acc_bias: [{}]\n"
             "  velocity_sigma: 1.0\n  omega_bias_sigma: 0.01\n  acc_bias_sigma: 0.1\n",
             real(-rig.cameras[0].time_offset_s), real(noise.gyroscope_density),
             real(noise.accelerometer_density), real(noise.gyroscope_random_walk),
             real(noise.accelerometer_random_walk), g, real(statedRate_hz(imu, notes)),
             realList(imu.state.gyroscope_bias_rad_s), realList(imu.state.accelerometer_bias_m_s2));
}

const RigImu& checkedImu(const Rig& rig, const char* program, ExportNotes& notes) {
  const RigImu& imu = neededImu(rig, program);
  noteLostImus(rig, program, notes);
  noteLostOffsets(rig, program, notes);
  noteLostMapping(imu, program, notes);
  return imu;
}

}  // namespace

ExportedFiles exportSvo(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const RigImu& imu = checkedImu(rig, "SVO", exported.notes);
  exported.files.push_back(
      {"calib.yaml", rigFile(rig, "SVO", "The time offset is in imu.yaml.", exported.notes)});
  exported.files.push_back({"imu.yaml", svoImu(rig, imu, exported.notes)});
  return exported;
}

ExportedFiles exportUltimateSlam(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const RigImu& imu = checkedImu(rig, "Ultimate SLAM", exported.notes);
  exported.files.push_back({"calib.yaml", rigFile(rig, "Ultimate SLAM",
                                                  "The time offset is in timeshift.flags.", exported.notes)});
  exported.files.push_back({"imu.yaml", headerComment(rig, {"IMU of Ultimate SLAM, in Kalibr's units."}) +
                                            kalibrNoise(imu, 0, exported.notes)});
  exported.files.push_back(
      {"timeshift.flags", headerComment(rig, {"For --flagfile: t_imu = t_cam + timeshift_cam_imu."}) +
                              fmt::format("--timeshift_cam_imu={}\n", real(rig.cameras[0].time_offset_s))});
  return exported;
}

}  // namespace evical
