// OpenCV's FileStorage, with the file and key in its error messages. It distinguishes whole and real numbers:
// "20" is an int, "20.0" a real one.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/persistence.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace evical {

// A value in a file. All methods throw CalibrationError (BadInput) if the key is missing or of another type.
class OpencvNode {
 public:
  OpencvNode(cv::FileNode node, std::string file, std::string key);

  bool has(const std::string& key) const;
  OpencvNode operator[](const std::string& key) const;

  double number() const;  // an int or a real one
  int integer() const;    // an int only
  std::string text() const;
  bool isText() const { return node_.isString(); }
  std::size_t size() const { return node_.size(); }                // of a list
  std::vector<double> numbers(std::size_t count) const;            // of a list
  Eigen::MatrixXd rows(std::size_t rows, std::size_t cols) const;  // of a list of lists
  // An !!opencv-matrix; `kind`: CV_32F or CV_64F, or -1 if the program accepts both.
  Eigen::MatrixXd matrix(int rows, int cols, int kind) const;
  std::vector<double> matrixNumbers() const;  // row by row, for any shape
  std::vector<std::string> keys() const;      // of a map; otherwise empty

  std::string place() const;  // "vins.yaml: acc_n"
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  cv::FileNode node_;
  std::string file_, key_;
};

class OpencvFile {
 public:
  explicit OpencvFile(const std::filesystem::path& file);
  OpencvNode root() const;
  OpencvNode operator[](const std::string& key) const { return root()[key]; }
  bool has(const std::string& key) const { return root().has(key); }

 private:
  std::string file_;
  cv::FileStorage storage_;
};

}  // namespace evical
