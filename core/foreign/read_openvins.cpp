// Source: rpng/open_vins: ov_core/src/utils/opencv_yaml_parse.h (at 14211e2: YamlParser) and
// ov_msckf/src/core/VioManagerOptions.h (at 051f60c: print_and_load_noise, print_and_load_state). It parses
// with OpenCV and continues without missing keys, so that a missing key is as bad as a wrong one.
#include "core/foreign/opencv_file.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <fmt/format.h>
#include <Eigen/LU>

namespace evical {
namespace {

ReadFile readOpenvinsChain(const std::filesystem::path& path) {
  const OpencvFile chain(path);
  ReadFile file{path};
  for (std::size_t i = 0; i == 0 || chain.has(fmt::format("cam{}", i)); ++i) {
    const OpencvNode node = chain[fmt::format("cam{}", i)];
    ReadCamera camera;
    // The program treats any other name than equidistant as radtan.
    const std::string model = node["distortion_model"].text();
    if (model != "equidistant" && model != "radtan")
      node["distortion_model"].fail("must be radtan or equidistant");
    const std::vector<double> size = node["resolution"].numbers(2);
    camera.lens =
        lensFrom(model == "equidistant" ? CameraModel::PinholeEquidistant : CameraModel::PinholeRadtan,
                 node["intrinsics"].numbers(4), node["distortion_coeffs"].numbers(4),
                 {static_cast<int>(size[0]), static_cast<int>(size[1])});
    const bool direct = node.has("T_imu_cam");
    const OpencvNode pose = node[direct ? "T_imu_cam" : "T_cam_imu"];
    const RigidTransform transform = rigidFrom(pose.rows(4, 4), pose.place());
    camera.frame_from_camera = direct ? transform : inverse(transform);
    if (i == 0)
      camera.time_offset_s = node.has("timeshift_cam_imu") ? node["timeshift_cam_imu"].number() : 0.0;
    node["rostopic"].text();
    file.cameras.push_back(camera);
  }
  return file;
}

// It ignores elements outside of the model's triangle.
Eigen::Matrix3d triangleOf(const Eigen::Matrix3d& inverse_of, bool upper) {
  const Eigen::Matrix3d whole = inverse_of.inverse();
  if (upper) return whole.triangularView<Eigen::Upper>();
  return whole.triangularView<Eigen::Lower>();
}

ReadFile readOpenvinsImu(const std::filesystem::path& path) {
  const OpencvFile chain(path);
  const OpencvNode node = chain["imu0"];
  ReadImu imu;
  imu.noise = {node["gyroscope_noise_density"].number(), node["accelerometer_noise_density"].number(),
               node["gyroscope_random_walk"].number(), node["accelerometer_random_walk"].number()};
  node["rostopic"].text();
  imu.rate_hz = node["update_rate"].number();
  const std::string model = node["model"].text();
  if (model != "calibrated" && model != "kalibr" && model != "rpng")
    node["model"].fail("must be calibrated, kalibr or rpng");
  const Eigen::Matrix3d to_acc = node["R_IMUtoACC"].rows(3, 3), to_gyro = node["R_IMUtoGYRO"].rows(3, 3);
  if (node["Tg"].rows(3, 3) != Eigen::Matrix3d::Zero())
    node["Tg"].fail("is the g-sensitivity of a gyroscope, which is not supported");
  const bool upper = model == "rpng";
  imu.accelerometer = triangleOf(node["Ta"].rows(3, 3), upper).inverse() * to_acc;
  imu.gyroscope = triangleOf(node["Tw"].rows(3, 3), upper).inverse() * to_gyro;
  return {path, {}, {imu}};
}

}  // namespace

ReadBack readOpenVins(const std::filesystem::path& folder) {
  ReadBack read;
  read.max_imus = 1;
  read.files = {readOpenvinsChain(folder / "kalibr_imucam_chain.yaml"),
                readOpenvinsImu(folder / "kalibr_imu_chain.yaml")};
  return read;
}

}  // namespace evical
