// Arrays of an uncompressed .npz file, as numpy.load reads them without pickles.
#pragma once

#include <Eigen/Core>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace evical {

// All methods throw CalibrationError (BadInput), which names file and array, if it is missing or of another
// type.
class NpzArrays {
 public:
  static NpzArrays load(const std::filesystem::path& file);

  bool has(const std::string& name) const { return arrays_.contains(name); }
  double number(const std::string& name) const;
  std::vector<double> numbers(const std::string& name) const;  // of one dimension
  Eigen::MatrixXd matrix(const std::string& name, std::size_t rows, std::size_t cols) const;
  std::string text(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name) const;

  std::string place(const std::string& name) const { return file_ + ": " + name; }

 private:
  struct Array {
    bool is_text = false;
    std::vector<std::size_t> shape = {};
    std::vector<double> numbers = {};
    std::vector<std::string> texts = {};
  };
  static Array arrayOf(const std::string& npy, const std::string& place);
  const Array& get(const std::string& name, bool is_text, std::size_t dimensions) const;

  std::string file_;
  std::map<std::string, Array> arrays_;
};

}  // namespace evical
