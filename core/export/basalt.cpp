
#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/rig.h"
#include "core/geometry/camera_intrinsics.h"

#include <fmt/format.h>
#include <Eigen/LU>

#include <cmath>

namespace evical {
namespace {

constexpr const char* kBasaltProgram = "Basalt";
constexpr KnownModels kBasaltModels{kBasaltProgram, false, false, true, true, true, false};

std::string basaltPoseText(const RigidTransform& pose) {
  const Eigen::Vector3d& p = pose.translation_m;
  const Eigen::Quaterniond& q = pose.rotation;
  return fmt::format(R"({{"px": {}, "py": {}, "pz": {}, "qx": {}, "qy": {}, "qz": {}, "qw": {}}})",
                     real(p.x()), real(p.y()), real(p.z()), real(q.x()), real(q.y()), real(q.z()),
                     real(q.w()));
}

std::string basaltCameraText(const CameraIntrinsics& own) {
  const char* type = own.model == CameraModel::DoubleSphere ? "ds"
                     : own.model == CameraModel::Eucm       ? "eucm"
                                                            : "kb4";
  std::string coefficients;
  const auto names = distortionNames(own.model);
  for (std::size_t k = 0; k < static_cast<std::size_t>(coefficientCount(own.model)); ++k)
    coefficients += fmt::format(R"(, "{}": {})", names[k], real(own.distortion[k]));
  return fmt::format(R"({{"camera_type": "{}", "intrinsics": {{"fx": {}, "fy": {}, "cx": {}, "cy": {}{}}}}})",
                     type, real(own.focal_length_px.x()), real(own.focal_length_px.y()),
                     real(own.principal_point_px.x()), real(own.principal_point_px.y()), coefficients);
}

template <class Text>
std::string perCamera(const Rig& rig, Text&& text_of) {
  std::string text;
  for (const RigCamera& camera : rig.cameras)
    text += fmt::format("{}      {}", text.empty() ? "\n" : ",\n", text_of(camera));
  return fmt::format("[{}\n    ]", text);
}

// Basalt corrects raw samples, a = (I + S) a_raw - b; Evical models the measurement: I + S =
// M^-1, b = M^-1 bias.
std::string correctionText(const RigImu& imu, const LowerTriangularImu& lower) {
  const Eigen::Matrix3d accelerometer = lower.accelerometer.inverse();
  const Eigen::Matrix3d gyroscope = (lower.gyroscope * lower.gyroscope_rotation).inverse();
  const Eigen::Vector3d accelerometer_bias = accelerometer * imu.state.accelerometer_bias_m_s2;
  const Eigen::Vector3d gyroscope_bias = gyroscope * imu.state.gyroscope_bias_rad_s;
  const Eigen::Matrix3d a = accelerometer - Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d g = gyroscope - Eigen::Matrix3d::Identity();
  return fmt::format("    \"calib_accel_bias\": [{}, {}],\n    \"calib_gyro_bias\": [{}, {}],\n",
                     realList(accelerometer_bias),
                     realList(std::vector<double>{a(0, 0), a(1, 0), a(2, 0), a(1, 1), a(2, 1), a(2, 2)}),
                     realList(gyroscope_bias), rowMajor(g.transpose()));
}

std::string basaltNoiseText(const RigImu& imu, ExportNotes& notes) {
  const ImuNoise noise = statedNoise(imu, notes);
  const auto line = [](const char* key, double value) {
    return fmt::format("    \"{}\": [{}],\n", key, realList(std::vector<double>(3, value)));
  };
  return fmt::format("    \"imu_update_rate\": {},\n", real(statedRate_hz(imu, notes))) +
         line("accel_noise_std", noise.accelerometer_density) +
         line("gyro_noise_std", noise.gyroscope_density) +
         line("accel_bias_std", noise.accelerometer_random_walk) +
         line("gyro_bias_std", noise.gyroscope_random_walk);
}

}  // namespace

std::string basaltCalibration(const Rig& rig, const char* program, ExportNotes& notes,
                              const std::string& more) {
  const RigImu& imu = neededImu(rig, program);
  noteLostImus(rig, program, notes);
  noteLostOffsets(rig, program, notes);
  const LowerTriangularImu lower = lowerTriangular(imu.state);
  std::string text = "{\n  \"value0\": {\n    \"T_imu_cam\": ";
  text += perCamera(rig, [&](const RigCamera& camera) {
    return basaltPoseText(turnOf(lower.other_from_imu) * camera.reference_from_camera);
  });
  text += ",\n    \"intrinsics\": " +
          perCamera(rig, [](const RigCamera& camera) { return basaltCameraText(camera.intrinsics); });
  text += ",\n    \"resolution\": " + perCamera(rig, [](const RigCamera& camera) {
            return fmt::format("[{}, {}]", camera.intrinsics.resolution_px.width_px,
                               camera.intrinsics.resolution_px.height_px);
          });
  text += ",\n" + correctionText(imu, lower) + basaltNoiseText(imu, notes);
  return text + fmt::format("    \"cam_time_offset_ns\": {},\n    \"vignette\": []{}\n  }}\n}}\n",
                            std::llround(1e9 * rig.cameras[0].time_offset_s), more);
}

std::vector<std::string> basaltMeanings(const RigImu& imu) {
  std::vector<std::string> lines{
      "T_imu_cam transforms points of the camera to the IMU; t_imu = t_cam + cam_time_offset_ns.",
      "corrected force = (I + S) raw - b, with S and b of calib_accel_bias; the same for calib_gyro_bias."};
  if (hasMapping(imu.state))
    lines.emplace_back(
        "The IMU's frame is Basalt's, in which S of the accelerometer is lower triangular: it is rotated "
        "relative to Evical's.");
  return lines;
}

ExportedFiles exportBasalt(const NamedResult& result) {
  ExportedFiles exported;
  Rig rig = rigOf(result);
  neededImu(rig, kBasaltProgram);
  for (RigCamera& camera : rig.cameras) camera.intrinsics = cameraFor(camera, kBasaltModels, exported.notes);
  exported.files.push_back({"calibration.json", basaltCalibration(rig, kBasaltProgram, exported.notes)});
  std::vector<std::string> lines = basaltMeanings(rig.imus.front());
  lines.insert(lines.end(), exported.notes.begin(), exported.notes.end());
  exported.files.push_back({"README.txt", readMe(rig, lines)});
  return exported;
}

}  // namespace evical
