#include "core/export/export_text.h"

#include "core/base/error.h"
#include "core/base/plain_text.h"
#include "core/base/yaml_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

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

namespace {

// The text with each of these letters replaced.
std::string withReplaced(std::string_view text,
                         std::initializer_list<std::pair<char, const char*>> replaced) {
  std::string result;
  for (const char letter : text) {
    const auto* const found = std::find_if(replaced.begin(), replaced.end(),
                                           [letter](const auto& each) { return each.first == letter; });
    result += found == replaced.end() ? std::string(1, letter) : found->second;
  }
  return result;
}

// XML comments must not contain two hyphens.
std::string xmlComment(std::string_view lines) {
  std::string comment = "<!-- ";
  for (const char letter : lines) {
    if (letter == '-' && comment.back() == '-') comment += ' ';
    comment += letter;
  }
  return comment.append("-->\n");
}

std::string lineBeginning(Language language) {
  switch (language) {
    case Language::Yaml:
    case Language::Shell:
    case Language::Python:
      return "# ";
    case Language::Matlab:
      return "% ";
    default:
      return "";
  }
}

}  // namespace

std::string commentIn(Language language, std::string_view lines) {
  // Python takes the encoding of the source from words in its first comment, if this line does not state it.
  std::string text = language == Language::Python ? "# -*- coding: utf-8 -*-\n" : "";
  while (!lines.empty()) {
    const std::string_view line = lines.substr(0, lines.find('\n'));
    text += lineBeginning(language) + printable(line) + "\n";
    lines.remove_prefix(std::min(lines.size(), line.size() + 1));
  }
  return language == Language::Xml ? xmlComment(text) : text;
}

std::string stringIn(Language language, std::string_view text) {
  const std::string plain = printable(text);
  switch (language) {
    case Language::Yaml:
      return yamlText(plain);
    case Language::Json:
      return '"' + withReplaced(plain, {{'"', "\\\""}, {'\\', "\\\\"}}) + '"';
    case Language::Xml:
      return '"' + withReplaced(plain, {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}}) + '"';
    case Language::Shell:
      return shellWord(plain);
    case Language::Python:
      return "'" + withReplaced(plain, {{'\'', "\\'"}, {'\\', "\\\\"}}) + "'";
    case Language::Matlab:
      return "'" + withReplaced(plain, {{'\'', "''"}}) + "'";
    case Language::Text:
      break;
  }
  return plain;
}

}  // namespace evical
