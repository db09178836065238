#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/kalibr_text.h"
#include "core/export/rig.h"

#include <fmt/format.h>

namespace evical {
namespace {

constexpr KnownModels kKalibrModels{"Kalibr", true, false, true, true, true, true};

std::string kalibrCameraText(const Rig& rig, std::size_t i, const CameraIntrinsics& own) {
  const RigCamera& camera = rig.cameras[i];
  std::string overlaps;
  for (std::size_t other = 0; other < rig.cameras.size(); ++other)
    if (other != i) overlaps += fmt::format("{}{}", overlaps.empty() ? "" : ", ", other);
  return fmt::format(
      "  cam_overlaps: [{}]\n{}  resolution: [{}, {}]\n  rostopic: {}\n", overlaps, kalibrLensText(own),
      own.resolution_px.width_px, own.resolution_px.height_px,
      stringIn(Language::Yaml, camera.stream.empty() ? fmt::format("/{}", camera.file_name) : camera.stream));
}

// Rows need more indentation than their key, or OpenCV's parser (OpenVINS) fails.
// A point p in camera N - 1 is T_cn_cnm1 p in camera N.
std::string kalibrChainText(const Rig& rig, std::size_t i) {
  const RigidTransform step =
      inverse(rig.cameras[i].reference_from_camera) * rig.cameras[i - 1].reference_from_camera;
  return "  T_cn_cnm1:\n" + rowsYaml(matrixOf(step), 4);
}

std::string camchain(const Rig& rig, const std::vector<CameraIntrinsics>& lenses) {
  std::string text =
      headerComment(rig, {"Kalibr camera chain. T_cn_cnm1 transforms points of the camera before "
                          "to this camera."});
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    text += fmt::format("cam{}:  # {}\n", i, rig.cameras[i].file_name);
    if (i > 0) text += kalibrChainText(rig, i);
    text += kalibrCameraText(rig, i, lenses[i]);
  }
  return text;
}

}  // namespace

std::vector<CameraIntrinsics> lensesFor(const KnownModels& known, const Rig& rig, ExportNotes& notes) {
  std::vector<CameraIntrinsics> lenses;
  for (const RigCamera& camera : rig.cameras) lenses.push_back(cameraFor(camera, known, notes));
  return lenses;
}

std::string kalibrLensText(const CameraIntrinsics& camera) {
  const bool spheres = camera.model == CameraModel::DoubleSphere || camera.model == CameraModel::Eucm;
  const bool omni = camera.model == CameraModel::OmniRadtan;
  const auto* const coefficients = camera.distortion.data();
  const std::ptrdiff_t own = spheres ? 2
                             : omni  ? 1
                                     : 0;  // coefficients that Kalibr lists before the focal lengths
  std::vector<double> intrinsics(coefficients, coefficients + own);
  intrinsics.insert(intrinsics.end(), camera.focal_length_px.begin(), camera.focal_length_px.end());
  intrinsics.insert(intrinsics.end(), camera.principal_point_px.begin(), camera.principal_point_px.end());
  const std::vector<double> distortion(coefficients + own, coefficients + own + (spheres ? 0 : 4));
  const char* model = camera.model == CameraModel::DoubleSphere ? "ds"
                      : camera.model == CameraModel::Eucm       ? "eucm"
                      : omni                                    ? "omni"
                                                                : "pinhole";
  const char* distortion_model = spheres                                           ? "none"
                                 : camera.model == CameraModel::PinholeEquidistant ? "equidistant"
                                                                                   : "radtan";
  return fmt::format(
      "  camera_model: {}\n  distortion_coeffs: [{}]\n  distortion_model: {}\n  intrinsics: [{}]\n", model,
      realList(distortion), distortion_model, realList(intrinsics));
}

std::string camchainYaml(const std::string& stream, const CameraIntrinsics& c) {
  std::string text;
  if (c.model == CameraModel::PinholeRadtan && distortionCount(c) == 5)
    text += fmt::format("# k3 = {} is left out: Kalibr's radtan does not support it\n", c.distortion[4]);
  return text + fmt::format("cam0:\n{}  resolution: [{}, {}]\n  rostopic: {}\n  cam_overlaps: []\n",
                            kalibrLensText(c), c.resolution_px.width_px, c.resolution_px.height_px,
                            stringIn(Language::Yaml, stream));
}

std::string kalibrChain(const Rig& rig, const std::vector<CameraIntrinsics>& lenses,
                        const Eigen::Matrix3d& other_from_imu, const std::vector<std::string>& comment) {
  std::string text = headerComment(rig, comment);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const RigCamera& camera = rig.cameras[i];
    const RigidTransform camera_from_imu = inverse(turnOf(other_from_imu) * camera.reference_from_camera);
    text += fmt::format("cam{}:  # {}\n  T_cam_imu:\n{}", i, camera.file_name,
                        rowsYaml(matrixOf(camera_from_imu), 4));
    if (i > 0) text += kalibrChainText(rig, i);
    text += kalibrCameraText(rig, i, lenses[i]) +
            fmt::format("  timeshift_cam_imu: {}\n", real(camera.time_offset_s));
  }
  return text;
}

std::string kalibrNoise(const RigImu& imu, int indent, ExportNotes& notes) {
  const ImuNoise noise = statedNoise(imu, notes);
  const std::string blanks(static_cast<std::size_t>(indent), ' ');
  return fmt::format(
      "{0}rostopic: {1}\n{0}update_rate: {2}\n{0}accelerometer_noise_density: {3}  # m/s^2/sqrt(Hz)\n"
      "{0}accelerometer_random_walk: {4}  # m/s^3/sqrt(Hz)\n{0}gyroscope_noise_density: {5}  # "
      "rad/s/sqrt(Hz)\n"
      "{0}gyroscope_random_walk: {6}  # rad/s^2/sqrt(Hz)\n",
      blanks, stringIn(Language::Yaml, imu.stream.empty() ? fmt::format("/{}", imu.file_name) : imu.stream),
      real(statedRate_hz(imu, notes)), real(noise.accelerometer_density),
      real(noise.accelerometer_random_walk), real(noise.gyroscope_density),
      real(noise.gyroscope_random_walk));
}

std::string kalibrPlacing(const Rig& rig, const RigImu& imu) {
  const auto turned = [](const RigImu& one) { return turnOf(lowerTriangular(one.state).other_from_imu); };
  const bool reference = &imu == &rig.imus.front();
  const RigidTransform i_from_b =
      reference ? RigidTransform{}
                : turned(imu) * inverse(imu.state.reference_from_imu) * inverse(turned(rig.imus.front()));
  return fmt::format("  T_i_b:\n{}  time_offset: {}\n", rowsYaml(matrixOf(i_from_b), 4),
                     real(imu.state.time_offset_s));
}

std::string biasComment(const RigImu& imu) {
  return fmt::format("  # biases over the recording: gyroscope [{}] rad/s, accelerometer [{}] m/s^2\n",
                     realList(imu.state.gyroscope_bias_rad_s), realList(imu.state.accelerometer_bias_m_s2));
}

namespace {

std::string kalibrMappingText(const RigImu& imu) {
  if (!hasMapping(imu.state)) return "  model: calibrated\n";
  const LowerTriangularImu lower = lowerTriangular(imu.state);
  return fmt::format(
      "  model: scale-misalignment\n  accelerometers:\n    M:\n{}  gyroscopes:\n    M:\n{}    A:\n{}"
      "    C_gyro_i:\n{}",
      rowsYaml(lower.accelerometer, 6), rowsYaml(lower.gyroscope, 6), rowsYaml(Eigen::Matrix3d::Zero(), 6),
      rowsYaml(lower.gyroscope_rotation, 6));
}

std::string kalibrImuFile(const Rig& rig, ExportNotes& notes) {
  std::string text = headerComment(
      rig,
      {"Kalibr IMU chain. T_i_b transforms points of imu0 to this IMU; time of imu0 = time of this IMU + "
       "time_offset.",
       "measured force = accelerometers.M f + bias, measured rate = gyroscopes.M C_gyro_i w + bias, M lower "
       "triangular."});
  for (std::size_t i = 0; i < rig.imus.size(); ++i) {
    const RigImu& imu = rig.imus[i];
    text += fmt::format("imu{}:  # {}\n", i, imu.file_name) + kalibrNoise(imu, 2, notes) +
            kalibrPlacing(rig, imu) + biasComment(imu) + kalibrMappingText(imu);
  }
  return text;
}

}  // namespace

ExportedFiles exportKalibr(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  const std::vector<CameraIntrinsics> lenses = lensesFor(kKalibrModels, rig, exported.notes);
  exported.files.push_back({"camchain.yaml", camchain(rig, lenses)});
  if (rig.imus.empty()) {
    noteNoOffsets(rig, "Kalibr's camchain.yaml", exported.notes);
    return exported;
  }
  const Eigen::Matrix3d turn = lowerTriangular(rig.imus.front().state).other_from_imu;
  std::vector<std::string> comment{
      "Kalibr camera-IMU chain. T_cam_imu transforms points of the IMU to the camera; t_imu = t_cam + "
      "timeshift_cam_imu."};
  if (turn != Eigen::Matrix3d::Identity())
    comment.emplace_back(
        "The IMU's frame is Kalibr's, in which the accelerometer's M is lower triangular: it is rotated "
        "relative to Evical's.");
  exported.files.push_back({"camchain-imucam.yaml", kalibrChain(rig, lenses, turn, comment)});
  exported.files.push_back({"imu.yaml", kalibrImuFile(rig, exported.notes)});
  ExportNotes said;  // already reported with imu.yaml
  for (const RigImu& imu : rig.imus)
    exported.files.push_back(
        {fmt::format("input-{}.yaml", imu.file_name),
         headerComment(rig, {"For kalibr_calibrate_imu_camera --imu, which does not accept imu.yaml: "
                             "that has the format of Kalibr's results."}) +
             kalibrNoise(imu, 0, said)});
  return exported;
}

}  // namespace evical
