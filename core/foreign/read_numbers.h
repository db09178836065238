// What readers of several programs share: numbers, matrices and poses out of YAML.
#pragma once

#include "core/base/yaml_node.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/rigid_transform.h"

#include <Eigen/Core>

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// Throws CalibrationError (BadInput) where it does not exist, or is no plain file of a size that texts have.
std::string textOf(const std::filesystem::path& file);

// Files of the folder with this beginning and this ending ("input-", ".yaml"), by name.
std::vector<std::filesystem::path> filesLike(const std::filesystem::path& folder,
                                             const std::string& beginning, const std::string& ending);

// a_from_b of a matrix of 3 or 4 rows; `place` names file and key. Throws CalibrationError (BadInput) where its rotation
// is none, by more than 1e-5, or its last row is not 0 0 0 1.
RigidTransform rigidFrom(const Eigen::MatrixXd& matrix, const std::string& place);

Eigen::MatrixXd matrixFrom(const std::vector<double>& row_major, Eigen::Index rows, Eigen::Index cols);

// A list of rows; throws where there are not as many, or one has not as many numbers.
Eigen::MatrixXd rowsOf(const YamlNode& node, std::size_t rows, std::size_t cols);

// A map of rows, cols and data, as ROS and SVO have them; throws where it has another shape.
Eigen::MatrixXd matrixOf(const YamlNode& node, int rows, int cols);

// fx fy cx cy, and distortion in the order of CameraIntrinsics.
CameraIntrinsics lensFrom(CameraModel model, const std::vector<double>& fx_fy_cx_cy,
                          const std::vector<double>& distortion, Resolution resolution_px);

}  // namespace evical
