#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

std::string svoCameraText(const RigCamera& camera, const std::string& label, std::size_t number,
                          const CameraIntrinsics& own) {
  const Eigen::Vector4d intrinsics(own.focal_length_px.x(), own.focal_length_px.y(),
                                   own.principal_point_px.x(), own.principal_point_px.y());
  const std::vector<double> d = distortionOf(own, 4);
  return fmt::format(
      "- camera:\n    label: {}\n    id: {}\n    line-delay-nanoseconds: {}\n    image_height: {}\n"
      "    image_width: {}\n    type: pinhole\n    intrinsics:\n{}    distortion:\n      type: {}\n"
      "      parameters:\n{}  T_B_C:\n{}",
      stringIn(Language::Yaml, label), number, std::lround(1e3 * camera.line_delay_us),
      own.resolution_px.height_px, own.resolution_px.width_px, dataMatrix(intrinsics, 6),
      own.model == CameraModel::PinholeRadtan ? "radial-tangential" : "equidistant",
      dataMatrix(Eigen::Map<const Eigen::VectorXd>(d.data(), 4), 8),
      dataMatrix(matrixOf(camera.reference_from_camera), 4));
}

// `dvs`: the camera with this label in the program; nullptr: none.
std::string rigText(const Rig& rig, const char* program, const RigCamera* dvs, ExportNotes& notes) {
  const KnownModels models{program, true, false, true};
  std::string text = "label: \"rig\"\ncameras:\n";
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const RigCamera& camera = rig.cameras[i];
    text +=
        svoCameraText(camera, &camera == dvs ? "dvs" : camera.file_name, i, cameraFor(camera, models, notes));
  }
  return text;
}

// The first camera of this kind; nullptr if there is none.
const RigCamera* firstOf(const Rig& rig, CameraKind kind) {
  const auto found = std::find_if(rig.cameras.begin(), rig.cameras.end(),
                                  [kind](const RigCamera& camera) { return camera.kind == kind; });
  return found == rig.cameras.end() ? nullptr : &*found;
}

// The program adds its single time shift to images, and uses the events' stamps unchanged
// (camera_imu_synchronizer_base.cpp, addImageData and addEventsData).
void noteUltimateSlamTimes(const RigCamera& dvs, const RigCamera* images, ExportNotes& notes) {
  if (dvs.time_offset_s != 0.0)
    notes.push_back(fmt::format(
        "Ultimate SLAM does not shift events: add {} s to the time stamps of {} before you run it",
        real(dvs.time_offset_s), dvs.name));
  if (images)
    notes.push_back(
        fmt::format("timeshift_cam_imu applies to the images of {}, the only ones that the program shifts",
                    images->name));
}

std::string svoImu(const Rig& rig, const RigImu& imu, ExportNotes& notes) {
  const ImuNoise noise = statedNoise(imu, notes);
  const std::string g = real(rig.gravity_m_s2.norm());
  return fmt::format(
      "imu_params:\n  delay_imu_cam: {}\n  max_imu_delta_t: 0.01\n  acc_max: 176.0\n  omega_max: 7.8\n"
      "  sigma_omega_c: {}\n  sigma_acc_c: {}\n  sigma_omega_bias_c: {}\n  sigma_acc_bias_c: {}\n"
      "  g: {}\n  imu_rate: {}\n"
      "imu_initialization:\n  velocity: [0.0, 0.0, 0.0]\n  omega_bias: [{}]\n  acc_bias: [{}]\n"
      "  velocity_sigma: 1.0\n  omega_bias_sigma: 0.01\n  acc_bias_sigma: 0.1\n",
      real(-rig.cameras[0].time_offset_s), real(noise.gyroscope_density), real(noise.accelerometer_density),
      real(noise.gyroscope_random_walk), real(noise.accelerometer_random_walk), g,
      real(statedRate_hz(imu, notes)), realList(imu.state.gyroscope_bias_rad_s),
      realList(imu.state.accelerometer_bias_m_s2));
}

// The program reads all but the cameras from flags. Its *_bias_random_walk are not random walks but initial
// bias uncertainties, and keep their defaults; sigma_*_drift are random walks
// (vio_ceres_backend_interface.cpp).
std::string ultimateSlamFlags(const Rig& rig, const RigImu& imu, ExportNotes& notes) {
  const ImuNoise noise = statedNoise(imu, notes);
  const auto flag = [](const char* name, double value) {
    return fmt::format("--{}={}\n", name, real(value));
  };
  const RigCamera* const images = firstOf(rig, CameraKind::Frames);
  std::string text = flag("timeshift_cam_imu", images ? images->time_offset_s : 0.0) +
                     flag("swe_imu_rate", statedRate_hz(imu, notes)) +
                     flag("gyro_noise_density", noise.gyroscope_density) +
                     flag("acc_noise_density", noise.accelerometer_density) +
                     flag("vio_ceres_sigma_gyro_drift", noise.gyroscope_random_walk) +
                     flag("vio_ceres_sigma_accel_drift", noise.accelerometer_random_walk) +
                     flag("vio_ceres_gravity", rig.gravity_m_s2.norm());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const char letter = "xyz"[axis];
    text +=
        flag(fmt::format("vio_acc_bias_init_{}", letter).c_str(), imu.state.accelerometer_bias_m_s2[axis]) +
        flag(fmt::format("vio_gyr_bias_init_{}", letter).c_str(), imu.state.gyroscope_bias_rad_s[axis]);
  }
  return text;
}

const RigImu& checkedImu(const Rig& rig, const char* program, ExportNotes& notes) {
  const RigImu& imu = neededImu(rig, program);
  noteLostImus(rig, program, notes);
  noteLostMapping(imu, program, notes);
  return imu;
}

}  // namespace

ExportedFiles exportSvo(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const RigImu& imu = checkedImu(rig, "SVO", exported.notes);
  noteLostOffsets(rig, "SVO", exported.notes);
  exported.files.push_back(
      {"calib.yaml",
       headerComment(
           rig,
           {"SVO's calib_file: cameras, IMU and initial state. T_B_C transforms points of the camera to the "
            "IMU.",
            "t_imu = t_cam - delay_imu_cam: the sign is the opposite of Kalibr's.",
            "acc_max and omega_max are the sensor's limits: check them against its data sheet."}) +
           rigText(rig, "SVO", nullptr, exported.notes) + svoImu(rig, imu, exported.notes)});
  return exported;
}

ExportedFiles exportUltimateSlam(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const RigImu& imu = checkedImu(rig, "Ultimate SLAM", exported.notes);
  const RigCamera* const events = firstOf(rig, CameraKind::Events);
  const RigCamera& dvs = events ? *events : rig.cameras.front();
  const RigCamera* const images = firstOf(rig, CameraKind::Frames);
  noteUltimateSlamTimes(dvs, images, exported.notes);
  exported.notes.push_back(
      fmt::format("the camera {} is named dvs in calib.yaml: it must be the event camera", dvs.file_name));
  exported.files.push_back(
      {"calib.yaml", headerComment(rig, {"Camera rig of Ultimate SLAM. T_B_C transforms points of the camera "
                                         "to the IMU; the IMU's parameters are in "
                                         "imu.flags.",
                                         fmt::format("The event camera is named dvs there: here it is {}.",
                                                     dvs.file_name)}) +
                         rigText(rig, "Ultimate SLAM", &dvs, exported.notes)});
  exported.files.push_back(
      {"imu.flags",
       headerComment(
           rig, {"For --flagfile: t_imu = t_image + timeshift_cam_imu; noise in Kalibr's units.",
                 images ? fmt::format("timeshift_cam_imu applies to the images of {}.", images->file_name)
                        : std::string(
                              "timeshift_cam_imu does not shift events, and the rig has no frame camera.")}) +
           ultimateSlamFlags(rig, imu, exported.notes)});
  return exported;
}

}  // namespace evical
