#include "core/export/pose_text.h"

#include "core/base/plain_text.h"
#include "core/export/export_text.h"
#include "core/export/rig.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/report/result_table.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <vector>

namespace evical {
namespace {

std::string wordsOf(const Eigen::Vector3d& v) {
  return realList(Eigen::VectorXd(v));
}

std::vector<double> xyzw(const SensorPose& pose) {
  const Eigen::Quaterniond& q = pose.reference_from_sensor.rotation;
  return {q.x(), q.y(), q.z(), q.w()};
}

// A variable's name: letters, digits and underscores, no leading digit.
std::string identifier(const std::string& name) {
  std::string text;
  for (const char letter : name) text += std::isalnum(static_cast<unsigned char>(letter)) != 0 ? letter : '_';
  return text.empty() || std::isdigit(static_cast<unsigned char>(text[0])) != 0 ? "_" + text : text;
}

std::string variable(const SensorPose& pose) {
  return identifier(pose.reference) + "_from_" + identifier(pose.sensor);
}

std::string offsetWords(const SensorPose& pose) {
  return fmt::format("t_{} = t_{} + {} s", pose.reference, pose.sensor, real(pose.time_offset_s));
}

std::string matrixRows(const Eigen::Matrix4d& matrix, const char* before, const char* after) {
  std::string text;
  for (Eigen::Index row = 0; row < 4; ++row)
    text += fmt::format("{}{}{}\n", before, realList(Eigen::VectorXd(matrix.row(row))), after);
  return text;
}

std::string plainText(const SensorPose& pose) {
  const RigidTransform& place = pose.reference_from_sensor;
  const Eigen::Vector3d angles_deg = rollPitchYaw_deg(place.rotation);
  const std::string warning = anglesWarning(angles_deg);
  return fmt::format(
      "Pose of {} in {}: {}\ntranslation t (mm): {}\nrotation vector (deg): {}\n"
      "roll, pitch, yaw (deg): {}{}\nquaternion (x, y, z, w): {}\n4x4 matrix (m):\n{}time: {}\n",
      pose.sensor, pose.reference, directionWords(pose), wordsOf(1e3 * place.translation_m),
      wordsOf(kDegPerRad * quaternionLog(place.rotation)), wordsOf(angles_deg),
      warning.empty() ? "" : " (" + warning + ")", realList(xyzw(pose)),
      matrixRows(matrixOf(place), "  ", ""), offsetWords(pose));
}

// Keys of result.yaml.
std::string yaml(const SensorPose& pose) {
  return fmt::format(
      "{}:  # {}\n  reference: {}\n  rotation_xyzw: [{}]\n  translation_m: [{}]\n  matrix:\n{}"
      "  time_offset_s: {}  # {}\n",
      stringIn(Language::Yaml, pose.sensor), directionWords(pose), stringIn(Language::Yaml, pose.reference),
      realList(xyzw(pose)), wordsOf(pose.reference_from_sensor.translation_m),
      rowsYaml(matrixOf(pose.reference_from_sensor), 4), real(pose.time_offset_s), offsetWords(pose));
}

std::string numpy(const SensorPose& pose) {
  return fmt::format("# {}, metres\n{} = np.array([\n{}])\n# {}\n{}_time_offset_s = {}\n",
                     directionWords(pose), variable(pose),
                     matrixRows(matrixOf(pose.reference_from_sensor), "    [", "],"), offsetWords(pose),
                     identifier(pose.sensor), real(pose.time_offset_s));
}

std::string eigen(const SensorPose& pose) {
  const RigidTransform& place = pose.reference_from_sensor;
  const Eigen::Quaterniond& q = place.rotation;
  return fmt::format(
      "// {}, metres\nconst Eigen::Isometry3d {} =\n    Eigen::Translation3d({}) *\n"
      "    Eigen::Quaterniond({});  // w, x, y, z\n// {}\nconst double {}_time_offset_s = {};\n",
      directionWords(pose), variable(pose), wordsOf(place.translation_m),
      realList(std::vector<double>{q.w(), q.x(), q.y(), q.z()}), offsetWords(pose), identifier(pose.sensor),
      real(pose.time_offset_s));
}

// Frame names of the exported files. ROS calls a camera's frame optical if z is forward and x to the right.
std::string rosFrame(const std::string& sensor, SensorPose::Kind kind) {
  std::string frame = sensor;
  for (char& letter : frame) {
    const bool plain =
        std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '-' || letter == '.';
    if (!plain) letter = '_';
  }
  return kind == SensorPose::Kind::Camera ? frame + "_optical_frame" : frame;
}

std::string rosPublisher(const SensorPose& pose) {
  const Eigen::Vector3d& t = pose.reference_from_sensor.translation_m;
  const auto q = xyzw(pose);
  return fmt::format(
      "# ROS 2, tf2_ros: {}. Time: {}\n"
      "ros2 run tf2_ros static_transform_publisher --x {} --y {} --z {} --qx {} --qy {} --qz {} --qw {} "
      "--frame-id {} --child-frame-id {}\n",
      directionWords(pose), offsetWords(pose), real(t.x()), real(t.y()), real(t.z()), real(q[0]), real(q[1]),
      real(q[2]), real(q[3]), rosFrame(pose.reference, pose.reference_kind),
      rosFrame(pose.sensor, pose.kind));
}

std::string rosMessage(const SensorPose& pose) {
  const Eigen::Vector3d& t = pose.reference_from_sensor.translation_m;
  const auto q = xyzw(pose);
  return fmt::format(
      "# geometry_msgs/msg/TransformStamped: {}. Time: {}\nheader:\n  frame_id: {}\nchild_frame_id: {}\n"
      "transform:\n  translation: {{x: {}, y: {}, z: {}}}\n  rotation: {{x: {}, y: {}, z: {}, w: {}}}\n",
      directionWords(pose), offsetWords(pose), rosFrame(pose.reference, pose.reference_kind),
      rosFrame(pose.sensor, pose.kind), real(t.x()), real(t.y()), real(t.z()), real(q[0]), real(q[1]),
      real(q[2]), real(q[3]));
}

// Kalibr's direction is the opposite, and its keys depend on the kind of sensor.
struct KalibrPart {
  const char *sensor, *key, *time_key;  // no time key: its cameras share their clock
  std::string from;
  RigidTransform sensor_from_other;
};

KalibrPart kalibrPart(const SensorPose& pose) {
  const RigidTransform sensor_from_reference = inverse(pose.reference_from_sensor);
  if (pose.kind == SensorPose::Kind::Imu)
    return {"imu", "T_i_b", "time_offset", pose.reference, sensor_from_reference};
  if (!pose.camera_from_camera_before)
    return {"cam", "T_cam_imu", "timeshift_cam_imu", pose.reference, sensor_from_reference};
  const std::string before = fmt::format("cam{}", pose.number - 1);
  return {"cam", "T_cn_cnm1", "", before, *pose.camera_from_camera_before};
}

std::string kalibr(const SensorPose& pose) {
  const KalibrPart part = kalibrPart(pose);
  std::string text = fmt::format("# {0}: {1} transforms points of {2} to {0}. {3}\n", pose.sensor, part.key,
                                 part.from, offsetWords(pose));
  if (pose.reference_kind == SensorPose::Kind::Imu)
    text +=
        "# IMU frames are those of the result; in exported files Kalibr's may be rotated relative to them.\n";
  text += fmt::format("{}{}:\n  {}:\n{}", part.sensor, pose.number, part.key,
                      rowsYaml(matrixOf(part.sensor_from_other), 4));
  if (*part.time_key != '\0') text += fmt::format("  {}: {}\n", part.time_key, real(pose.time_offset_s));
  return text;
}

constexpr std::array kForms{
    PoseForm{"text", "Text", "Vector, angles, quaternion and matrix, for people", plainText},
    PoseForm{"yaml", "YAML", "Quaternion, translation and matrix, with the keys of result.yaml", yaml},
    PoseForm{"numpy", "NumPy", "A 4x4 array for Python", numpy},
    PoseForm{"eigen", "C++ (Eigen)", "An Isometry3d for C++", eigen},
    PoseForm{"ros", "ROS 2 (static_transform_publisher)", "A command that publishes the transform",
             rosPublisher},
    PoseForm{"ros-message", "ROS (TransformStamped)", "The message of tf2, as YAML", rosMessage},
    PoseForm{"kalibr", "Kalibr (T_cam_imu)", "The inverse, as a part of camchain-imucam.yaml", kalibr},
};

}  // namespace

std::span<const PoseForm> poseForms() {
  return kForms;
}

std::string poseText(const PoseForm& form, std::span<const SensorPose> poses) {
  std::string text;
  for (SensorPose pose : poses) {
    pose.sensor = printable(pose.sensor);
    pose.reference = printable(pose.reference);
    text += (text.empty() ? "" : "\n") + form.write(pose);
  }
  return text;
}

}  // namespace evical
