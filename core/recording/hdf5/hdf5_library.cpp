#include "core/recording/hdf5/hdf5_library.h"

#include "core/base/error.h"
#include "core/recording/hdf5/hdf5_filters.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace evical::hdf5 {
namespace {

herr_t keepInnermost(unsigned depth, const H5E_error2_t* error, void* text) {
  if (depth == 0 && error->desc) *static_cast<std::string*>(text) = error->desc;
  return 0;
}

// The library leaks memory on damaged files, and reports it on stderr when it is closed at the program's end.
// Every file is closed earlier by its handle, so that nothing remains to be done then.
void closeNothingAtExit() {
  static const herr_t once = H5dont_atexit();
  static_cast<void>(once);
}

}  // namespace

Quiet::Quiet() {
  closeNothingAtExit();
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Quiet::~Quiet() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
}

std::string lastProblem() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keepInnermost, &text);
  // "file write failed: time = ..., errno = 28, error message = 'No space left on device', buf = ...": the system's words.
  constexpr std::string_view kMessage = "error message = '";
  if (const std::size_t at = text.find(kMessage); at != std::string::npos) {
    text.erase(0, at + kMessage.size());
    text.erase(std::min(text.size(), text.find('\'')));
  }
  return text.empty() ? "HDF5 gives no reason" : text;
}

Handle openFile(const std::filesystem::path& path) {
  registerFilters();
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, false, true);  // read-only folders need none
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  if (file.valid()) return file;
  throw badInput(path.string(), fmt::format("the HDF5 file cannot be opened: {}", lastProblem()),
                 "Copy it again, or finish recording: it may be cut off, or still being written");
}

}  // namespace evical::hdf5
