// What module.cpp puts together: one function a subject. Types that others take are bound before them.
#pragma once

#include <pybind11/pybind11.h>

namespace evical::python {

void bindErrors();
void bindRecording(pybind11::module_& module);
void bindLens(pybind11::module_& module);
void bindSession(pybind11::module_& module);
void bindTrajectory(pybind11::module_& module);
void bindResult(pybind11::module_& module);
void bindCalibration(pybind11::module_& module);

}  // namespace evical::python
