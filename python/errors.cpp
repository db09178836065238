#include "python/errors.h"

#include "core/base/error.h"
#include "python/bindings.h"

#include <fmt/format.h>

#include <exception>
#include <filesystem>

namespace evical::python {
namespace {

namespace py = pybind11;

// Kept as long as the interpreter, which may be gone when statics are destroyed: never released.
struct ErrorTypes {
  py::handle input, failed, closed;
};

ErrorTypes& errorTypes() {
  static ErrorTypes types;
  return types;
}

void setError(py::handle type, const std::string& place, const std::string& problem,
              const std::string& advice, const std::string& text, const std::optional<Repair>& repair) {
  py::object how = py::none();
  if (repair) how = py::make_tuple(textOf(repair->key), textOf(repair->value));
  PyErr_SetObject(type.ptr(), type(textOf(text), textOf(place), textOf(problem), textOf(advice), how).ptr());
}

py::str decoded(std::string_view bytes, const char* errors) {
  PyObject* const text = PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), errors);
  if (text == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const CalibrationError& error) {
    const ErrorTypes& types = errorTypes();
    setError(error.kind() == ErrorKind::BadInput ? types.input : types.failed, error.place(), error.problem(),
             error.advice(), error.what(), error.repair());
  } catch (const std::filesystem::filesystem_error& error) {
    const CalibrationError same =
        badInput(error.path1().string(), "cannot be used: " + error.code().message());
    setError(errorTypes().input, same.place(), same.problem(), "", same.what(), {});
  } catch (const py::cast_error&) {
    PyErr_SetString(PyExc_TypeError, "an argument, or one of its items, has a wrong type");
  }
}

}  // namespace

py::str textOf(std::string_view bytes) {
  return decoded(bytes, "replace");
}

py::list textsOf(const std::vector<std::string>& texts) {
  py::list list;
  for (const std::string& text : texts) list.append(textOf(text));
  return list;
}

py::str identifierOf(std::string_view bytes) {
  return decoded(bytes, "surrogateescape");
}

std::string bytesOf(const py::str& identifier) {
  PyObject* const bytes = PyUnicode_AsEncodedString(identifier.ptr(), "utf-8", "surrogateescape");
  if (bytes == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::bytes>(bytes);
}

void throwBadState(const char* type) {
  throw badInput(fmt::format("pickle of evical.{}", type),
                 "is damaged, or comes from another version of Evical",
                 "Use the same version in all processes");
}

void throwClosed(const std::string& path) {
  const CalibrationError error = badInput(path, "the recording is closed", "Open it again: evical.open");
  setError(errorTypes().closed, error.place(), error.problem(), error.advice(), error.what(), {});
  throw py::error_already_set();
}

void bindErrors() {
  const py::module_ errors = py::module_::import("evical.errors");
  errorTypes() = {errors.attr("InputError").cast<py::object>().release(),
                  errors.attr("CalibrationFailed").cast<py::object>().release(),
                  errors.attr("ClosedError").cast<py::object>().release()};
  py::register_local_exception_translator(translate);
}

}  // namespace evical::python
