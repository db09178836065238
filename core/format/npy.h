// NumPy files: an array as .npy (version 1.0, little endian), several of them as .npz.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace evical {

// Contents of .npy files. A matrix is float64 of two dimensions, rows by columns; a list has one, a number
// none.
std::string npyMatrix(const Eigen::MatrixXd& matrix);
std::string npyList(std::span<const double> numbers);
std::string npyList(std::span<const std::int64_t> numbers);
std::string npyList(const std::vector<std::string>& texts);  // UTF-8, to str
std::string npyNumber(double number);
std::string npyText(const std::string& text);

struct NpzArray {
  std::string name;  // as in numpy.load, without ".npy"
  std::string npy;
};

// A ZIP file of arrays, without compression. Equal arrays give equal bytes: files have no time.
std::string npz(std::span<const NpzArray> arrays);

}  // namespace evical
