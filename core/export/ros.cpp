#include "core/export/distortion_fit.h"
#include "core/export/export_text.h"
#include "core/export/exporters.h"
#include "core/geometry/lens_fit.h"
#include "core/geometry/sphere_lens.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>
#include <utility>

namespace evical {

std::string cameraInfoBody(const std::string& name, const CameraIntrinsics& camera, int radtan_coefficients) {
  const bool radtan = camera.model == CameraModel::PinholeRadtan;
  return fmt::format(
      "image_width: {}\nimage_height: {}\ncamera_name: {}\ncamera_matrix:\n{}distortion_model: {}\n"
      "distortion_coefficients:\n  rows: 1\n  cols: {}\n  data: [{}]\n",
      camera.resolution_px.width_px, camera.resolution_px.height_px, stringIn(Language::Yaml, name),
      dataMatrix(cameraMatrix(camera), 2), radtan ? "plumb_bob" : "equidistant",
      radtan ? radtan_coefficients : 4, realList(distortionOf(camera, radtan ? radtan_coefficients : 4)));
}

Eigen::Matrix3d cameraMatrix(const CameraIntrinsics& camera) {
  Eigen::Matrix3d k = Eigen::Matrix3d::Identity();
  k.diagonal().head<2>() = camera.focal_length_px;
  k.topRightCorner<2, 1>() = camera.principal_point_px;
  return k;
}

Eigen::Vector3d rollPitchYaw(const Eigen::Matrix3d& r) {
  const double cosine = std::hypot(r(0, 0), r(1, 0));
  const double pitch = std::atan2(-r(2, 0), cosine);
  if (cosine < 1e-12) return {0.0, pitch, std::atan2(-r(0, 1), r(1, 1))};
  return {std::atan2(r(2, 1), r(2, 2)), pitch, std::atan2(r(1, 0), r(0, 0))};
}

namespace {

// A placed sensor: the frame `child` in the frame `parent`.
struct Joint {
  std::string parent, child;
  RigidTransform parent_from_child;
};

std::vector<Joint> jointsOf(const Rig& rig) {
  const auto optical = [](const RigCamera& camera) { return camera.file_name + "_optical_frame"; };
  const bool inertial = !rig.imus.empty();
  const std::string base = inertial ? rig.imus[0].file_name : optical(rig.cameras[0]);
  std::vector<Joint> joints;
  for (const RigCamera& camera : rig.cameras)
    if (optical(camera) != base) {
      const RigidTransform base_from_camera =
          inertial ? camera.reference_from_camera
                   : inverse(rig.cameras[0].reference_from_camera) * camera.reference_from_camera;
      joints.push_back({base, optical(camera), base_from_camera});
    }
  for (std::size_t i = 1; i < rig.imus.size(); ++i)
    joints.push_back({base, rig.imus[i].file_name, rig.imus[i].state.reference_from_imu});
  return joints;
}

std::string offsetsComment(const Rig& rig) {
  std::string text = "ROS messages do not contain time offsets; t_reference = t_sensor + offset:";
  for (const RigCamera& camera : rig.cameras)
    text += fmt::format(" {} {} s", camera.file_name, real(camera.time_offset_s));
  for (std::size_t i = 1; i < rig.imus.size(); ++i)
    text += fmt::format(" {} {} s", rig.imus[i].file_name, real(rig.imus[i].state.time_offset_s));
  return text;
}

// Flags of ROS 2 since Humble; ROS 1 expects the values in this order without flags.
constexpr std::array kRos2Flags{
    "--x", "--y", "--z", "--qx", "--qy", "--qz", "--qw", "--frame-id", "--child-frame-id"};

// x y z qx qy qz qw frame child, each after its flag if there are flags.
std::vector<std::string> poseArguments(const Joint& joint, std::span<const char* const> flags) {
  const Eigen::Vector3d& p = joint.parent_from_child.translation_m;
  const Eigen::Quaterniond& q = joint.parent_from_child.rotation;
  std::vector<std::string> values;
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) values.push_back(real(value));
  values.push_back(joint.parent);
  values.push_back(joint.child);
  std::vector<std::string> arguments;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!flags.empty()) arguments.emplace_back(flags[i]);
    arguments.push_back(std::move(values[i]));
  }
  return arguments;
}

std::string joined(Language language, const std::vector<std::string>& texts, const char* between) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : between) + stringIn(language, text);
  return all;
}

std::string tf2Script(const Rig& rig, const std::vector<Joint>& joints) {
  std::string text =
      "#!/bin/sh\n" + headerComment(rig,
                                    {"The pose of the child in the frame: transforms points of the child to "
                                     "the frame. z of optical frames is forward.",
                                     offsetsComment(rig)},
                                    Language::Shell);
  for (const Joint& joint : joints)
    text += fmt::format("ros2 run tf2_ros static_transform_publisher {} &\n",
                        joined(Language::Shell, poseArguments(joint, kRos2Flags), " "));
  return text + "wait\n";
}

std::string launchRos1(const Rig& rig, const std::vector<Joint>& joints) {
  std::string text =
      "<?xml version=\"1.0\"?>\n" +
      headerComment(rig,
                    {"ROS 1, tf2_ros: x y z qx qy qz qw frame child. The pose transforms points of the child "
                     "to the frame.",
                     offsetsComment(rig)},
                    Language::Xml) +
      "<launch>\n";
  for (std::size_t i = 0; i < joints.size(); ++i)
    text += fmt::format(
        "  <node pkg=\"tf2_ros\" type=\"static_transform_publisher\" name=\"static_transform_{}\" "
        "args={}/>\n",
        i + 1, stringIn(Language::Xml, joined(Language::Text, poseArguments(joints[i], {}), " ")));
  return text + "</launch>\n";
}

std::string launchRos2(const Rig& rig, const std::vector<Joint>& joints) {
  std::string text =
      headerComment(
          rig, {"ROS 2, tf2_ros. The pose transforms points of the child to the frame.", offsetsComment(rig)},
          Language::Python) +
      "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n\n\n"
      "def generate_launch_description():\n    return LaunchDescription([\n";
  for (std::size_t i = 0; i < joints.size(); ++i)
    text += fmt::format(
        "        Node(package='tf2_ros', executable='static_transform_publisher',\n"
        "             name='static_transform_{}',\n             arguments=[{}]),\n",
        i + 1, joined(Language::Python, poseArguments(joints[i], kRos2Flags), ", "));
  return text + "    ])\n";
}

std::string urdf(const Rig& rig, const std::vector<Joint>& joints) {
  const auto name = [](const std::string& text) { return stringIn(Language::Xml, text); };
  std::string text = "<?xml version=\"1.0\"?>\n" +
                     headerComment(rig,
                                   {"The origin of a joint transforms points of the child to the parent. Use "
                                    "it alone, or copy it into a robot's description.",
                                    offsetsComment(rig)},
                                   Language::Xml) +
                     fmt::format("<robot name=\"rig\">\n<link name={}/>\n", name(joints.front().parent));
  for (const Joint& joint : joints) {
    const Eigen::Vector3d rpy = rollPitchYaw(joint.parent_from_child.rotation.toRotationMatrix());
    const Eigen::Vector3d& p = joint.parent_from_child.translation_m;
    text += fmt::format(
        "<link name={0}/>\n<joint name={1} type=\"fixed\">\n  <parent link={2}/>\n  <child link={0}/>\n"
        "  <origin xyz=\"{3} {4} {5}\" rpy=\"{6} {7} {8}\"/>\n</joint>\n",
        name(joint.child), name(joint.parent + "_to_" + joint.child), name(joint.parent), real(p.x()),
        real(p.y()), real(p.z()), real(rpy.x()), real(rpy.y()), real(rpy.z()));
  }
  return text + "</robot>\n";
}

// ROS's model of a lens that is not a pinhole, with a comment that states it.
struct RosLens {
  CameraIntrinsics camera;
  std::string comment;
};
RosLens rosLens(const CameraIntrinsics& camera) {
  if (!isSphereModel(camera.model)) return {camera, {}};
  const LensFit fit = fitLens(camera, CameraModel::PinholeEquidistant, 4);
  return {fit.camera,
          fmt::format("# ROS does not support the model {}: refitted as equidistant{}, error {:.2g} px "
                      "RMS, {:.2g} px at most\n",
                      cameraModelName(camera.model), fit.whole_image ? "" : " up to 85 deg off the axis",
                      fit.rms_px, fit.worst_px)};
}

std::string cameraInfo(const std::string& name, const CameraIntrinsics& camera) {
  Eigen::Matrix<double, 3, 4> projection = Eigen::Matrix<double, 3, 4>::Zero();
  projection.leftCols<3>() = cameraMatrix(camera);
  return cameraInfoBody(name, camera, 5) + "rectification_matrix:\n" +
         dataMatrix(Eigen::Matrix3d::Identity(), 2) + "projection_matrix:\n" + dataMatrix(projection, 2);
}

}  // namespace

std::string cameraInfoYaml(const std::string& name, const CameraIntrinsics& camera) {
  const RosLens lens = rosLens(camera);
  return lens.comment + cameraInfo(name, lens.camera);
}

ExportedFiles exportRos(const NamedResult& result) {
  ExportedFiles exported;
  const Rig rig = rigOf(result);
  constexpr KnownModels kModels{"ROS", true, true, true};
  for (const RigCamera& camera : rig.cameras)
    exported.files.push_back(
        {camera.file_name + ".yaml",
         headerComment(rig, {"ROS camera_info of one camera. Its pose and its time offset: see "
                             "static_transforms.sh."}) +
             cameraInfo(camera.file_name, cameraFor(camera, kModels, exported.notes))});
  const std::vector<Joint> joints = jointsOf(rig);
  if (joints.empty()) return exported;
  exported.files.push_back({"static_transforms.sh", tf2Script(rig, joints)});
  exported.files.push_back({"static_transforms.launch", launchRos1(rig, joints)});
  exported.files.push_back({"static_transforms.launch.py", launchRos2(rig, joints)});
  exported.files.push_back({"rig.urdf", urdf(rig, joints)});
  for (const RigImu& imu : rig.imus) noteLostMapping(imu, "ROS", exported.notes);
  exported.notes.push_back(offsetsComment(rig));
  return exported;
}

}  // namespace evical
