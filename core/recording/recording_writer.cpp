#include "core/recording/recording_writer.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

namespace evical {
namespace {

// A rename would replace a device or a pipe by the file.
void requireFileOrNothing(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
  throw badInput(path.string(),
                 std::filesystem::is_directory(status) ? "this is a folder" : "this exists and is not a file",
                 "Choose another output");
}

// mkostemp makes files private; a recording should have the usual permissions of this user's files.
void giveUsualPermissions(int file) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  static_cast<void>(::fchmod(file, 0666 & ~mask));
}

}  // namespace

PartFile::PartFile(std::filesystem::path path) : path_(std::move(path)) {
  requireFileOrNothing(path_);
  std::string name = path_.string() + ".part.XXXXXX";
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) fail("cannot be created");
  part_path_ = name;
  giveUsualPermissions(file);
  file_ = ::fdopen(file, "wb");
  if (file_) return;
  ::close(file);
  ::unlink(part_path_.c_str());
  fail("cannot be created");
}

PartFile::~PartFile() {
  close();
}

void PartFile::append(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot be written");
  size_ += bytes.size();
}

void PartFile::overwrite(std::uint64_t position, std::string_view bytes) {
  const bool done = std::fseek(file_, static_cast<long>(position), SEEK_SET) == 0 &&
                    std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size() &&
                    std::fseek(file_, 0, SEEK_END) == 0;
  if (!done) fail("cannot be written");
}

void PartFile::finish() {
  // Buffered bytes may fail on a full disk only here. Without the sync a power cut could leave the new name
  // without content, and the old content lost.
  if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail("cannot be written");
  if (std::fclose(std::exchange(file_, nullptr)) != 0) {
    const int reason = errno;
    if (!published_) std::remove(part_path_.c_str());
    errno = reason;
    fail("cannot be written");
  }
  takeName();
}

void PartFile::publish() {
  if (std::fflush(file_) != 0) fail("cannot be written");
  takeName();
}

void PartFile::takeName() {
  if (published_) return;
  if (std::rename(part_path_.c_str(), path_.c_str()) != 0) {
    const int reason = errno;
    std::remove(part_path_.c_str());
    errno = reason;
    fail("cannot be written");
  }
  published_ = true;
}

void PartFile::fail(const char* what) {
  const std::string reason = std::strerror(errno);
  close();
  throw calibrationFailed(path_.string(), fmt::format("the file {}: {}", what, reason),
                          "Check the folder, its permissions and the disk space");
}

void PartFile::close() {
  if (!file_) return;
  std::fclose(std::exchange(file_, nullptr));
  if (!published_) std::remove(part_path_.c_str());
}

}  // namespace evical
