#include "core/foreign/opencv_file.h"

#include "core/base/error.h"
#include "core/foreign/read_numbers.h"

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>

namespace evical {

OpencvNode::OpencvNode(cv::FileNode node, std::string file, std::string key)
    : node_(std::move(node)), file_(std::move(file)), key_(std::move(key)) {}

bool OpencvNode::has(const std::string& key) const {
  return node_.isMap() && !node_[key].empty();
}

OpencvNode OpencvNode::operator[](const std::string& key) const {
  const std::string whole = key_.empty() ? key : key_ + "." + key;
  if (!has(key)) throw badInput(fmt::format("{}: {}", file_, whole), "is missing");
  return {node_[key], file_, whole};
}

double OpencvNode::number() const {
  if (!node_.isInt() && !node_.isReal()) fail("is not a number for OpenCV");
  const auto value = static_cast<double>(node_);
  if (!std::isfinite(value)) fail("is not a finite number");
  return value;
}

int OpencvNode::integer() const {
  if (!node_.isInt()) fail("is not a whole number for OpenCV");
  return static_cast<int>(node_);
}

std::string OpencvNode::text() const {
  if (!node_.isString()) fail("is not a text for OpenCV");
  return static_cast<std::string>(node_);
}

std::vector<double> OpencvNode::numbers(std::size_t count) const {
  if (!node_.isSeq()) fail("is not a list");
  if (node_.size() != count) fail(fmt::format("has {} numbers, {} are needed", node_.size(), count));
  std::vector<double> values;
  for (const cv::FileNode& item : node_) values.push_back(OpencvNode(item, file_, key_).number());
  return values;
}

Eigen::MatrixXd OpencvNode::rows(std::size_t rows, std::size_t cols) const {
  if (!node_.isSeq() || node_.size() != rows) fail(fmt::format("is not a list of {} rows", rows));
  std::vector<double> all;
  for (const cv::FileNode& row : node_)
    for (const double value : OpencvNode(row, file_, key_).numbers(cols)) all.push_back(value);
  return matrixFrom(all, static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols));
}

Eigen::MatrixXd OpencvNode::matrix(int rows, int cols, int kind) const {
  cv::Mat read;
  try {
    read = node_.mat();
  } catch (const cv::Exception& error) {
    fail("is not a matrix for OpenCV: " + std::string(error.what()));
  }
  if (read.rows != rows || read.cols != cols || read.channels() != 1)
    fail(fmt::format("is {} x {}, but must be {} x {}", read.rows, read.cols, rows, cols));
  if (kind >= 0 && read.depth() != kind) fail(fmt::format("must have dt {}", kind == CV_32F ? "f" : "d"));
  cv::Mat real;
  read.convertTo(real, CV_64F);
  Eigen::MatrixXd matrix(rows, cols);
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < cols; ++col) matrix(row, col) = real.at<double>(row, col);
  if (!matrix.allFinite()) fail("has values that are not finite");
  return matrix;
}

std::vector<double> OpencvNode::matrixNumbers() const {
  if (node_.isSeq()) return numbers(node_.size());
  cv::Mat read;
  try {
    read = node_.mat();
  } catch (const cv::Exception& error) {
    fail("is not a matrix for OpenCV: " + std::string(error.what()));
  }
  if (read.empty() || read.channels() != 1) fail("is not a matrix of numbers");
  cv::Mat real;
  read.convertTo(real, CV_64F);
  const std::vector<double> values = real.reshape(1, 1);
  if (!std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
    fail("has values that are not finite");
  return values;
}

std::vector<std::string> OpencvNode::keys() const {
  std::vector<std::string> names;
  if (node_.isMap())
    for (const cv::FileNode& item : node_) names.push_back(item.name());
  return names;
}

std::string OpencvNode::place() const {
  return key_.empty() ? file_ : fmt::format("{}: {}", file_, key_);
}

void OpencvNode::fail(const std::string& problem) const {
  throw badInput(place(), problem);
}

OpencvFile::OpencvFile(const std::filesystem::path& file) : file_(file.string()) {
  if (textOf(file).find_first_not_of(" \t\r\n") == std::string::npos) throw badInput(file_, "is empty");
  try {
    storage_.open(file_, cv::FileStorage::READ);
  } catch (const cv::Exception& error) {
    throw badInput(file_, "OpenCV cannot read it: " + std::string(error.what()));
  }
  if (!storage_.isOpened()) throw badInput(file_, "OpenCV cannot read it");
}

OpencvNode OpencvFile::root() const {
  return {storage_.root(), file_, ""};
}

}  // namespace evical
