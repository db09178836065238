#include "core/foreign/read_numbers.h"

#include "core/base/error.h"
#include "core/base/file_places.h"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <system_error>

namespace evical {

std::string textOf(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargest_bytes = 64 << 20;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    throw badInput(file.string(), "does not exist, or is not a file");
  if (std::filesystem::file_size(file, error) > kLargest_bytes || error)
    throw badInput(file.string(), "is too large for a calibration file");
  std::string text = contentOfFile(file);
  if (text.empty()) throw badInput(file.string(), "cannot be read, or is empty");
  return text;
}

std::vector<std::filesystem::path> filesLike(const std::filesystem::path& folder,
                                             const std::string& beginning, const std::string& ending) {
  std::vector<std::filesystem::path> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(beginning) && name.ends_with(ending)) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

RigidTransform rigidFrom(const Eigen::MatrixXd& matrix, const std::string& place) {
  constexpr double kRotation = 1e-5;  // precision of programs that store floats
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const double off = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off < kRotation) || rotation.determinant() < 0.0)
    throw badInput(place, fmt::format("is not a rotation: R R^T differs from the identity by {:.2g}", off));
  if (matrix.rows() == 4 && matrix.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0))
    throw badInput(place, "its last row is not 0 0 0 1");
  return {Eigen::Quaterniond(rotation).normalized(), matrix.topRightCorner<3, 1>()};
}

Eigen::MatrixXd matrixFrom(const std::vector<double>& row_major, Eigen::Index rows, Eigen::Index cols) {
  return Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      row_major.data(), rows, cols);
}

Eigen::MatrixXd rowsOf(const YamlNode& node, std::size_t rows, std::size_t cols) {
  const std::vector<YamlNode> items = node.items();
  if (items.size() != rows) throw node.error(fmt::format("has {} rows, {} are needed", items.size(), rows));
  std::vector<double> all;
  for (const YamlNode& row : items)
    for (const double value : row.reals(cols)) all.push_back(value);
  return matrixFrom(all, static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols));
}

Eigen::MatrixXd matrixOf(const YamlNode& node, int rows, int cols) {
  node["rows"].integer(rows, rows);
  node["cols"].integer(cols, cols);
  return matrixFrom(node["data"].reals(static_cast<std::size_t>(rows * cols)), rows, cols);
}

bool isSide_px(double side_px) {
  constexpr double kLargest_px = 100'000.0;
  return side_px >= 1.0 && side_px <= kLargest_px && side_px == std::floor(side_px);
}

CameraIntrinsics lensFrom(CameraModel model, const std::vector<double>& fx_fy_cx_cy,
                          const std::vector<double>& distortion, Resolution resolution_px) {
  CameraIntrinsics lens{
      model, resolution_px, {fx_fy_cx_cy.at(0), fx_fy_cx_cy.at(1)}, {fx_fy_cx_cy.at(2), fx_fy_cx_cy.at(3)}};
  std::copy_n(distortion.begin(), std::min<std::size_t>(distortion.size(), 5), lens.distortion.begin());
  return lens;
}

}  // namespace evical
