// Source: ethz-asl/kalibr, kalibr_common/ConfigReader.py (at 0b8b9e8; its check of eucm as in chengfzy/kalibr
// at 31a324b): CameraChainParameters of camchain.yaml and camchain-imucam.yaml, ImuParameters of the argument
// of --imu. imu.yaml has the keys of IccSensors.py's IccImu.ImuParameters, which writes such files. Kalibr
// parses with PyYAML, whose floats have a point, and requires floats.
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"

#include <fmt/format.h>

#include <regex>

namespace evical {
namespace {

// PyYAML's resolvers: 1e-05 is a string, 5 an int.
double pythonFloat(const YamlNode& node) {
  constexpr std::size_t kLongest = 100;  // the library's matching recurses over a text's length
  static const std::regex kFloat(R"([-+]?([0-9][0-9_]*)?\.[0-9_]*([eE][-+][0-9]+)?)");
  if (node.text().size() > kLongest || !std::regex_match(node.text(), kFloat))
    throw node.error(fmt::format("'{}' is not a float for Kalibr's YAML parser", node.text()));
  return node.real();
}

double pythonNumber(const YamlNode& node) {
  static const std::regex kInt("[-+]?[0-9]+");
  constexpr std::size_t kLongest = 100;
  return node.text().size() <= kLongest && std::regex_match(node.text(), kInt) ? node.real()
                                                                               : pythonFloat(node);
}

std::vector<double> pythonNumbers(const YamlNode& list, std::size_t count) {
  std::vector<double> values;
  for (const YamlNode& item : list.items()) values.push_back(pythonNumber(item));
  if (values.size() != count)
    throw list.error(fmt::format("has {} numbers, Kalibr requires {}", values.size(), count));
  return values;
}

Eigen::MatrixXd pythonRows(const YamlNode& node, std::size_t size) {
  std::vector<double> all;
  const std::vector<YamlNode> rows = node.items();
  if (rows.size() != size)
    throw node.error(fmt::format("has {} rows, Kalibr requires {}", rows.size(), size));
  for (const YamlNode& row : rows)
    for (const double value : pythonNumbers(row, size)) all.push_back(value);
  return matrixFrom(all, static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(size));
}

double positive(const YamlNode& node) {
  const double value = pythonNumber(node);
  if (!(value > 0.0)) throw node.error("must be above 0");
  return value;
}

struct Model {
  CameraModel model;
  std::size_t own;  // coefficients in front of the intrinsics
};

Model kalibrModelOf(const YamlNode& camera) {
  const std::size_t model = camera["camera_model"].choice({"pinhole", "omni", "eucm", "ds"});
  const std::size_t distortion = camera["distortion_model"].choice({"radtan", "equidistant", "none"});
  const bool fits = model == 0 ? distortion < 2 : model == 1 ? distortion == 0 : distortion == 2;
  if (!fits) throw camera["distortion_model"].error("does not match the camera_model");
  if (model == 0) return {distortion == 0 ? CameraModel::PinholeRadtan : CameraModel::PinholeEquidistant, 0};
  if (model == 1) return {CameraModel::OmniRadtan, 1};
  return {model == 2 ? CameraModel::Eucm : CameraModel::DoubleSphere, 2};
}

CameraIntrinsics kalibrLensOf(const YamlNode& camera) {
  const Model model = kalibrModelOf(camera);
  const YamlNode node = camera["intrinsics"];
  const std::vector<double> all = pythonNumbers(node, 4 + model.own);
  for (std::size_t i = model.own; i < all.size(); ++i) {
    pythonFloat(node.items()[i]);
    if (all[i] < 0.0) throw node.error("focal lengths and principal point must not be negative");
  }
  if (model.model == CameraModel::OmniRadtan && all[0] < 0.0) throw node.error("xi must not be negative");
  const bool eucm = model.model == CameraModel::Eucm;
  const double alpha = all[eucm ? 0 : 1];
  if (model.own == 2 && (alpha < 0.0 || alpha >= 1.0)) throw node.error("alpha must be in [0, 1)");
  if (eucm && all[1] < 0.0) throw node.error("beta must not be negative");
  const auto split = all.begin() + static_cast<std::ptrdiff_t>(model.own);
  std::vector<double> distortion(all.begin(), split);
  for (const double value : pythonNumbers(camera["distortion_coeffs"], model.own == 2 ? 0 : 4))
    distortion.push_back(value);
  const std::vector<YamlNode> size = camera["resolution"].items();
  if (size.size() != 2) throw camera["resolution"].error("must be [width, height]");
  constexpr int kLargest_px = 100000;
  return lensFrom(model.model, {split, all.end()}, distortion,
                  {size[0].integer(1, kLargest_px), size[1].integer(1, kLargest_px)});
}

// `inertial`: includes the keys that Kalibr adds in a calibration with IMUs.
ReadFile readKalibrChain(const std::filesystem::path& path, bool inertial) {
  const YamlNode root = YamlNode::load(path);
  ReadFile file{path, {}, {}, !inertial};
  const std::size_t count = root.keys().size();
  for (std::size_t i = 0; i < count; ++i) {
    const YamlNode node = root[fmt::format("cam{}", i)];
    ReadCamera camera;
    camera.lens = kalibrLensOf(node);
    node["rostopic"].text();
    for (const YamlNode& other : node["cam_overlaps"].items()) other.integer(0, static_cast<int>(count) - 1);
    if (inertial) {
      camera.frame_from_camera =
          inverse(rigidFrom(pythonRows(node["T_cam_imu"], 4), node["T_cam_imu"].place()));
      camera.time_offset_s = pythonFloat(node["timeshift_cam_imu"]);
    } else {
      camera.frame_from_camera = RigidTransform{};
      if (i > 0)
        camera.frame_from_camera =
            *file.cameras.back().frame_from_camera *
            inverse(rigidFrom(pythonRows(node["T_cn_cnm1"], 4), node["T_cn_cnm1"].place()));
    }
    file.cameras.push_back(camera);
  }
  return file;
}

ReadImu noiseOf(const YamlNode& node) {
  ReadImu imu;
  node["rostopic"].text();
  imu.rate_hz = positive(node["update_rate"]);
  imu.noise = {positive(node["gyroscope_noise_density"]), positive(node["accelerometer_noise_density"]),
               positive(node["gyroscope_random_walk"]), positive(node["accelerometer_random_walk"])};
  return imu;
}

ReadImu kalibrImuOf(const YamlNode& node) {
  ReadImu imu = noiseOf(node);
  imu.reference_from_imu = inverse(rigidFrom(pythonRows(node["T_i_b"], 4), node["T_i_b"].place()));
  imu.time_offset_s = pythonFloat(node["time_offset"]);
  imu.accelerometer = imu.gyroscope = Eigen::Matrix3d::Identity();
  if (node["model"].choice({"calibrated", "scale-misalignment"}) == 0) return imu;
  const auto lower = [](const YamlNode& m) {
    const Eigen::Matrix3d matrix = pythonRows(m, 3);
    if (Eigen::Vector3d(matrix(0, 1), matrix(0, 2), matrix(1, 2)) != Eigen::Vector3d::Zero())
      throw m.error("must be lower triangular");
    return matrix;
  };
  const YamlNode gyroscopes = node["gyroscopes"];
  if (pythonRows(gyroscopes["A"], 3) != Eigen::Matrix3d::Zero())
    throw gyroscopes["A"].error("is the g-sensitivity of a gyroscope, which is not supported");
  imu.accelerometer = lower(node["accelerometers"]["M"]);
  const YamlNode turn = gyroscopes["C_gyro_i"];
  Eigen::MatrixXd turn_pose = Eigen::MatrixXd::Zero(3, 4);
  turn_pose.leftCols<3>() = pythonRows(turn, 3);
  rigidFrom(turn_pose, turn.place());
  imu.gyroscope = lower(gyroscopes["M"]) * turn_pose.leftCols<3>();
  return imu;
}

}  // namespace

ReadBack readKalibr(const std::filesystem::path& folder) {
  ReadBack read;
  read.files.push_back(readKalibrChain(folder / "camchain.yaml", false));
  if (!pathExists(folder / "imu.yaml")) return read;
  read.files.push_back(readKalibrChain(folder / "camchain-imucam.yaml", true));
  ReadFile imus{folder / "imu.yaml"};
  const YamlNode root = YamlNode::load(imus.path);
  for (std::size_t i = 0; i < root.keys().size(); ++i)
    imus.imus.push_back(kalibrImuOf(root[fmt::format("imu{}", i)]));
  const std::vector<std::filesystem::path> inputs = filesLike(folder, "input-", ".yaml");
  if (inputs.size() < imus.imus.size())
    throw badInput(folder.string(),
                   fmt::format("has {} input-*.yaml for {} IMUs", inputs.size(), imus.imus.size()));
  read.files.push_back(std::move(imus));
  for (const std::filesystem::path& path : inputs) {
    ReadFile input{path, {}, {noiseOf(YamlNode::load(path))}};
    input.imus[0].name = path.stem().string().substr(std::string("input-").size());
    read.files.push_back(std::move(input));
  }
  return read;
}

}  // namespace evical
