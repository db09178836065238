#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr const char* kVinsFusionProgram = "VINS-Fusion";
constexpr KnownModels kVinsFusionModels{kVinsFusionProgram, true, false, true, false, false, true};
constexpr std::size_t kVinsFusionMaxCameras = 2;

// Keys that are not part of a calibration: if they are missing, the program reads 0 and detects no features.
constexpr const char* kVinsFusionOwnKeys =
    "output_path: \"/tmp/\"\nmultiple_thread: 1\nmax_cnt: 150\nmin_dist: 30\nfreq: 10\nF_threshold: 1.0\n"
    "show_track: 1\nflow_back: 1\nmax_solver_time: 0.04\nmax_num_iterations: 8\nkeyframe_parallax: 10.0\n"
    "load_previous_pose_graph: 0\npose_graph_save_path: \"/tmp/\"\nsave_image: 0\n";

// Parameters of camodocal's MEI model.
std::string omniText(const CameraIntrinsics& own) {
  const auto& d = own.distortion;
  return fmt::format(
      "mirror_parameters:\n   xi: {}\ndistortion_parameters:\n   k1: {}\n   k2: {}\n   p1: {}\n   p2: {}\n"
      "projection_parameters:\n   gamma1: {}\n   gamma2: {}\n   u0: {}\n   v0: {}\n",
      real(d[0]), real(d[1]), real(d[2]), real(d[3]), real(d[4]), real(own.focal_length_px.x()),
      real(own.focal_length_px.y()), real(own.principal_point_px.x()), real(own.principal_point_px.y()));
}

// camodocal's camera file. Its Kannala-Brandt k2..k5 are k1..k4 elsewhere.
std::string vinsFusionCameraFile(const Rig& rig, const RigCamera& camera, ExportNotes& notes) {
  const CameraIntrinsics own = cameraFor(camera, kVinsFusionModels, notes);
  const bool radtan = own.model == CameraModel::PinholeRadtan;
  const bool omni = own.model == CameraModel::OmniRadtan;
  const std::vector<double> d = distortionOf(own, 4);
  const std::string f[] = {real(own.focal_length_px.x()), real(own.focal_length_px.y()),
                           real(own.principal_point_px.x()), real(own.principal_point_px.y())};
  std::string text = "%YAML:1.0\n---\n" + headerComment(rig, {"Camera of VINS-Fusion (camodocal)."}) +
                     fmt::format("model_type: {}\ncamera_name: {}\nimage_width: {}\nimage_height: {}\n",
                                 omni     ? "MEI"
                                 : radtan ? "PINHOLE"
                                          : "KANNALA_BRANDT",
                                 stringIn(Language::Yaml, camera.file_name), own.resolution_px.width_px,
                                 own.resolution_px.height_px);
  if (omni) return text + omniText(own);
  if (!radtan)
    return text + fmt::format(
                      "projection_parameters:\n   k2: {}\n   k3: {}\n   k4: {}\n   k5: {}\n   mu: {}\n   mv: "
                      "{}\n   u0: {}\n   v0: {}\n",
                      real(d[0]), real(d[1]), real(d[2]), real(d[3]), f[0], f[1], f[2], f[3]);
  return text + fmt::format(
                    "distortion_parameters:\n   k1: {}\n   k2: {}\n   p1: {}\n   p2: {}\n"
                    "projection_parameters:\n   fx: {}\n   fy: {}\n   cx: {}\n   cy: {}\n",
                    real(d[0]), real(d[1]), real(d[2]), real(d[3]), f[0], f[1], f[2], f[3]);
}

std::string configuration(const Rig& rig, const RigImu& imu, ExportNotes& notes) {
  const std::size_t count = std::min(rig.cameras.size(), kVinsFusionMaxCameras);
  const ImuNoise noise = statedNoise(imu, notes);
  std::string text =
      "%YAML:1.0\n---\n" +
      headerComment(
          rig,
          {"The calibration part of a VINS-Fusion configuration. body_T_camN transforms points of the "
           "camera to the IMU; t_imu = t_cam + td.",
           "Noise is that of a sample, as the program requires: densities times the square root of the rate.",
           "The keys after td are the program's, with the values of its EuRoC configuration."}) +
      fmt::format("imu: 1\nnum_of_cam: {}\nimu_topic: {}\n", count, stringIn(Language::Yaml, imu.stream));
  for (std::size_t i = 0; i < count; ++i)
    text += fmt::format("image{}_topic: {}\n", i, stringIn(Language::Yaml, rig.cameras[i].stream));
  for (std::size_t i = 0; i < count; ++i)
    text += fmt::format("cam{}_calib: \"{}.yaml\"\n", i, rig.cameras[i].file_name);
  const Resolution& size = rig.cameras[0].intrinsics.resolution_px;
  text += fmt::format("image_width: {}\nimage_height: {}\nestimate_extrinsic: 0\n", size.width_px,
                      size.height_px);
  for (std::size_t i = 0; i < count; ++i)
    text += opencvMatrix(fmt::format("body_T_cam{}", i).c_str(),
                         matrixOf(rig.cameras[i].reference_from_camera), 'd');
  // Its pre-integration multiplies each by the time step, and adds the squares.
  const double of_sample = std::sqrt(statedRate_hz(imu, notes));
  return text +
         fmt::format("acc_n: {}\ngyr_n: {}\nacc_w: {}\ngyr_w: {}\ng_norm: {}\nestimate_td: 0\ntd: {}\n",
                     real(of_sample * noise.accelerometer_density), real(of_sample * noise.gyroscope_density),
                     real(of_sample * noise.accelerometer_random_walk),
                     real(of_sample * noise.gyroscope_random_walk), real(rig.gravity_m_s2.norm()),
                     real(rig.cameras[0].time_offset_s)) +
         kVinsFusionOwnKeys;
}

}  // namespace

ExportedFiles exportVinsFusion(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const RigImu& imu = neededImu(rig, kVinsFusionProgram);
  noteLostImus(rig, kVinsFusionProgram, exported.notes);
  noteLostCameras(rig, kVinsFusionMaxCameras, kVinsFusionProgram, exported.notes);
  noteLostOffsets(rig, kVinsFusionProgram, exported.notes);
  noteLostMapping(imu, kVinsFusionProgram, exported.notes);
  exported.files.push_back({"vins.yaml", configuration(rig, imu, exported.notes)});
  for (std::size_t i = 0; i < std::min(rig.cameras.size(), kVinsFusionMaxCameras); ++i)
    exported.files.push_back(
        {rig.cameras[i].file_name + ".yaml", vinsFusionCameraFile(rig, rig.cameras[i], exported.notes)});
  return exported;
}

}  // namespace evical
