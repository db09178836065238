#include "python/arrays.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace evical::python {

namespace py = pybind11;

namespace {

constexpr std::string_view kNumberKinds = "biufO";

bool hasNone(const py::array& objects) {
  for (const py::handle each : objects.attr("flat"))
    if (each.is_none()) return true;
  return false;
}

py::array_t<double> frozen(py::array_t<double> array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

}  // namespace

bool isMasked(const py::object& values) {
  return py::module_::import("numpy.ma").attr("is_masked")(values).cast<bool>();
}

Numbers numbersFrom(const py::object& values, const std::string& what) {
  try {
    const py::array array(values);
    const char kind = array.dtype().kind();
    if (kind == 'M' || kind == 'm')
      throw py::type_error(
          fmt::format("{}, not of the type {}", what, py::str(array.dtype()).cast<std::string>()));
    if (isMasked(values)) throw py::type_error(what + ", without masked values");
    if (kNumberKinds.find(kind) != std::string_view::npos && !(kind == 'O' && hasNone(array)))
      return Numbers(array);
  } catch (py::error_already_set&) {
    // Reported below.
  }
  throw py::type_error(what);
}

Numbers pointsFrom(const py::object& values, py::ssize_t columns, const char* what) {
  Numbers numbers = numbersFrom(values, fmt::format("{} must be numbers of shape (..., {})", what, columns));
  if (numbers.ndim() == 0 || numbers.shape(numbers.ndim() - 1) != columns)
    throw py::value_error(fmt::format("{} must have the shape (..., {}), not {}", what, columns,
                                      py::str(numbers.attr("shape")).cast<std::string>()));
  return numbers;
}

std::vector<py::ssize_t> shapeLike(const Numbers& values, int dropped, const std::vector<py::ssize_t>& last) {
  std::vector<py::ssize_t> shape(values.shape(), values.shape() + values.ndim() - dropped);
  shape.insert(shape.end(), last.begin(), last.end());
  return shape;
}

py::array_t<double> arrayOf(const Eigen::VectorXd& vector) {
  py::array_t<double> array(vector.size());
  std::copy(vector.begin(), vector.end(), array.mutable_data());
  return frozen(std::move(array));
}

py::array_t<double> arrayOf(const Eigen::Vector3d& vector) {
  return arrayOf(Eigen::VectorXd(vector));
}

py::array_t<double> arrayOf(const Eigen::MatrixXd& matrix) {
  py::array_t<double> array({matrix.rows(), matrix.cols()});
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index col = 0; col < matrix.cols(); ++col) array.mutable_at(row, col) = matrix(row, col);
  return frozen(std::move(array));
}

py::dtype recordType(const std::vector<FieldOfRecord>& fields, std::size_t size) {
  py::list names, formats, offsets;
  for (const FieldOfRecord& field : fields) {
    names.append(field.name);
    formats.append(field.format);
    offsets.append(field.offset);
  }
  return py::dtype(names, formats, offsets, static_cast<py::ssize_t>(size));
}

}  // namespace evical::python
