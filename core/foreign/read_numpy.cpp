// Source: NumPy 1.24.2 (lib/format.py, lib/npyio.py) and Python's zipfile; the keys are those of
// docs/exports.md.
#include "core/foreign/npz_arrays.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include "core/base/error.h"
#include "core/geometry/camera_intrinsics.h"

#include <algorithm>
#include <iterator>

namespace evical {
namespace {

Eigen::Vector3d numpyVectorOf(const NpzArrays& arrays, const std::string& name) {
  const std::vector<double> numbers = arrays.numbers(name);
  if (numbers.size() != 3) throw badInput(arrays.place(name), "must have three numbers");
  return {numbers[0], numbers[1], numbers[2]};
}

CameraIntrinsics numpyLensOf(const NpzArrays& arrays, const std::string& sensor) {
  const std::string name = arrays.text(sensor + "model");
  const auto model = std::find(kCameraModelNames.begin(), kCameraModelNames.end(), name);
  if (model == kCameraModelNames.end())
    throw badInput(arrays.place(sensor + "model"), "is not a known model");
  const Eigen::Matrix3d k = arrays.matrix(sensor + "K", 3, 3);
  const std::vector<double> size = arrays.numbers(sensor + "resolution"), d = arrays.numbers(sensor + "D");
  const auto kind = static_cast<CameraModel>(std::distance(kCameraModelNames.begin(), model));
  if (size.size() != 2 || d.size() != static_cast<std::size_t>(coefficientCount(kind)))
    throw badInput(arrays.place(sensor + "D"), "or resolution has a wrong number of elements");
  return lensFrom(kind, {k(0, 0), k(1, 1), k(0, 2), k(1, 2)}, d,
                  {static_cast<int>(size[0]), static_cast<int>(size[1])});
}

ReadCamera numpyCameraOf(const NpzArrays& arrays, const std::string& name) {
  ReadCamera camera;
  camera.name = name;
  camera.lens = numpyLensOf(arrays, name + ".");
  camera.frame_from_camera =
      rigidFrom(arrays.matrix(name + ".T_ref_cam", 4, 4), arrays.place(name + ".T_ref_cam"));
  camera.time_offset_s = arrays.number(name + ".time_offset_s");
  return camera;
}

ReadImu numpyImuOf(const NpzArrays& arrays, const std::string& name) {
  ReadImu imu;
  imu.name = name;
  imu.reference_from_imu =
      rigidFrom(arrays.matrix(name + ".T_ref_imu", 4, 4), arrays.place(name + ".T_ref_imu"));
  imu.time_offset_s = arrays.number(name + ".time_offset_s");
  imu.accelerometer = arrays.matrix(name + ".accelerometer_M", 3, 3);
  imu.gyroscope = arrays.matrix(name + ".gyroscope_M", 3, 3);
  imu.accelerometer_bias_m_s2 = numpyVectorOf(arrays, name + ".accelerometer_bias_m_s2");
  imu.gyroscope_bias_rad_s = numpyVectorOf(arrays, name + ".gyroscope_bias_rad_s");
  if (arrays.has(name + ".rate_hz")) imu.rate_hz = arrays.number(name + ".rate_hz");
  const std::string keys[] = {name + ".gyroscope_noise_density", name + ".accelerometer_noise_density",
                              name + ".gyroscope_random_walk", name + ".accelerometer_random_walk"};
  if (std::all_of(std::begin(keys), std::end(keys), [&](const std::string& key) { return arrays.has(key); }))
    imu.noise = {arrays.number(keys[0]), arrays.number(keys[1]), arrays.number(keys[2]),
                 arrays.number(keys[3])};
  return imu;
}

}  // namespace

ReadBack readNumpy(const std::filesystem::path& folder) {
  ReadFile file{folder / "calibration.npz"};
  const NpzArrays arrays = NpzArrays::load(file.path);
  for (const std::string& name : arrays.texts("cameras")) file.cameras.push_back(numpyCameraOf(arrays, name));
  for (const std::string& name : arrays.texts("imus")) file.imus.push_back(numpyImuOf(arrays, name));
  if (!file.imus.empty()) file.gravity_m_s2 = numpyVectorOf(arrays, "gravity_m_s2").norm();
  ReadBack read;
  read.files = {file};
  return read;
}

}  // namespace evical
