#include "core/base/atomic_file.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace evical {
namespace {

CalibrationError writeError(const std::filesystem::path& path, int error) {
  return calibrationFailed(path.string(), fmt::format("cannot be written: {}", std::strerror(error)),
                           error == ENOSPC ? "Free some space, or choose another folder"
                                           : "Check that the folder exists and may be written to");
}

// 0, or errno of what failed.
int writeAndSync(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return ::fsync(file) == 0 ? 0 : errno;
}

// mkostemp makes files private; what we write should be as readable as any other file of this person.
void giveUsualPermissions(int file) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  static_cast<void>(::fchmod(file, 0666 & ~mask));
}

// Files written beside their targets; those that were not renamed go away again.
class FilesAside {
 public:
  FilesAside() = default;
  FilesAside(const FilesAside&) = delete;
  FilesAside& operator=(const FilesAside&) = delete;
  ~FilesAside() {
    for (const auto& [aside, path] : names_) ::unlink(aside.c_str());
  }

  void write(const std::filesystem::path& path, std::string_view content) {
    std::string aside = path.string() + ".XXXXXX";
    const int file = ::mkostemp(aside.data(), O_CLOEXEC);
    if (file < 0) throw writeError(path, errno);
    names_.emplace_back(aside, path);
    giveUsualPermissions(file);
    int error = writeAndSync(file, content);
    if (::close(file) != 0 && error == 0) error = errno;
    if (error != 0) throw writeError(path, error);
  }

  void rename() {
    while (!names_.empty()) {
      const auto& [aside, path] = names_.front();
      if (std::rename(aside.c_str(), path.c_str()) != 0) throw writeError(path, errno);
      names_.erase(names_.begin());
    }
  }

 private:
  std::vector<std::pair<std::string, std::filesystem::path>> names_;
};

}  // namespace

void writeFileWhole(const std::filesystem::path& path, std::string_view content) {
  FilesAside aside;
  aside.write(path, content);
  aside.rename();
}

void writeFilesWhole(std::span<const FileContent> files) {
  FilesAside aside;
  for (const FileContent& file : files) aside.write(file.path, file.content);
  aside.rename();
}

void makeOutputFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!error && !std::filesystem::is_directory(folder))
    error = std::make_error_code(std::errc::not_a_directory);
  if (!error && ::access(folder.c_str(), W_OK | X_OK) != 0) error = {errno, std::generic_category()};
  if (error)
    throw badInput(folder.string(), fmt::format("cannot be used as output folder: {}", error.message()),
                   "Choose a folder that you may write to");
}

}  // namespace evical
