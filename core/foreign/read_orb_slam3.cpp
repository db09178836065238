// Source: UZ-SLAMLab/ORB_SLAM3: src/Settings.cc (at 1464d8f). It stores floats, only accepts matrices of
// floats, and ends if a key is missing or an int is a real number. It rectifies both of two pinholes with the
// first one's distortion (Settings.h); here each camera's own distortion is read, and the exporter states the
// resulting error.
#include "core/foreign/opencv_file.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"
#include "core/format/intrinsics_yaml.h"

namespace evical {
namespace {

double orbSlam3AsFloat(const OpencvNode& node) {
  return static_cast<double>(static_cast<float>(node.number()));
}

std::vector<double> orbSlam3NumbersOf(const OpencvFile& file, const std::string& camera,
                                      std::initializer_list<const char*> keys) {
  std::vector<double> values;
  for (const char* key : keys) values.push_back(orbSlam3AsFloat(file[camera + "." + key]));
  return values;
}

// `camera`: "Camera1", "Camera2", or "Camera" in files of ORB-SLAM2, which may omit the type.
CameraIntrinsics orbSlam3LensOf(const OpencvFile& file, const std::string& camera, Resolution size) {
  const bool is_named = camera != "Camera" || file.has("Camera.type");
  const std::string type = is_named ? file["Camera.type"].text() : "PinHole";
  const std::vector<double> k = orbSlam3NumbersOf(file, camera, {"fx", "fy", "cx", "cy"});
  if (type == "KannalaBrandt8") {
    return lensFrom(CameraModel::PinholeEquidistant, k,
                    orbSlam3NumbersOf(file, camera, {"k1", "k2", "k3", "k4"}), size);
  }
  if (type != "PinHole") file["Camera.type"].fail("must be PinHole or KannalaBrandt8");
  // Settings of images without distortion may omit it.
  std::vector<double> distortion(4);
  if (file.has(camera + ".k1")) distortion = orbSlam3NumbersOf(file, camera, {"k1", "k2", "p1", "p2"});
  const std::string third = camera + ".k3";
  if (file.has(third)) distortion.push_back(orbSlam3AsFloat(file[third]));
  return lensFrom(CameraModel::PinholeRadtan, k, distortion, size);
}

RigidTransform orbSlam3PoseOf(const OpencvFile& file, const char* key) {
  const OpencvNode node = file[key];
  return rigidFrom(node.matrix(4, 4, "f"), node.place());
}

void askOrbSlam3ForOwnKeys(const OpencvFile& file) {
  for (const char* key : {"Camera.fps", "Camera.RGB", "ORBextractor.nFeatures", "ORBextractor.nLevels",
                          "ORBextractor.iniThFAST", "ORBextractor.minThFAST"})
    file[key].integer();
  for (const char* key :
       {"ORBextractor.scaleFactor", "Viewer.KeyFrameSize", "Viewer.KeyFrameLineWidth",
        "Viewer.GraphLineWidth", "Viewer.PointSize", "Viewer.CameraSize", "Viewer.CameraLineWidth",
        "Viewer.ViewpointX", "Viewer.ViewpointY", "Viewer.ViewpointZ", "Viewer.ViewpointF"})
    file[key].number();
  if (file.has("IMU.InsertKFsWhenLost")) file["IMU.InsertKFsWhenLost"].integer();
}

ReadImu orbSlam3ImuOf(const OpencvFile& file) {
  ReadImu imu;
  imu.noise = {orbSlam3AsFloat(file["IMU.NoiseGyro"]), orbSlam3AsFloat(file["IMU.NoiseAcc"]),
               orbSlam3AsFloat(file["IMU.GyroWalk"]), orbSlam3AsFloat(file["IMU.AccWalk"])};
  imu.rate_hz = orbSlam3AsFloat(file["IMU.Frequency"]);
  return imu;
}

Resolution orbSlam3SizeOf(const OpencvFile& file) {
  return {file["Camera.width"].integer(), file["Camera.height"].integer()};
}

// `side`: "LEFT" or "RIGHT" of stereo settings before ORB-SLAM3 1.0.
ReadCamera orbSlam2CameraOf(const OpencvFile& file, const std::string& side) {
  const OpencvNode matrix = file[side + ".K"];
  const auto k = cameraMatrixNumbers(matrix.matrixNumbers(), matrix.place());
  const std::vector<double> d = file[side + ".D"].matrixNumbers();
  const bool fisheye = file.has("Camera.type") && file["Camera.type"].text() == "KannalaBrandt8";
  if (!fisheye && d.size() == 4)
    file[side + ".D"].fail("fits two lens models: four numbers without Camera.type");
  if (fisheye ? d.size() != 4 : d.size() != 5)
    file[side + ".D"].fail("must have five numbers, or four for a fisheye lens");
  ReadCamera camera;
  camera.name = side;
  camera.lens =
      lensFrom(fisheye ? CameraModel::PinholeEquidistant : CameraModel::PinholeRadtan, {k.begin(), k.end()},
               d, {file[side + ".width"].integer(), file[side + ".height"].integer()});
  return camera;
}

}  // namespace

ReadFile readOrbSlam3File(const std::filesystem::path& path) {
  const OpencvFile file(path);
  ReadFile read{path};
  for (const char* side : {"LEFT", "RIGHT"})
    if (file.has(std::string(side) + ".K")) read.cameras.push_back(orbSlam2CameraOf(file, side));
  if (!read.cameras.empty()) return read;  // then Camera.* is the rectified camera
  const Resolution size = file.has("Camera.width") ? orbSlam3SizeOf(file) : Resolution{};
  if (file.has("IMU.NoiseGyro")) read.imus.emplace_back();  // a note states that it is not imported
  for (const char* camera : {"Camera", "Camera1", "Camera2"}) {
    if (!file.has(std::string(camera) + ".fx")) continue;
    ReadCamera& found = read.cameras.emplace_back();
    found.name = camera;
    found.lens = orbSlam3LensOf(file, camera, size);
    if (file.has("IMU.T_b_c1") || file.has("Tbc")) found.frame_from_camera = RigidTransform{};
  }
  return read;
}

ReadBack readOrbSlam3(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "settings.yaml";
  const OpencvFile file(path);
  ReadBack read;
  read.max_cameras = 2;
  read.max_imus = 1;
  ReadFile settings{path};
  settings.rounding = kFloatRounding;
  if (file["File.version"].text() != "1.0")
    file["File.version"].fail("must be 1.0, or older settings are expected");
  askOrbSlam3ForOwnKeys(file);
  // Checks the modes for which the file has data.
  const bool stereo = file.has("Camera2.fx"), inertial = file.has("IMU.NoiseGyro");
  settings.about_first_camera = !inertial;
  const Resolution size = orbSlam3SizeOf(file);
  if (stereo && file["Camera.type"].text() == "KannalaBrandt8")
    for (const char* camera : {"Camera1", "Camera2"})
      for (const char* key : {".overlappingBegin", ".overlappingEnd"})
        file[std::string(camera) + key].integer();
  ReadCamera first;
  first.lens = orbSlam3LensOf(file, "Camera1", size);
  first.frame_from_camera = RigidTransform{};
  if (inertial) {
    first.frame_from_camera = orbSlam3PoseOf(file, "IMU.T_b_c1");
    settings.imus.push_back(orbSlam3ImuOf(file));
  }
  settings.cameras.push_back(first);
  if (stereo) {
    file["Stereo.ThDepth"].number();
    ReadCamera second;
    second.lens = orbSlam3LensOf(file, "Camera2", size);
    second.frame_from_camera = *first.frame_from_camera * orbSlam3PoseOf(file, "Stereo.T_c1_c2");
    settings.cameras.push_back(second);
  }
  read.files.push_back(std::move(settings));
  return read;
}

}  // namespace evical
