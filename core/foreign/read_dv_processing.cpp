// Source: dv-processing: include/dv-processing/camera/calibration_set.hpp and
// camera/calibrations/camera_calibration.hpp, imu_calibration.hpp, stereo_calibration.hpp, of copies without
// a revision. A boost property tree, in which all values are texts; numbers are stored as floats; the
// sensors' order is used, not their keys.
#include "core/foreign/json_node.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

double dvProcessingAsFloat(const JsonNode& node) {
  return static_cast<double>(static_cast<float>(node.treeNumber()));
}

std::vector<double> floats(const JsonNode& node, std::size_t count) {
  std::vector<double> values = node.treeNumbers(count);
  for (double& value : values) value = static_cast<double>(static_cast<float>(value));
  return values;
}

RigidTransform dvProcessingPoseOf(const JsonNode& sensor) {
  const JsonNode node = sensor["transformationToC0"];
  return rigidFrom(matrixFrom(floats(node, 16), 4, 4), node.place());
}

void askDvProcessingCameraForOwnKeys(const JsonNode& node) {
  node["name"].treeText();
  node["position"].treeText();
  const std::string master = node["master"].treeText();
  if (master != "true" && master != "false") node["master"].fail("must be true or false");
  if (!node.has("metadata")) return;
  for (const char* key :
       {"patternType", "patternSize", "patternSpacing", "calibrationTime", "quality", "comment"})
    node["metadata"][key].treeText();
}

ReadCamera dvProcessingCameraOf(const JsonNode& node) {
  const std::string model = node["distortionModel"].treeText();
  const bool radtan = model == "radialTangential";
  if (!radtan && model != "equidistant")
    node["distortionModel"].fail("must be radialTangential or equidistant");
  const JsonNode coefficients = node["distortionCoefficients"];
  const std::size_t count = coefficients.items().size();
  if (count != 4 && (!radtan || count != 5))
    coefficients.fail("has another number of coefficients than the model");
  std::vector<double> k = floats(node["focalLength"], 2);
  const std::vector<double> principal = floats(node["principalPoint"], 2),
                            size = node["resolution"].treeNumbers(2);
  for (const double side : size)
    if (!(side >= 1.0 && side < 1e5) || side != std::floor(side))
      node["resolution"].fail("must be two whole numbers above 0");
  k.insert(k.end(), principal.begin(), principal.end());
  ReadCamera camera;
  camera.lens = lensFrom(radtan ? CameraModel::PinholeRadtan : CameraModel::PinholeEquidistant, k,
                         floats(coefficients, count), {static_cast<int>(size[0]), static_cast<int>(size[1])});
  return camera;
}

Eigen::Vector3d dvProcessingVectorOf(const JsonNode& node) {
  const std::vector<double> three = floats(node, 3);
  return {three[0], three[1], three[2]};
}

ReadImu dvProcessingImuOf(const JsonNode& node) {
  for (const char* key : {"omegaMax", "accMax", "omegaOffsetVar", "accOffsetVar"}) node[key].treeNumber();
  for (const char* key : {"calibrationTime", "comment"})
    if (node.has("metadata")) node["metadata"][key].treeText();
  ReadImu imu;
  imu.noise = {dvProcessingAsFloat(node["omegaNoiseDensity"]), dvProcessingAsFloat(node["accNoiseDensity"]),
               dvProcessingAsFloat(node["omegaNoiseRandomWalk"]),
               dvProcessingAsFloat(node["accNoiseRandomWalk"])};
  imu.gyroscope_bias_rad_s = dvProcessingVectorOf(node["omegaOffsetAvg"]);
  imu.accelerometer_bias_m_s2 = dvProcessingVectorOf(node["accOffsetAvg"]);
  return imu;
}

void checkStereo(const JsonNode& node, const std::vector<std::string>& names) {
  for (const char* key : {"leftCameraName", "rightCameraName"})
    if (std::find(names.begin(), names.end(), node[key].treeText()) == names.end())
      node[key].fail("is not the name of a camera");
  floats(node["fundamentalMatrix"], 9);
  floats(node["essentialMatrix"], 9);
  if (!node.has("metadata")) return;
  node["metadata"]["epipolarError"].treeNumber();
  node["metadata"]["comment"].treeText();
}

}  // namespace

ReadFile readDvProcessingFile(const std::filesystem::path& path) {
  ReadFile file{path};
  const JsonNode root = JsonNode::load(path);
  for (const auto& [key, node] : root["cameras"].entries()) {
    ReadCamera camera = dvProcessingCameraOf(node);
    camera.name = node.has("name") ? node["name"].treeText() : key;
    if (node.has("transformationToC0")) camera.frame_from_camera = inverse(dvProcessingPoseOf(node));
    file.cameras.push_back(std::move(camera));
  }
  if (root.has("imus")) file.imus.resize(root["imus"].entries().size());
  return file;
}

ReadBack readDvProcessing(const std::filesystem::path& folder) {
  ReadFile file{folder / "calibration.json"};
  const JsonNode root = JsonNode::load(file.path);
  if (root["version"].treeText() != "2.0") root["version"].fail("must be 2.0");
  file.rounding = kFloatRounding;
  file.about_first_camera = true;
  std::vector<std::string> names;
  for (const auto& [key, node] : root["cameras"].entries()) {
    askDvProcessingCameraForOwnKeys(node);
    file.cameras.push_back(dvProcessingCameraOf(node));
    file.cameras.back().frame_from_camera =
        inverse(dvProcessingPoseOf(node));  // camera 0 to this one, in the file
    names.push_back(node["name"].treeText());
  }
  if (root.has("imus"))
    for (const auto& [key, node] : root["imus"].entries()) {
      file.imus.push_back(dvProcessingImuOf(node));
      // getImuCalibrationByName is called with the camera's name.
      if (std::find(names.begin(), names.end(), node["name"].treeText()) == names.end())
        node["name"].fail("is not the name of a camera, which is its key");
      const RigidTransform imu_from_first = inverse(dvProcessingPoseOf(node));
      for (ReadCamera& camera : file.cameras)
        camera.frame_from_camera = imu_from_first * *camera.frame_from_camera;
      file.about_first_camera = false;
      // t_correct = t_imu - offset.
      file.cameras.front().time_offset_s = 1e-6 * static_cast<double>(node["timeOffsetMicros"].treeInteger());
      file.time_step_s = 1e-6;
    }
  if (root.has("stereo"))
    for (const auto& [key, node] : root["stereo"].entries()) checkStereo(node, names);
  ReadBack read;
  read.max_imus = 1;
  read.files = {file};
  return read;
}

}  // namespace evical
