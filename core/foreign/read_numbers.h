// Shared functions of readers: numbers, matrices and poses from YAML.
#pragma once

#include "core/base/yaml_node.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/so3.h"

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// Throws CalibrationError (BadInput) if it does not exist, or is not a regular file of limited size.
std::string textOf(const std::filesystem::path& file);

// Files of the folder with this prefix and suffix ("input-", ".yaml"), by name.
std::vector<std::filesystem::path> filesLike(const std::filesystem::path& folder,
                                             const std::string& beginning, const std::string& ending);

// a_from_b of a matrix of 3 or 4 rows; `place` names file and key. Throws CalibrationError (BadInput) if its
// rotation has an error of more than 1e-5, or its last row is not 0 0 0 1.
RigidTransform rigidFrom(const Eigen::MatrixXd& matrix, const std::string& place);

Eigen::MatrixXd matrixFrom(const std::vector<double>& row_major, Eigen::Index rows, Eigen::Index cols);

// A list of rows; throws if the number of rows, or of a row's numbers, is different.
Eigen::MatrixXd rowsOf(const YamlNode& node, std::size_t rows, std::size_t cols);

// A map of rows, cols and data, as in ROS and SVO; throws if it has another shape.
Eigen::MatrixXd matrixOf(const YamlNode& node, int rows, int cols);

// True for a whole number of pixels that an image may have.
bool isSide_px(double side_px);

// fx fy cx cy, and distortion in the order of CameraIntrinsics.
CameraIntrinsics lensFrom(CameraModel model, const std::vector<double>& fx_fy_cx_cy,
                          const std::vector<double>& distortion, Resolution resolution_px);

}  // namespace evical
