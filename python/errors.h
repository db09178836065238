// Errors of core as Python exceptions (evical.errors), with the same text.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace evical::python {

// Sets Python's error and throws.
[[noreturn]] void throwClosed(const std::string& path);

}  // namespace evical::python
