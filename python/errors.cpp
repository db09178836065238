#include "python/errors.h"

#include "core/base/error.h"
#include "python/bindings.h"

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
  if (repair) how = py::make_tuple(repair->key, repair->value);
  PyErr_SetObject(type.ptr(), type(text, place, problem, advice, how).ptr());
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
  }
}

}  // namespace

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
  py::register_exception_translator(translate);
}

}  // namespace evical::python
