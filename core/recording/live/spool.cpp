#include "core/recording/live/spool.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

namespace evical {
namespace {

[[noreturn]] void fail(const std::filesystem::path& folder) {
  throw calibrationFailed(folder.string(),
                          fmt::format("the stream cannot be stored here: {}", std::strerror(errno)),
                          "Check the folder, its permissions and the disk space");
}

// A file without a name; not all file systems have them.
int createNameless(const std::filesystem::path& folder) {
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
  std::string name = (folder / ".evical-stream.XXXXXX").string();
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

}  // namespace

Spool::Spool(const std::filesystem::path& folder, Fill fill)
    : folder_(folder.empty() ? "." : folder), file_(createNameless(folder_)) {
  if (file_ < 0) fail(folder_);
  path_ = fmt::format("/proc/{}/fd/{}", ::getpid(), file_);  // also for the process that reads HDF5
  growth_ = std::make_shared<Growth>(path_, Growth::EndsBy::Writer);
  thread_ = std::jthread([this, fill = std::move(fill)](const std::stop_token& stop) {
    try {
      fill(*this, stop);
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      error_ = std::current_exception();
    }
    growth_->end();
  });
}

Spool::~Spool() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
  ::close(file_);
}

void Spool::append(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(folder_);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void Spool::note(FaultKind kind, std::string text) {
  const std::scoped_lock lock(mutex_);
  if (std::ssize(notes_) < kMostAlikeFaults) notes_.push_back({"", kind, 0.0, std::move(text)});
}

std::vector<RecordingFault> Spool::notes() const {
  const std::scoped_lock lock(mutex_);
  return notes_;
}

void Spool::check() {
  std::exception_ptr error;
  {
    const std::scoped_lock lock(mutex_);
    error = std::exchange(error_, nullptr);
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace evical
