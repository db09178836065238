// The compiled module evical._evical. Programs import the package evical, which contains it.
#include "python/bindings.h"
#include "python/interpreter.h"

#include <algorithm>

namespace py = pybind11;

namespace {

[[noreturn]] void* refuseEmpty(std::size_t /*bytes*/) {
  throw py::type_error("an object of evical was made by __new__ alone: it has no content");
}

// pybind11 gives an object that was never initialised memory without content. And its base class aborts if it
// is copied with the pickle protocols 0 and 1, which make an instance of it: protocol 2 takes their place.
void secure(const py::object& type, const py::object& reduce) {
  py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(type.ptr()))->operator_new = refuseEmpty;
  type.attr("__reduce_ex__") = py::cpp_function(
      [reduce](const py::object& self, int protocol) { return reduce(self, std::max(protocol, 2)); },
      py::is_method(type), py::name("__reduce_ex__"));
}

}  // namespace

PYBIND11_MODULE(_evical, module) {
  using namespace evical::python;
  module.doc() = "Compiled part of evical.";
  module.attr("__version__") = EVICAL_VERSION;
  bindInterpreter();
  bindErrors();
  bindRecording(module);
  bindLens(module);
  bindSession(module);
  bindTrajectory(module);
  bindResult(module);
  bindCalibration(module);
  const py::object reduce = py::module_::import("builtins").attr("object").attr("__reduce_ex__");
  for (const auto& [name, value] : module.attr("__dict__").cast<py::dict>())
    if (PyType_Check(value.ptr()) != 0) secure(py::reinterpret_borrow<py::object>(value), reduce);
}
