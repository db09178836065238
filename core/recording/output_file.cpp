#include "core/recording/output_file.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace evical {
namespace {

constexpr std::size_t kBufferSize = 1U << 20;

CalibrationError writeError(const std::filesystem::path& path, int error) {
  return calibrationFailed(path.string(), fmt::format("cannot be written: {}", std::strerror(error)),
                           error == ENOSPC || error == EFBIG
                               ? "Free some space, or choose another folder"
                               : "Check that the folder exists and may be written to");
}

}  // namespace

OutputFile::OutputFile(const std::filesystem::path& path) : path_(path), aside_(path.string() + ".XXXXXX") {
  file_ = ::mkostemp(aside_.data(), O_CLOEXEC);
  if (file_ < 0) throw writeError(path, errno);
  const mode_t mask = ::umask(0);  // mkostemp makes files private
  ::umask(mask);
  static_cast<void>(::fchmod(file_, 0666 & ~mask));
  buffer_.reserve(kBufferSize);
}

OutputFile::~OutputFile() {
  if (file_ >= 0) ::close(file_);
  if (!aside_.empty()) ::unlink(aside_.c_str());
}

void OutputFile::append(Bytes bytes) {
  if (buffer_.size() + bytes.size() > kBufferSize) flush();
  if (bytes.size() >= kBufferSize) {
    writeAt(written_, bytes);
    written_ += bytes.size();
  } else {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  }
}

void OutputFile::overwrite(std::uint64_t position, Bytes bytes) {
  flush();
  writeAt(position, bytes);
}

void OutputFile::flush() {
  writeAt(written_, buffer_);
  written_ += buffer_.size();
  buffer_.clear();
}

void OutputFile::writeAt(std::uint64_t position, Bytes bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(position));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw writeError(path_, errno);
    position += static_cast<std::uint64_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
}

void OutputFile::close() {
  flush();
  if (::fsync(file_) != 0) throw writeError(path_, errno);
  const int status = ::close(file_);
  file_ = -1;
  if (status != 0) throw writeError(path_, errno);
}

void OutputFile::rename() {
  if (std::rename(aside_.c_str(), path_.c_str()) != 0) throw writeError(path_, errno);
  aside_.clear();
}

}  // namespace evical
