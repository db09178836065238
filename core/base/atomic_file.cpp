#include "core/base/atomic_file.h"

#include "core/base/error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
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

// Why nothing may be put there, as errno has it; 0 if it may. A rename would replace a device or a pipe.
int whyNoPlace(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) return EISDIR;
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) ? EEXIST : 0;
}

// A name that nobody else has.
std::string nameAside(const std::filesystem::path& path) {
  std::string aside = path.string() + ".part.XXXXXX";
  const int file = ::mkostemp(aside.data(), O_CLOEXEC);
  if (file < 0) throw writeError(path, errno);
  ::close(file);
  return aside;
}

// Moves that can be taken back until they are kept.
class Moves {
 public:
  Moves() = default;
  Moves(const Moves&) = delete;
  Moves& operator=(const Moves&) = delete;
  ~Moves() {
    while (!done_.empty()) {
      takeBack(done_.back());
      done_.pop_back();
    }
  }

  // Out of the way, if it is there.
  void hide(const std::filesystem::path& path) {
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0) return;
    const std::string aside = nameAside(path);
    if (std::rename(path.c_str(), aside.c_str()) != 0) {
      const int error = errno;
      ::unlink(aside.c_str());
      throw writeError(path, error);
    }
    done_.push_back({aside, path, Kind::Hidden});
  }

  void move(const std::filesystem::path& from, const std::filesystem::path& to) {
    const int error = whyNoPlace(to);
    const bool folders = error == EISDIR && std::filesystem::is_directory(from);
    if (error != 0 && !folders) throw writeError(to, error);
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0) {
      done_.push_back({from, to, Kind::Exchanged});
      return;
    }
    const bool is_new = errno == ENOENT;  // else this file system exchanges nothing
    if (std::rename(from.c_str(), to.c_str()) != 0) throw writeError(to, errno);
    done_.push_back({from, to, is_new ? Kind::New : Kind::Replaced});
  }

  void keep() {
    std::error_code ignored;
    for (const Done& each : done_)
      if (each.kind == Kind::Exchanged || each.kind == Kind::Hidden)
        std::filesystem::remove_all(each.from, ignored);
    done_.clear();
  }

 private:
  enum class Kind { New, Exchanged, Replaced, Hidden };
  struct Done {
    std::filesystem::path from, to;
    Kind kind;
  };

  static void takeBack(const Done& done) {
    if (done.kind == Kind::Exchanged)
      static_cast<void>(::renameat2(AT_FDCWD, done.from.c_str(), AT_FDCWD, done.to.c_str(), RENAME_EXCHANGE));
    if (done.kind == Kind::New) static_cast<void>(std::rename(done.to.c_str(), done.from.c_str()));
    if (done.kind == Kind::Hidden) static_cast<void>(std::rename(done.from.c_str(), done.to.c_str()));
  }

  std::vector<Done> done_;
};

// Files written beside their targets; those that were not moved there go away again.
class FilesAside {
 public:
  FilesAside() = default;
  FilesAside(const FilesAside&) = delete;
  FilesAside& operator=(const FilesAside&) = delete;
  ~FilesAside() {
    for (const FileMove& each : files_) ::unlink(each.from.c_str());
  }

  void write(const std::filesystem::path& path, std::string_view content) {
    removeLitterOf(path);
    if (const int error = whyNoPlace(path)) throw writeError(path, error);
    std::string aside = path.string() + ".part.XXXXXX";
    const int file = ::mkostemp(aside.data(), O_CLOEXEC);
    if (file < 0) throw writeError(path, errno);
    files_.push_back({aside, path});
    giveUsualPermissions(file);
    int error = writeAndSync(file, content);
    if (::close(file) != 0 && error == 0) error = errno;
    if (error != 0) throw writeError(path, error);
  }

  void move() {
    moveFilesWhole(files_);
    files_.clear();
  }

 private:
  std::vector<FileMove> files_;
};

// The time of the last change in it.
std::filesystem::file_time_type lastChange(const std::filesystem::path& path) {
  std::error_code ignored;
  std::filesystem::file_time_type latest = std::filesystem::last_write_time(path, ignored);
  if (ignored || !std::filesystem::is_directory(std::filesystem::symlink_status(path, ignored)))
    return latest;
  for (const auto& entry : std::filesystem::directory_iterator(path, ignored)) {
    std::error_code none;
    const auto changed = entry.last_write_time(none);
    if (!none) latest = std::max(latest, changed);
  }
  return latest;
}

}  // namespace

void writeFileWhole(const std::filesystem::path& path, std::string_view content) {
  FilesAside aside;
  aside.write(path, content);
  aside.move();
}

void writeFilesWhole(std::span<const FileContent> files) {
  FilesAside aside;
  for (const FileContent& file : files) aside.write(file.path, file.content);
  aside.move();
}

void moveFilesWhole(std::span<const FileMove> all) {
  Moves moves;
  if (all.size() > 1) moves.hide(all.back().to);
  for (const FileMove& each : all) moves.move(each.from, each.to);
  moves.keep();
}

void removeLitterOf(const std::filesystem::path& path) {
  constexpr std::chrono::hours kLeft(1);
  constexpr std::size_t kRandom = 6;
  const std::string begin = path.filename().string() + ".part.";
  std::error_code error;
  for (std::filesystem::directory_iterator entry(path.has_parent_path() ? path.parent_path() : ".", error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(begin) || name.size() != begin.size() + kRandom) continue;
    if (std::filesystem::file_time_type::clock::now() - lastChange(entry->path()) < kLeft) continue;
    std::error_code ignored;
    std::filesystem::remove_all(entry->path(), ignored);
  }
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
