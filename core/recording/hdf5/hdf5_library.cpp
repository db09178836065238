#include "core/recording/hdf5/hdf5_library.h"

#include "core/base/error.h"
#include "core/recording/hdf5/hdf5_filters.h"
#include "core/recording/separate_reader.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
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

MemoryLimit::MemoryLimit(std::uint64_t bytes) {
  rlimit limit{};
  ::getrlimit(RLIMIT_DATA, &limit);
  before_ = limit.rlim_cur;
  if (!isReaderProcess()) return;
  std::ifstream statm("/proc/self/statm");
  std::uint64_t total = 0, resident = 0, shared = 0, text = 0, library = 0, data = 0;
  if (!(statm >> total >> resident >> shared >> text >> library >> data)) return;
  limit.rlim_cur =
      std::min<rlim_t>(limit.rlim_max, data * static_cast<std::uint64_t>(::getpagesize()) + bytes);
  ::setrlimit(RLIMIT_DATA, &limit);
}

MemoryLimit::~MemoryLimit() {
  rlimit limit{};
  ::getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur = before_;
  ::setrlimit(RLIMIT_DATA, &limit);
}

std::string lastProblem() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keepInnermost, &text);
  // "file write failed: time = ..., errno = 28, error message = 'No space left on device', buf = ...": the
  // system's words.
  constexpr std::string_view kMessage = "error message = '";
  if (const std::size_t at = text.find(kMessage); at != std::string::npos) {
    text.erase(0, at + kMessage.size());
    text.erase(std::min(text.size(), text.find('\'')));
  }
  if (text.starts_with("memory allocation failed"))
    return "it unpacks to more than it states, or memory is short";
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
