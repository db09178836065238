// Numbers, matrices, comments and strings in a form that YAML and JSON readers of other programs accept.
#pragma once

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <string>
#include <string_view>
#include <vector>

namespace evical {

// Shortest text that reads back as the same number, always with a decimal point: YAML 1.1 reads 1e-05 as
// a string, and OpenCV reads 0 as an integer. Throws as throwNotFinite: other programs' parsers differ in
// what they accept as NaN or infinity.
std::string real(double value);

// Throws CalibrationError (BadInput).
[[noreturn]] void throwNotFinite(const std::string& place);

std::string realList(const std::vector<double>& values);  // "1.0, 2.0"
std::string realList(const Eigen::VectorXd& values);

// All elements row by row: "1.0, 0.0, ..."
std::string rowMajor(const Eigen::MatrixXd& matrix);

// One line per row, each indented by `indent` blanks: "- [1.0, 0.0]"
std::string rowsYaml(const Eigen::MatrixXd& matrix, int indent);

// OpenCV FileStorage's matrix in YAML; dt "d" (double) or "f".
std::string opencvMatrix(const char* key, const Eigen::MatrixXd& matrix, char dt);

// {rows, cols, data} as ROS and SVO write it, each line indented by `indent` blanks.
std::string dataMatrix(const Eigen::MatrixXd& matrix, int indent);

// The languages of exported files. These two functions write every comment, and every text that is not
// Evical's own: a sensor's name or a reason may come from a stranger's file, and must not become code.
// Control characters become escapes (plain_text.h): which of them end a line depends on the language.
enum class Language { Yaml, Json, Xml, Shell, Python, Matlab, Text };

// Each line as a comment; in Language::Text it has no mark. Lines end at '\n'. JSON has no comments.
std::string commentIn(Language language, std::string_view lines);

// A string, with quotes where the language requires them.
std::string stringIn(Language language, std::string_view text);

// Parts of ROS files, which other programs also read.

Eigen::Matrix3d cameraMatrix(const CameraIntrinsics& camera);

// R = Rz(yaw) Ry(pitch) Rx(roll), about fixed axes, as in URDF and tf. If pitch is +-90 degrees, roll and yaw
// rotate about the same axis: roll is 0 then.
Eigen::Vector3d rollPitchYaw(const Eigen::Matrix3d& rotation);

// Keys from image_width to distortion_coefficients; plumb_bob has 5 coefficients, in some readers 4.
std::string cameraInfoBody(const std::string& name, const CameraIntrinsics& camera, int radtan_coefficients);

// A whole camera_info file. ROS supports pinhole models only: other lenses are refitted, and a comment states
// the error.
std::string cameraInfoYaml(const std::string& name, const CameraIntrinsics& camera);

}  // namespace evical
