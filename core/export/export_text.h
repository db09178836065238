// Numbers and matrices in a form that YAML and JSON readers of other programs accept.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical {

// Shortest text that reads back as the same number, always with a decimal point: YAML 1.1 reads 1e-05 as
// a string, and OpenCV reads 0 as an integer. Throws as throwNotFinite: other programs' parsers differ in what they
// accept as NaN or infinity.
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

// A JSON string with its quotes.
std::string jsonText(const std::string& text);

}  // namespace evical
