// NumPy arrays: views of an object's own memory without a copy, and conversion of points in both directions.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <pybind11/numpy.h>

#include <string>
#include <vector>

namespace evical::python {

using Numbers = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;

// Numbers of any shape. Raises TypeError for what is none: times, complex numbers, None, masked values;
// `what` names the argument and its unit.
Numbers numbersFrom(const pybind11::object& values, const std::string& what);

// Points along the last axis, of any leading shape: (..., columns). Raises ValueError for another size;
// `what` names the argument.
Numbers pointsFrom(const pybind11::object& values, pybind11::ssize_t columns, const char* what);

// The shape of `values` with its `dropped` trailing axes replaced by `last`.
std::vector<pybind11::ssize_t> shapeLike(const Numbers& values, int dropped,
                                         const std::vector<pybind11::ssize_t>& last);

// Read-only, since these are values of properties: a change of such a copy would be lost.
pybind11::array_t<double> arrayOf(const Eigen::VectorXd& vector);
pybind11::array_t<double> arrayOf(const Eigen::Vector3d& vector);
pybind11::array_t<double> arrayOf(const Eigen::MatrixXd& matrix);

// True if a masked array hides some of its values.
bool isMasked(const pybind11::object& values);

struct FieldOfRecord {
  const char *name, *format;
  std::size_t offset;
};
pybind11::dtype recordType(const std::vector<FieldOfRecord>& fields, std::size_t size);

}  // namespace evical::python
