// The interpreter's lock, its end and its forks. A daemon thread that waits for the lock when the interpreter
// ends would be unwound through C++ by Python, which aborts the process. It stays where it is instead.
#pragma once

#include <pybind11/pybind11.h>

#include <stop_token>

namespace evical::python {

// While it exists, other Python threads run. In place of pybind11's gil_scoped_release.
class OthersWork {
 public:
  OthersWork();
  ~OthersWork();
  OthersWork(const OthersWork&) = delete;
  OthersWork& operator=(const OthersWork&) = delete;

 private:
  PyThreadState* state_;
};

// Counts a thread that works in core: the end of the interpreter waits a little for these.
class Inside {
 public:
  Inside();
  ~Inside();
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;
};

// Asks for a stop before the interpreter ends.
std::stop_token endOfInterpreter();

// True in threads that may not return to Python, because the interpreter ends.
bool interpreterEnds();

[[noreturn]] void stayForever();

// Calls a Python function, which may run when the interpreter ends. Throws error_already_set.
pybind11::object called(const pybind11::object& function, const pybind11::tuple& arguments);

void bindInterpreter();

}  // namespace evical::python
