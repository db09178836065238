// Parts of the module, one function per subject. A type is bound before the functions that take it.
#pragma once

#include <pybind11/pybind11.h>

namespace evical::python {

// A read-only mapping: an assignment to a copy would be lost.
inline pybind11::object readOnly(const pybind11::dict& mapping) {
  return pybind11::module_::import("types").attr("MappingProxyType")(mapping);
}

void bindErrors();
void bindRecording(pybind11::module_& module);
void bindLens(pybind11::module_& module);
void bindSession(pybind11::module_& module);
void bindTrajectory(pybind11::module_& module);
void bindResult(pybind11::module_& module);
void bindCalibration(pybind11::module_& module);

}  // namespace evical::python
