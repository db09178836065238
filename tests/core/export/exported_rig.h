// A rig with known parameters, and the difference between a camera as another program would read it and ours.
#pragma once

#include "core/export/export_target.h"

#include <yaml-cpp/yaml.h>
#include <Eigen/Core>

#include <functional>
#include <string>
#include <vector>

namespace evical::test {

struct RigKind {
  bool fisheye = false, third_radial = false, mapped = true, inertial = true;
  int cameras = 2;
  int frames = 0;  // frame cameras, behind the others, as far from each other
};
// Offsets are whole microseconds, since some formats store no more.
NamedResult rig(const RigKind& kind);

using Lens = std::function<Eigen::Vector2d(const Eigen::Vector3d& point_in_camera)>;

// OpenCV's projections, which share no code with ours. Radtan: k1 k2 p1 p2 [k3].
Lens radtanLens(const std::vector<double>& fx_fy_cx_cy, const std::vector<double>& distortion);
Lens fisheyeLens(const std::vector<double>& fx_fy_cx_cy, const std::vector<double>& distortion);

// A camera as a program interprets a file. Its IMU's frame may differ from ours.
struct ReadCamera {
  Eigen::Matrix4d camera_from_imu;
  double time_offset_s = 0.0;  // t_imu = t_camera + that
  Lens lens;
  Eigen::Matrix3d their_imu_from_ours = Eigen::Matrix3d::Identity();
};

// Largest distance between a world point's pixel in our result and in theirs, over the image and two times of
// a swinging IMU.
double worstDifference_px(const NamedResult& result, std::size_t camera, const ReadCamera& theirs);

ExportedFiles exportTo(const NamedResult& result, const std::string& target);
bool hasNote(const ExportedFiles& exported, const char* part);  // the note that contains this text

// Content of an exported file.
std::string contentOf(const ExportedFiles& exported, const std::string& path);
// Parsed, without OpenCV's %YAML:1.0 line.
YAML::Node yamlOf(const ExportedFiles& exported, const std::string& path);

// "cam" and 1: "cam1". (GCC 12 warns of a literal + std::string.)
std::string numbered(const char* prefix, Eigen::Index number, const char* suffix = "");

std::vector<double> numbers(const YAML::Node& list);  // also of strings
Eigen::MatrixXd matrix(const std::vector<double>& row_major, int rows, int cols);
Eigen::MatrixXd rowsMatrix(const YAML::Node& rows);
Eigen::MatrixXd dataMatrix(const YAML::Node& map);  // rows, cols, data
Eigen::Matrix4d pose(const Eigen::MatrixXd& three_or_four_rows);

}  // namespace evical::test
