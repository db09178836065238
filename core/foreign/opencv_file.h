// Files of OpenCV's FileStorage (YAML, JSON, XML), with the file and key in error messages. OpenCV's own
// parsers overwrite the stack on some files, so only the structures of calibrations are read here. As in
// OpenCV, "20" is an int and "20.0" a real number; a key that occurs twice, which OpenCV accepts, is refused.
#pragma once

#include "core/foreign/read_calibration.h"

#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/resolution.h"
#include "core/geometry/so3.h"

#include <Eigen/Core>

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace evical {

// A value in a file. All methods throw CalibrationError (BadInput) if the key is missing or of another type.
class OpencvNode {
 public:
  bool has(const std::string& key) const;
  OpencvNode operator[](const std::string& key) const;

  double number() const;  // an int or a real one
  int integer() const;    // an int only
  std::string text() const;
  bool isText() const;
  std::size_t size() const;                                        // of a list
  std::vector<double> numbers(std::size_t count) const;            // of a list
  Eigen::MatrixXd rows(std::size_t rows, std::size_t cols) const;  // of a list of lists
  // An !!opencv-matrix; `types`: those of its elements that the program accepts, "f" for float and "d" for
  // double.
  Eigen::MatrixXd matrix(int rows, int cols, const std::string& types = "d") const;
  std::vector<double> matrixNumbers() const;  // row by row, for any shape
  Resolution resolution() const;              // of a list: width and height
  int side_px() const;                        // a width or height
  std::vector<std::string> keys() const;      // of a map; otherwise empty

  std::string place() const;  // "vins.yaml: acc_n"
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  friend class OpencvFile;
  struct Value;  // with those below it
  struct Reading;
  OpencvNode(std::shared_ptr<const Value> value, std::string file, std::string key);
  std::shared_ptr<const Value> child(const Value& value) const;
  std::vector<double> elements() const;

  std::shared_ptr<const Value> value_;
  std::string file_, key_;
};

class OpencvFile {
 public:
  explicit OpencvFile(const std::filesystem::path& file);
  OpencvNode root() const { return {root_, file_, ""}; }
  OpencvNode operator[](const std::string& key) const { return root()[key]; }
  bool has(const std::string& key) const { return root().has(key); }

 private:
  std::string file_;
  std::shared_ptr<const OpencvNode::Value> root_;
};

// Files of a stereo pair that name left and right, but not the cameras of the rig.
struct PairAsRead {
  CameraIntrinsics left, right;  // resolutions are not compared
  RigidTransform right_from_left;
};

// Those two of `cameras`, read from their own files, that have the pair's lenses; if several have the same
// numbers, those with the closest poses. Throws CalibrationError (BadInput) if there are none; `path` is the
// pair's file.
ReadFile pairAmong(std::span<const ReadCamera> cameras, const PairAsRead& pair,
                   const std::filesystem::path& path);

}  // namespace evical
