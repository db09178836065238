#include "python/interpreter.h"

#include <cxxabi.h>
#include <pthread.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace evical::python {
namespace {

namespace py = pybind11;

// Longest wait at the interpreter's end for threads that do not hold its lock: a calibration stops within a
// fraction of a second, but a read from a file that does not answer never ends.
constexpr std::chrono::milliseconds kLongestEnd(3000), kBetweenCounts(5);

std::atomic<int> threads_inside = 0;
std::stop_source ends;
std::atomic<std::thread::id> ending_thread;

void endCalls() {
  ending_thread = std::this_thread::get_id();
  ends.request_stop();
  PyThreadState* const state = PyEval_SaveThread();
  const auto latest = std::chrono::steady_clock::now() + kLongestEnd;
  while (threads_inside > 0 && std::chrono::steady_clock::now() < latest)
    std::this_thread::sleep_for(kBetweenCounts);
  PyEval_RestoreThread(state);
}

}  // namespace

OthersWork::OthersWork() : state_(PyEval_SaveThread()) {
  ++threads_inside;
}

OthersWork::~OthersWork() {
  --threads_inside;
  if (interpreterEnds()) stayForever();
  try {
    PyEval_RestoreThread(state_);
  } catch (abi::__forced_unwind&) {
    stayForever();
  }
}

Inside::Inside() {
  ++threads_inside;
}

Inside::~Inside() {
  --threads_inside;
}

std::stop_token endOfInterpreter() {
  return ends.get_token();
}

bool interpreterEnds() {
  return ends.stop_requested() && ending_thread.load() != std::this_thread::get_id();
}

void stayForever() {
  for (;;) ::pause();
}

py::object called(const py::object& function, const py::tuple& arguments) {
  PyObject* result = nullptr;
  try {
    result = PyObject_CallObject(function.ptr(), arguments.ptr());
  } catch (abi::__forced_unwind&) {
    stayForever();
  }
  if (result == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(result);
}

void bindInterpreter() {
  py::module_::import("atexit").attr("register")(py::cpp_function(endCalls));
  // A forked child has only the thread that forked, which holds the lock.
  ::pthread_atfork(nullptr, nullptr, [] { threads_inside = 0; });
}

}  // namespace evical::python
