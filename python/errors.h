// Errors of core as Python exceptions (evical.errors), with the same text.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <string_view>
#include <vector>

namespace evical::python {

// Texts of files and paths need not be UTF-8: in messages, other bytes are replaced by U+FFFD. Names keep
// them, like os.fsdecode, since they are given back: to select a stream, for example.
pybind11::str textOf(std::string_view bytes);
pybind11::list textsOf(const std::vector<std::string>& texts);
pybind11::str identifierOf(std::string_view bytes);
std::string bytesOf(const pybind11::str& identifier);

// Sets Python's error and throws.
[[noreturn]] void throwClosed(const std::string& path);

[[noreturn]] void throwBadState(const char* type);

// Calls `restore` with a pickled state of `size` members. Throws CalibrationError (BadInput) for others, so
// that a state that nobody made cannot make an object whose use crashes.
template <class Restore>
auto restored(const pybind11::tuple& state, std::size_t size, const char* type, const Restore& restore)
    -> decltype(restore(state)) {
  if (state.size() != size) throwBadState(type);
  try {
    return restore(state);
  } catch (const pybind11::cast_error&) {
    throwBadState(type);
  } catch (const pybind11::error_already_set&) {
    throwBadState(type);
  }
}

}  // namespace evical::python
