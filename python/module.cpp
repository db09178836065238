// The compiled module evical._evical. Programs import the package evical, which contains it.
#include "python/bindings.h"

namespace py = pybind11;

PYBIND11_MODULE(_evical, module) {
  using namespace evical::python;
  module.doc() = "Compiled part of evical.";
  module.attr("__version__") = EVICAL_VERSION;
  bindErrors();
  bindRecording(module);
  bindLens(module);
  bindSession(module);
  bindTrajectory(module);
  bindResult(module);
  bindCalibration(module);
}
