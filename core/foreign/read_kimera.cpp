// Source: MIT-SPARK/Kimera-VIO, include/kimera-vio/utils/YamlParser.h (at decef91),
// src/frontend/CameraParams.cpp (at 2b79043), src/imu-frontend/ImuFrontendParams.cpp (at db6748d) and
// src/pipeline/Pipeline-definitions.cpp (at 6b8ec96).
#include "core/foreign/opencv_file.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

namespace evical {
namespace {

RigidTransform kimeraPoseOf(const OpencvFile& file) {
  const OpencvNode data = file["T_BS"]["data"];
  return rigidFrom(matrixFrom(data.numbers(16), 4, 4), data.place());
}

ReadFile readKimeraCamera(const std::filesystem::path& path) {
  const OpencvFile file(path);
  if (file["camera_model"].text() != "pinhole") file["camera_model"].fail("must be pinhole");
  const std::string model = file["distortion_model"].text();
  if (model != "radtan" && model != "equidistant")
    file["distortion_model"].fail("must be radtan or equidistant");
  if (file["rate_hz"].integer() <= 0) file["rate_hz"].fail("must be above 0");
  const Resolution size = file["resolution"].resolution();
  const OpencvNode distortion = file["distortion_coefficients"];
  const bool third_radial = model == "radtan" && distortion.size() == 5;
  ReadCamera camera;
  camera.name = file["camera_id"].text();
  if (camera.name.empty()) file["camera_id"].fail("cannot be empty");
  camera.lens = lensFrom(model == "radtan" ? CameraModel::PinholeRadtan : CameraModel::PinholeEquidistant,
                         file["intrinsics"].numbers(4), distortion.numbers(third_radial ? 5 : 4), size);
  camera.frame_from_camera = kimeraPoseOf(file);
  return {path, {camera}};
}

// One shift for all cameras: assigned to the left one.
ReadFile readKimeraImu(const std::filesystem::path& path, ReadFile& left) {
  const OpencvFile file(path);
  const auto positive = [&](const char* key) {
    const double value = file[key].number();
    if (!(value > 0.0)) file[key].fail("must be above 0");
    return value;
  };
  file["imu_preintegration_type"].integer();
  const RigidTransform body_from_imu = kimeraPoseOf(file);
  constexpr double kSame = 1e-9;  // gtsam's equals
  if (body_from_imu.translation_m.norm() > kSame || body_from_imu.rotation.vec().norm() > kSame)
    file["T_BS"].fail("must be the identity: the IMU is the body");
  positive("imu_integration_sigma");
  ReadImu imu;
  imu.rate_hz = positive("rate_hz");
  imu.noise = {positive("gyroscope_noise_density"), positive("accelerometer_noise_density"),
               positive("gyroscope_random_walk"), positive("accelerometer_random_walk")};
  left.cameras[0].time_offset_s = file["imu_time_shift"].number();
  const std::vector<double> gravity = file["n_gravity"].numbers(3);
  ReadFile read{path};
  read.imus.push_back(imu);
  read.gravity_m_s2 = Eigen::Map<const Eigen::Vector3d>(gravity.data()).norm();
  return read;
}

}  // namespace

ReadBack readKimera(const std::filesystem::path& folder) {
  const OpencvFile pipeline(folder / "PipelineParams.yaml");
  for (const char* const key : {"backend_type", "display_type", "parallel_run"}) pipeline[key].integer();
  const bool stereo = pipeline["frontend_type"].integer() == 1;  // StereoImu
  ReadBack read{{readKimeraCamera(folder / "LeftCameraParams.yaml")}, stereo ? 2U : 1U, 1};
  if (stereo) read.files.push_back(readKimeraCamera(folder / "RightCameraParams.yaml"));
  ReadFile imu = readKimeraImu(folder / "ImuParams.yaml", read.files[0]);
  read.files.push_back(std::move(imu));
  return read;
}

}  // namespace evical
