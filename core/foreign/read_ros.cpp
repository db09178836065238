// Source: ros-perception/image_common, camera_calibration_parsers/src/parse_yml.cpp (at 00bed63:
// readCalibrationYml); ros2/geometry2, tf2_ros/src/static_transform_broadcaster_program.cpp (at 04e7636:
// parse_args), which launch files of ROS 2 also start; ros/geometry2's program of that name, which ROS 1
// calls with nine arguments; and ros/urdfdom, urdf_parser/src/model.cpp and joint.cpp (at 02a883b: parseURDF,
// parseJoint).
#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/number.h"
#include "core/foreign/read_numbers.h"
#include "core/foreign/readers.h"
#include "core/foreign/xml_element.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>
#include <sstream>

namespace evical {
namespace {

ReadFile readCameraInfo(const std::filesystem::path& path) {
  const YamlNode root = YamlNode::load(path);
  constexpr int kLargest_px = 100000;
  const Resolution size{root["image_width"].integer(1, kLargest_px),
                        root["image_height"].integer(1, kLargest_px)};
  const Eigen::Matrix3d k = matrixOf(root["camera_matrix"], 3, 3);
  const Eigen::Matrix3d rectification = matrixOf(root["rectification_matrix"], 3, 3);
  const Eigen::MatrixXd projection = matrixOf(root["projection_matrix"], 3, 4);
  // image_geometry interprets the pixels of a single camera in that camera's frame.
  if (rectification != Eigen::Matrix3d::Identity())
    throw root["rectification_matrix"].error("must be the identity");
  if (projection.leftCols<3>() != k) throw root["projection_matrix"].error("must contain the camera_matrix");
  // plumb_bob has 5 coefficients in image_geometry, equidistant 4.
  const bool radtan = root["distortion_model"].choice({"plumb_bob", "equidistant"}) == 0;
  const YamlNode node = root["distortion_coefficients"];
  const std::size_t count = static_cast<std::size_t>(node["rows"].integer(1, 1) * node["cols"].integer(4, 5));
  if (count != (radtan ? 5U : 4U)) throw node["cols"].error("does not match the distortion_model");
  ReadCamera camera;
  camera.name = root["camera_name"].text();
  camera.lens = lensFrom(radtan ? CameraModel::PinholeRadtan : CameraModel::PinholeEquidistant,
                         {k(0, 0), k(1, 1), k(0, 2), k(1, 2)}, node["data"].reals(count), size);
  return {path, {camera}};
}

// Pose of the frame `child` in the frame `parent`.
struct Placed {
  std::string parent, child;
  RigidTransform parent_from_child;
};

// The parent is either the reference IMU or the optical frame of the first camera.
ReadFile filePlacing(const std::filesystem::path& path, const std::vector<Placed>& all) {
  const std::string kOptical = "_optical_frame";
  ReadFile file{path};
  const auto camera = [&](const std::string& frame, const RigidTransform& pose) {
    ReadCamera read;
    read.name = frame.substr(0, frame.size() - kOptical.size());
    read.frame_from_camera = pose;
    file.cameras.push_back(read);
  };
  for (const Placed& placed : all) {
    if (placed.parent != all.front().parent)
      throw badInput(path.string(),
                     fmt::format("{} and {} have different parent frames", all.front().child, placed.child));
    if (&placed == &all.front() && placed.parent.ends_with(kOptical)) {
      file.about_first_camera = true;
      camera(placed.parent, {});
    }
    if (placed.child.ends_with(kOptical)) {
      camera(placed.child, placed.parent_from_child);
    } else {
      ReadImu imu;
      imu.name = placed.child;
      imu.reference_from_imu = placed.parent_from_child;
      file.imus.push_back(imu);
    }
  }
  if (!file.about_first_camera && !all.empty()) {
    ReadImu reference;
    reference.name = all.front().parent;
    file.imus.push_back(reference);
  }
  return file;
}

double numberOf(const std::string& text, const std::string& place) {
  const std::optional<double> value = realFrom(text);
  if (!value) throw badInput(place, fmt::format("'{}' is not a number", text));
  return *value;
}

// One call of static_transform_publisher; the words before it are those of ros2 run.
Placed placedBy(const std::vector<std::string>& words, const std::string& place) {
  std::map<std::string, std::string> values{{"--frame-id", ""}, {"--child-frame-id", ""}};
  constexpr std::array kNumbers{"--x", "--y", "--z", "--qx", "--qy", "--qz", "--qw"};
  for (const char* number : kNumbers) values[number];
  for (std::size_t i = 0; i < words.size(); i += 2) {
    const auto found = values.find(words[i]);
    if (found == values.end())
      throw badInput(place, fmt::format("'{}' is not an option of static_transform_publisher", words[i]));
    if (i + 1 == words.size()) throw badInput(place, fmt::format("'{}' has no value", words[i]));
    found->second = words[i + 1];
  }
  const auto number = [&](const char* key) {
    return numberOf(values[key], fmt::format("{}: {}", place, key));
  };
  Placed placed{values["--frame-id"], values["--child-frame-id"], {}};
  if (placed.parent.empty() || placed.child.empty())
    throw badInput(place, "lacks --frame-id or --child-frame-id");
  placed.parent_from_child = {{number("--qw"), number("--qx"), number("--qy"), number("--qz")},
                              {number("--x"), number("--y"), number("--z")}};
  constexpr double kUnit = 1e-9;
  if (std::abs(placed.parent_from_child.rotation.norm() - 1.0) > kUnit)
    throw badInput(place, "does not have a unit quaternion");
  return placed;
}

ReadFile readTransforms(const std::filesystem::path& path) {
  const std::string program = "ros2 run tf2_ros static_transform_publisher ";
  std::istringstream text(textOf(path));
  std::vector<Placed> all;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    const std::string place = fmt::format("{} (line {})", path.string(), number);
    if (line.empty() || line.starts_with('#') || line == "wait") continue;
    if (!line.starts_with(program) || !line.ends_with(" &"))
      throw badInput(place, "is not a call of static_transform_publisher in the background");
    std::istringstream arguments(line.substr(program.size(), line.size() - program.size() - 2));
    std::vector<std::string> words;
    for (std::string word; arguments >> word;) words.push_back(word);
    all.push_back(placedBy(words, place));
  }
  if (all.empty()) throw badInput(path.string(), "publishes nothing");
  return filePlacing(path, all);
}

// ROS 1 identifies numbers and frames by their order.
ReadFile readLaunch(const std::filesystem::path& path) {
  const XmlElement launch = readXml(path);
  if (launch.name != "launch") throw badInput(path.string(), "has no launch element");
  std::vector<Placed> all;
  std::set<std::string> names;
  for (const XmlElement* node : launch.all("node")) {
    if (node->attribute("pkg") != "tf2_ros" || node->attribute("type") != "static_transform_publisher")
      throw badInput(node->place, "starts another program");
    if (!names.insert(node->attribute("name")).second)
      throw badInput(node->place, "has a name that occurs twice");
    std::istringstream arguments(node->attribute("args"));
    std::vector<std::string> words;
    for (std::string word; arguments >> word;) words.push_back(word);
    constexpr std::array kOrder{
        "--x", "--y", "--z", "--qx", "--qy", "--qz", "--qw", "--frame-id", "--child-frame-id"};
    if (words.size() != kOrder.size()) throw badInput(node->place, "does not have nine args");
    std::vector<std::string> named;
    for (std::size_t i = 0; i < words.size(); ++i) {
      named.emplace_back(kOrder[i]);
      named.push_back(words[i]);
    }
    all.push_back(placedBy(named, node->place));
  }
  if (all.empty()) throw badInput(path.string(), "publishes nothing");
  return filePlacing(path, all);
}

// Reads the arguments of the nodes in the Python code of a launch file.
ReadFile readPythonLaunch(const std::filesystem::path& path) {
  const std::string text = textOf(path), opening = "arguments=['", closing = "'])";
  if (text.find("def generate_launch_description():\n") == std::string::npos || !text.ends_with("\n    ])\n"))
    throw badInput(path.string(), "is not a complete launch description");
  std::vector<Placed> all;
  for (std::size_t at = text.find(opening); at != std::string::npos; at = text.find(opening, at)) {
    at += opening.size();
    const std::size_t end = text.find(closing, at);
    if (end == std::string::npos) throw badInput(path.string(), "has an unterminated list of arguments");
    std::vector<std::string> words;
    const std::string list = text.substr(at, end - at), between = "', '";
    for (std::size_t word = 0; word <= list.size();) {
      const std::size_t next = std::min(list.find(between, word), list.size());
      words.push_back(list.substr(word, next - word));
      word = next + between.size();
    }
    all.push_back(placedBy(words, fmt::format("{}: node {}", path.string(), all.size() + 1)));
  }
  if (all.empty()) throw badInput(path.string(), "publishes nothing");
  return filePlacing(path, all);
}

Eigen::Vector3d threeNumbers(const std::string& text, const std::string& place) {
  std::istringstream words(text);
  std::vector<double> values;
  for (std::string word; words >> word;) values.push_back(numberOf(word, place));
  if (values.size() != 3) throw badInput(place, "must have three numbers");
  return {values[0], values[1], values[2]};
}

// Fixed axes: roll about x, then pitch about y, then yaw about z.
RigidTransform originOf(const XmlElement& joint) {
  const XmlElement& origin = joint.one("origin");
  const Eigen::Vector3d rpy = threeNumbers(origin.attribute("rpy"), origin.place);
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()));
  return {rotation, threeNumbers(origin.attribute("xyz"), origin.place)};
}

ReadFile readUrdf(const std::filesystem::path& path) {
  const XmlElement robot = readXml(path);
  if (robot.name != "robot") throw badInput(path.string(), "has no robot element");
  robot.attribute("name");
  std::set<std::string> links, joints, children;
  for (const XmlElement* link : robot.all("link"))
    if (!links.insert(link->attribute("name")).second) throw badInput(link->place, "occurs twice");
  std::vector<Placed> all;
  for (const XmlElement* joint : robot.all("joint")) {
    if (!joints.insert(joint->attribute("name")).second) throw badInput(joint->place, "occurs twice");
    if (joint->attribute("type") != "fixed") throw badInput(joint->place, "must be fixed");
    Placed placed{joint->one("parent").attribute("link"), joint->one("child").attribute("link"),
                  originOf(*joint)};
    for (const std::string& link : {placed.parent, placed.child})
      if (!links.contains(link)) throw badInput(joint->place, fmt::format("there is no link {}", link));
    if (!children.insert(placed.child).second) throw badInput(joint->place, "its child has two parents");
    all.push_back(placed);
  }
  if (links.size() != children.size() + 1) throw badInput(robot.place, "its links do not have a single root");
  return filePlacing(path, all);
}

}  // namespace

ReadBack readRos(const std::filesystem::path& folder) {
  ReadBack read;
  for (const std::filesystem::path& path : filesLike(folder, "", ".yaml"))
    read.files.push_back(readCameraInfo(path));
  if (read.files.size() == 1 && !pathExists(folder / "rig.urdf")) return read;
  read.files.push_back(readTransforms(folder / "static_transforms.sh"));
  read.files.push_back(readLaunch(folder / "static_transforms.launch"));
  read.files.push_back(readPythonLaunch(folder / "static_transforms.launch.py"));
  read.files.push_back(readUrdf(folder / "rig.urdf"));
  return read;
}

}  // namespace evical
