#include "core/base/error.h"
#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/stereo.h"

#include <fmt/format.h>

#include <utility>

namespace evical {
namespace {

constexpr const char* kKimeraProgram = "Kimera-VIO";

// Keys that its YamlParser requires, but that are not part of a calibration; values of its EuRoC parameters.
// Later versions align clocks by rotation rates if --do_fine_imu_camera_temporal_sync is set.
constexpr const char* kOwnImuKeys =
    "imu_preintegration_type: 1\nimu_integration_sigma: 1.0e-08\nimu_bias_init_sigma: 1.0e-03\n"
    "do_imu_rate_time_alignment: 1\ntime_alignment_window_size_s: 10.0\n"
    "time_alignment_variance_threshold_scaling: 30.0\n";
constexpr int kFrameRate_hz = 20;  // an integer above 0, as in its EuRoC parameters

// A map, which its parser requires.
std::string kimeraPoseText(const Eigen::Matrix4d& pose) {
  return "T_BS:\n" + dataMatrix(pose, 2);
}

std::string kimeraCameraFile(const Rig& rig, const RigCamera& camera, const CameraIntrinsics& own) {
  const bool radtan = own.model == CameraModel::PinholeRadtan;
  const int coefficients = radtan && own.distortion[4] != 0.0 ? 5 : 4;
  return "%YAML:1.0\n---\n" +
         headerComment(
             rig,
             {"Camera of Kimera-VIO. T_BS transforms points of the camera to the IMU, which is the body.",
              "rate_hz is the rate of your images: set it."}) +
         fmt::format("camera_id: \"{}\"\n", camera.file_name) +
         kimeraPoseText(matrixOf(camera.reference_from_camera)) +
         fmt::format(
             "rate_hz: {}\nresolution: [{}, {}]\ncamera_model: pinhole\n"
             "intrinsics: [{}, {}, {}, {}]\ndistortion_model: {}\ndistortion_coefficients: [{}]\n",
             kFrameRate_hz, own.resolution_px.width_px, own.resolution_px.height_px,
             real(own.focal_length_px.x()), real(own.focal_length_px.y()), real(own.principal_point_px.x()),
             real(own.principal_point_px.y()), radtan ? "radtan" : "equidistant",
             realList(distortionOf(own, coefficients)));
}

std::string kimeraImuFile(const Rig& rig, const RigImu& imu, ExportNotes& notes) {
  const ImuNoise noise = statedNoise(imu, notes);
  return "%YAML:1.0\n---\n" +
         headerComment(rig, {"IMU of Kimera-VIO. It is the body, so T_BS is the identity.",
                             "t_imu = t_cam + imu_time_shift; n_gravity is in a world frame with z up."}) +
         kimeraPoseText(Eigen::Matrix4d::Identity()) +
         fmt::format(
             "rate_hz: {}\ngyroscope_noise_density: {}\ngyroscope_random_walk: {}\n"
             "accelerometer_noise_density: {}\naccelerometer_random_walk: {}\nimu_time_shift: {}\n"
             "n_gravity: [0.0, 0.0, {}]\n",
             real(statedRate_hz(imu, notes)), real(noise.gyroscope_density),
             real(noise.gyroscope_random_walk), real(noise.accelerometer_density),
             real(noise.accelerometer_random_walk), real(rig.cameras[0].time_offset_s),
             real(-rig.gravity_m_s2.norm())) +
         kOwnImuKeys;
}

// Its FrontendType and BackendType: 0 is one camera, 1 two.
std::string pipelineFile(const Rig& rig, std::size_t cameras) {
  return "%YAML:1.0\n---\n" +
         headerComment(rig,
                       {"Pipeline of Kimera-VIO. frontend_type: 0 is one camera, 1 two; the others are the "
                        "program's own, with the values of its EuRoC parameters."}) +
         fmt::format("frontend_type: {}\nbackend_type: 1\ndisplay_type: 0\nparallel_run: 1\n", cameras - 1);
}

// The left camera first; only the first one if the cameras are not side by side, for the mono pipeline.
std::size_t sortCameras(Rig& rig, ExportNotes& notes) {
  const std::optional<StereoPair> pair = sideBySide(rig);
  if (pair && pair->left.name != rig.cameras[0].name) std::swap(rig.cameras[0], rig.cameras[1]);
  if (pair) return 2;
  if (rig.cameras.size() > 1)
    notes.push_back(
        fmt::format("{} and {} are not side by side, as Kimera-VIO's stereo pipeline requires: only {} is "
                    "written, for its mono pipeline",
                    rig.cameras[0].name, rig.cameras[1].name, rig.cameras[0].name));
  return 1;
}

}  // namespace

ExportedFiles exportKimera(const NamedResult& result) {
  ExportedFiles exported;
  Rig rig = rigOf(result);
  const RigImu& imu = neededImu(rig, kKimeraProgram);
  const std::size_t count = sortCameras(rig, exported.notes);
  noteLostImus(rig, kKimeraProgram, exported.notes);
  noteLostCameras(rig, count, kKimeraProgram, exported.notes);
  noteLostOffsets(rig, kKimeraProgram, exported.notes);
  noteLostMapping(imu, kKimeraProgram, exported.notes);
  // It rectifies both with the left one's distortion_model.
  const bool radtan = rig.cameras[0].intrinsics.model == CameraModel::PinholeRadtan;
  const KnownModels models{kKimeraProgram, radtan, true, !radtan};
  constexpr const char* kNames[] = {"LeftCameraParams.yaml", "RightCameraParams.yaml"};
  for (std::size_t i = 0; i < count; ++i)
    exported.files.push_back(
        {kNames[i],
         kimeraCameraFile(rig, rig.cameras[i], cameraFor(rig.cameras[i], models, exported.notes))});
  exported.files.push_back({"ImuParams.yaml", kimeraImuFile(rig, imu, exported.notes)});
  exported.files.push_back({"PipelineParams.yaml", pipelineFile(rig, count)});
  return exported;
}

}  // namespace evical
