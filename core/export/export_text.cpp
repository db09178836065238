#include "core/export/export_text.h"

#include "core/base/error.h"

#include <fmt/format.h>

#include <cmath>

namespace evical {

void throwNotFinite(const std::string& place) {
  throw badInput(place, "has values that are not finite (NaN or infinity)", "Calibrate again");
}

namespace {

std::vector<double> elements(const Eigen::MatrixXd& matrix) {
  std::vector<double> values;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index col = 0; col < matrix.cols(); ++col) values.push_back(matrix(row, col));
  return values;
}

}  // namespace

std::string real(double value) {
  if (!std::isfinite(value)) throwNotFinite("result");
  std::string text = fmt::format("{}", value);
  if (text.find('.') == std::string::npos) {
    const std::size_t exponent = text.find('e');
    text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
  }
  return text;
}

std::string realList(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + real(value);
  return text;
}

std::string realList(const Eigen::VectorXd& values) {
  return realList(std::vector<double>(values.begin(), values.end()));
}

std::string rowMajor(const Eigen::MatrixXd& matrix) {
  return realList(elements(matrix));
}

std::string rowsYaml(const Eigen::MatrixXd& matrix, int indent) {
  std::string text;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    text += fmt::format("{:{}}- [{}]\n", "", indent, rowMajor(matrix.row(row)));
  return text;
}

std::string opencvMatrix(const char* key, const Eigen::MatrixXd& matrix, char dt) {
  std::string text = fmt::format("{}: !!opencv-matrix\n   rows: {}\n   cols: {}\n   dt: {}\n   data: [", key,
                                 matrix.rows(), matrix.cols(), dt);
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    text += (row == 0 ? "" : ",\n          ") + rowMajor(matrix.row(row));
  return text + "]\n";
}

std::string dataMatrix(const Eigen::MatrixXd& matrix, int indent) {
  return fmt::format("{0:{1}}rows: {2}\n{0:{1}}cols: {3}\n{0:{1}}data: [{4}]\n", "", indent, matrix.rows(),
                     matrix.cols(), rowMajor(matrix));
}

std::string jsonText(const std::string& text) {
  std::string quoted = "\"";
  for (const char letter : text) {
    if (letter == '"' || letter == '\\') quoted += '\\';
    if (static_cast<unsigned char>(letter) < 0x20) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(letter));
    } else {
      quoted += letter;
    }
  }
  return quoted + "\"";
}

}  // namespace evical
