#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/export/stereo.h"

#include <fmt/format.h>

namespace evical {
namespace {

// Fisheye lenses are those of cv::fisheye, omni is that of cv::omnidir (opencv_contrib).
constexpr KnownModels kOpencvModels{"OpenCV", true, true, true, false, false, true};

// Order of OpenCV's functions for the model, as a column: k1 k2 p1 p2 k3, k1 k2 k3 k4, or k1 k2 p1 p2 with
// separate xi.
Eigen::VectorXd opencvCoefficients(const CameraIntrinsics& own) {
  const auto& d = own.distortion;
  switch (own.model) {
    case CameraModel::PinholeEquidistant:
      return Eigen::Vector4d(d[0], d[1], d[2], d[3]);
    case CameraModel::OmniRadtan:
      return Eigen::Vector4d(d[1], d[2], d[3], d[4]);
    default:
      return Eigen::Map<const Eigen::VectorXd>(d.data(), static_cast<Eigen::Index>(d.size()));
  }
}

std::string opencvMatrixText(const std::string& key, const Eigen::MatrixXd& matrix) {
  return opencvMatrix(key.c_str(), matrix, 'd');
}

std::string opencvLensText(const std::string& k_key, const std::string& d_key, const std::string& xi_key,
                           const CameraIntrinsics& own) {
  std::string text =
      opencvMatrixText(k_key, cameraMatrix(own)) + opencvMatrixText(d_key, opencvCoefficients(own));
  if (own.model == CameraModel::OmniRadtan)
    text += opencvMatrixText(xi_key, Eigen::MatrixXd::Constant(1, 1, own.distortion[0]));
  return text;
}

// The keys of its calibration samples, and the camera's pose.
std::string opencvCameraFile(const Rig& rig, const RigCamera& camera, const CameraIntrinsics& own) {
  const std::string reference = rig.imus.empty() ? rig.cameras[0].file_name : rig.imus[0].file_name;
  return "%YAML:1.0\n---\n" +
         headerComment(
             rig,
             {fmt::format("Camera {} for OpenCV: cv::{}.", camera.name,
                          own.model == CameraModel::PinholeRadtan ? "projectPoints"
                          : own.model == CameraModel::OmniRadtan  ? "omnidir::projectPoints"
                                                                  : "fisheye::projectPoints"),
              fmt::format("reference_from_camera transforms points of the camera to {0}; t_{0} = t_camera + "
                          "time_offset_s.",
                          reference)}) +
         fmt::format("image_width: {}\nimage_height: {}\nfisheye_model: {}\n", own.resolution_px.width_px,
                     own.resolution_px.height_px, own.model == CameraModel::PinholeEquidistant ? 1 : 0) +
         opencvLensText("camera_matrix", "distortion_coefficients", "xi", own) +
         fmt::format("avg_reprojection_error: {}\n", real(camera.fit.reprojection_rms_px)) +
         opencvMatrixText("reference_from_camera", matrixOf(camera.reference_from_camera)) +
         fmt::format("time_offset_s: {}\n", real(camera.time_offset_s));
}

std::string opencvImuFile(const Rig& rig, const RigImu& imu, ExportNotes& notes) {
  const ImuNoise noise = statedNoise(imu, notes);
  return "%YAML:1.0\n---\n" +
         headerComment(
             rig, {fmt::format("reference_from_imu transforms points of {} to {}; t_reference = t_imu + "
                               "time_offset_s.",
                               imu.name, rig.imus[0].name),
                   "measured force = accelerometer_matrix f + accelerometer_bias [m/s^2], measured rate = "
                   "gyroscope_matrix w + gyroscope_bias [rad/s]."}) +
         opencvMatrixText("reference_from_imu", matrixOf(imu.state.reference_from_imu)) +
         fmt::format("time_offset_s: {}\n", real(imu.state.time_offset_s)) +
         opencvMatrixText("accelerometer_matrix", imu.state.accelerometer_scale_misalignment) +
         opencvMatrixText("gyroscope_matrix", imu.state.gyroscopeMatrix()) +
         opencvMatrixText("accelerometer_bias", imu.state.accelerometer_bias_m_s2) +
         opencvMatrixText("gyroscope_bias", imu.state.gyroscope_bias_rad_s) +
         fmt::format(
             "rate_hz: {}\naccelerometer_noise_density: {}\ngyroscope_noise_density: {}\n"
             "accelerometer_random_walk: {}\ngyroscope_random_walk: {}\n",
             real(statedRate_hz(imu, notes)), real(noise.accelerometer_density),
             real(noise.gyroscope_density), real(noise.accelerometer_random_walk),
             real(noise.gyroscope_random_walk));
}

// Q of cv::stereoRectify: (x, y, disparity, 1) to a point in the left rectified frame.
Eigen::Matrix4d depthFromDisparity(const Rectification& rectified) {
  const double f = rectified.left_projection(0, 0);
  Eigen::Matrix4d q = Eigen::Matrix4d::Zero();
  q(0, 0) = q(1, 1) = 1.0;
  q.topRightCorner<2, 1>() = -rectified.left_projection.block<2, 1>(0, 2);
  q(2, 3) = f;
  q(3, 2) = -f / rectified.right_projection(0, 3);
  return q;
}

// intrinsics.yml and extrinsics.yml of OpenCV's stereo_calib sample, and E and F.
void addOpencvPair(const Rig& rig, const StereoPair& pair, const CameraIntrinsics& left,
                   const CameraIntrinsics& right, std::vector<FileContent>& files) {
  const std::vector<std::string> comment{
      fmt::format(
          "Camera 1 is {} (left), camera 2 {} (right), as OpenCV's stereo_calib sample writes them. R and T "
          "transform points of camera 1 to camera 2 [m]; R1, R2, P1, P2 and Q rectify (Bouguet).",
          pair.left.name, pair.right.name),
      "x2^T E x1 = 0 in normalised coordinates, x2^T F x1 = 0 in undistorted pixels."};
  const std::string beginning = "%YAML:1.0\n---\n" + headerComment(rig, comment);
  files.push_back({"intrinsics.yml", beginning + opencvLensText("M1", "D1", "xi1", left) +
                                         opencvLensText("M2", "D2", "xi2", right)});
  const Rectification rectified = rectify(left, right, pair.right_from_left);
  files.push_back(
      {"extrinsics.yml", beginning + opencvMatrixText("R", pair.right_from_left.rotation.toRotationMatrix()) +
                             opencvMatrixText("T", pair.right_from_left.translation_m) +
                             opencvMatrixText("E", essentialMatrix(pair.right_from_left)) +
                             opencvMatrixText("F", fundamentalMatrix(left, right, pair.right_from_left)) +
                             opencvMatrixText("R1", rectified.rectified_from_left) +
                             opencvMatrixText("R2", rectified.rectified_from_right) +
                             opencvMatrixText("P1", rectified.left_projection) +
                             opencvMatrixText("P2", rectified.right_projection) +
                             opencvMatrixText("Q", depthFromDisparity(rectified))});
}

}  // namespace

ExportedFiles exportOpenCv(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  std::vector<CameraIntrinsics> lenses;
  for (const RigCamera& camera : rig.cameras) {
    lenses.push_back(cameraFor(camera, kOpencvModels, exported.notes));
    exported.files.push_back({camera.file_name + ".yaml", opencvCameraFile(rig, camera, lenses.back())});
  }
  if (const std::optional<StereoPair> pair = sideBySide(rig)) {
    const bool swapped = pair->left.name != rig.cameras[0].name;
    addOpencvPair(rig, *pair, lenses[swapped ? 1 : 0], lenses[swapped ? 0 : 1], exported.files);
  } else if (rig.cameras.size() > 1) {
    exported.notes.push_back(fmt::format(
        "{} and {} are not side by side: intrinsics.yml and extrinsics.yml of a pair are not written",
        rig.cameras[0].name, rig.cameras[1].name));
  }
  for (const RigImu& imu : rig.imus)
    exported.files.push_back({imu.file_name + ".yaml", opencvImuFile(rig, imu, exported.notes)});
  return exported;
}

}  // namespace evical
