// Source: HKUST-Aerial-Robotics/VINS-Fusion: vins_estimator/src/estimator/parameters.cpp (at 3d6cfb6:
// readParameters) and camera_models/src/camera_models/CameraFactory.cc (at 939f012:
// generateCameraFromYamlFile), which leaves the keys to PinholeCamera, EquidistantCamera and CataCamera. It
// reads a missing key as 0 without a warning.
#include "core/base/error.h"
#include "core/foreign/opencv_file.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace evical {
namespace {

std::vector<double> vinsFusionNumbersOf(const OpencvNode& node, std::initializer_list<const char*> keys) {
  std::vector<double> values;
  for (const char* key : keys) values.push_back(node[key].number());
  return values;
}

// The comparison ignores case.
std::string vinsFusionModelOf(const OpencvFile& file) {
  std::string name = file["model_type"].text();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::toupper(c); });
  return name;
}

ReadCamera vinsFusionCameraOf(const OpencvFile& file) {
  const std::string model = vinsFusionModelOf(file);
  const Resolution size{file["image_width"].integer(), file["image_height"].integer()};
  const OpencvNode projection = file["projection_parameters"];
  ReadCamera camera;
  if (model == "KANNALA_BRANDT") {
    camera.lens =
        lensFrom(CameraModel::PinholeEquidistant, vinsFusionNumbersOf(projection, {"mu", "mv", "u0", "v0"}),
                 vinsFusionNumbersOf(projection, {"k2", "k3", "k4", "k5"}), size);
  } else if (model == "PINHOLE" || model == "MEI") {
    std::vector<double> distortion =
        vinsFusionNumbersOf(file["distortion_parameters"], {"k1", "k2", "p1", "p2"});
    const bool mei = model == "MEI";
    if (mei) distortion.insert(distortion.begin(), file["mirror_parameters"]["xi"].number());
    camera.lens =
        mei ? lensFrom(CameraModel::OmniRadtan,
                       vinsFusionNumbersOf(projection, {"gamma1", "gamma2", "u0", "v0"}), distortion, size)
            : lensFrom(CameraModel::PinholeRadtan, vinsFusionNumbersOf(projection, {"fx", "fy", "cx", "cy"}),
                       distortion, size);
  } else {
    file["model_type"].fail("must be PINHOLE, KANNALA_BRANDT or MEI");
  }
  return camera;
}

ReadFile readVinsFusionCamera(const std::filesystem::path& path, std::size_t number) {
  const OpencvFile file(path);
  file["camera_name"].text();
  ReadFile read{path};
  read.cameras.resize(number + 1);  // earlier cameras are in separate files
  read.cameras[number] = vinsFusionCameraOf(file);
  return read;
}

ReadImu vinsFusionImuOf(const OpencvFile& file) {
  ReadImu imu;
  file["imu_topic"].text();
  imu.noise = {file["gyr_n"].number(), file["acc_n"].number(), file["gyr_w"].number(),
               file["acc_w"].number()};
  imu.noise_of_samples = true;  // IntegrationBase adds their squares without a time step
  return imu;
}

void askVinsFusionForOwnKeys(const OpencvFile& file) {
  for (const char* key :
       {"max_cnt", "min_dist", "show_track", "flow_back", "multiple_thread", "max_num_iterations"})
    file[key].integer();
  for (const char* key : {"F_threshold", "max_solver_time", "keyframe_parallax"})
    if (!(file[key].number() > 0.0)) file[key].fail("must be above 0");
  if (file["max_cnt"].integer() <= 0) file["max_cnt"].fail("must be above 0");
  file["output_path"].text();
}

}  // namespace

ReadFile readVinsCameraFile(const std::filesystem::path& path) {
  return {path, {vinsFusionCameraOf(OpencvFile(path))}};
}

ReadBack readVinsFusion(const std::filesystem::path& folder) {
  ReadBack read;
  read.max_cameras = 2;
  read.max_imus = 1;
  const std::filesystem::path path = folder / "vins.yaml";
  const OpencvFile file(path);
  askVinsFusionForOwnKeys(file);
  if (file["imu"].integer() != 1) file["imu"].fail("must be 1");
  if (file["estimate_extrinsic"].integer() != 0)
    file["estimate_extrinsic"].fail("must be 0; otherwise the program changes the poses");
  const int count = file["num_of_cam"].integer();
  if (count != 1 && count != 2) file["num_of_cam"].fail("must be 1 or 2");
  ReadFile vins{path, {}, {vinsFusionImuOf(file)}};
  vins.gravity_m_s2 = file["g_norm"].number();
  file["estimate_td"].integer();
  for (int i = 0; i < count; ++i) {
    ReadCamera camera;
    const OpencvNode pose = file[fmt::format("body_T_cam{}", i)];
    camera.frame_from_camera = rigidFrom(pose.matrix(4, 4, "fd"), pose.place());
    if (i == 0) camera.time_offset_s = file["td"].number();
    file[fmt::format("image{}_topic", i)].text();
    vins.cameras.push_back(camera);
    read.files.push_back(readVinsFusionCamera(folder / file[fmt::format("cam{}_calib", i)].text(),
                                              static_cast<std::size_t>(i)));
  }
  const CameraIntrinsics& first = *read.files.front().cameras.front().lens;
  if (file["image_width"].integer() != first.resolution_px.width_px ||
      file["image_height"].integer() != first.resolution_px.height_px)
    file["image_width"].fail("differs from that of the first camera");
  read.files.push_back(std::move(vins));
  return read;
}

}  // namespace evical
