#include "core/base/atomic_file.h"

#include "core/base/error.h"
#include "core/base/file_places.h"
#include "core/base/files_together.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <system_error>
#include <vector>

namespace evical {
namespace {

// Names of a file that is written, and of one that is replaced, followed by six letters.
constexpr const char *kPart = ".part.", *kFormer = ".former.";

// A unique name for the file that is replaced.
std::string nameAside(const std::filesystem::path& path) {
  std::string aside = path.string() + kFormer + "XXXXXX";
  const int file = ::mkostemp(aside.data(), O_CLOEXEC);
  if (file < 0) throw writeError(path, errno);
  ::close(file);
  return aside;
}

// Moves that are undone by the destructor unless they are kept.
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

  // Moves an older file away, if it exists.
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
    const bool is_new = errno == ENOENT;  // else the file system does not support exchanging
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

// Time of the latest change in a folder.
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
  FilesTogether files;
  files.write(path, [&](const TextSink& sink) { sink(content); });
  files.place();
}

void writeFilesWhole(std::span<const FileContent> contents) {
  FilesTogether files;
  for (const FileContent& file : contents) files.write(file);
  files.place();
}

std::string contentOf(const FileContent& file) {
  return file.pieces ? wholeText(file.pieces) : file.content;
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
  const std::string begin = path.filename().string() + kPart, former = path.filename().string() + kFormer;
  std::error_code error;
  const bool replaced = std::filesystem::exists(std::filesystem::symlink_status(path, error));
  for (std::filesystem::directory_iterator entry(path.has_parent_path() ? path.parent_path() : ".", error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const bool left = name.starts_with(begin) && name.size() == begin.size() + kRandom;
    const bool old = replaced && name.starts_with(former) && name.size() == former.size() + kRandom;
    if (!left && !old) continue;
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
    throw badInput(folder.string(), fmt::format("cannot be used as an output folder: {}", error.message()),
                   "Choose a folder with write permission");
}

std::vector<FileMove> removeLinksWithin(const std::filesystem::path& output,
                                        const std::filesystem::path& below) {
  std::vector<FileMove> links;
  std::filesystem::path place = output;
  for (const std::filesystem::path& part : below) {
    place /= part;
    std::error_code error;
    const std::filesystem::path named = std::filesystem::read_symlink(place, error);
    if (!error && std::filesystem::remove(place, error)) links.push_back({named, place});
  }
  return links;
}

void makeFolderWithin(const std::filesystem::path& output, const std::filesystem::path& below) {
  removeLinksWithin(output, below);
  makeOutputFolder(output / below);
}

}  // namespace evical
