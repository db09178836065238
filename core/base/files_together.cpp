#include "core/base/files_together.h"

#include "core/base/file_places.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace evical {
namespace {

// 0, or the errno of a failure.
int writeAll(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

// An open file.
class OpenFile {
 public:
  OpenFile(int file, const std::filesystem::path& path) : file_(file), path_(path) {}
  ~OpenFile() {
    if (file_ >= 0) ::close(file_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  void write(std::string_view content) {
    if (const int error = writeAll(file_, content)) throw writeError(path_, error);
  }
  void close() {
    int error = ::fsync(file_) == 0 ? 0 : errno;
    if (::close(std::exchange(file_, -1)) != 0 && error == 0) error = errno;
    if (error != 0) throw writeError(path_, error);
  }

 private:
  int file_;
  const std::filesystem::path& path_;  // the final path
};

// mkostemp creates private files; results get the permissions that the user's other files have.
void giveUsualPermissions(int file) {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  static_cast<void>(::fchmod(file, 0666 & ~mask));
}

}  // namespace

FilesTogether::~FilesTogether() {
  for (const FileMove& each : files_) ::unlink(each.from.c_str());
  std::error_code ignored;
  std::sort(made_.begin(), made_.end());
  for (auto path = made_.rbegin(); path != made_.rend(); ++path) std::filesystem::remove(*path, ignored);
  for (const FileMove& link : links_) std::filesystem::create_symlink(link.from, link.to, ignored);
}

void FilesTogether::makeFolder(const std::filesystem::path& folder) {
  for (auto missing = folder; !missing.empty() && !pathExists(missing); missing = missing.parent_path())
    made_.push_back(missing);
  makeOutputFolder(folder);
}

void FilesTogether::write(const FileContent& file) {
  writeAt(file.path, file);
}

void FilesTogether::writeInto(const std::filesystem::path& folder, const FileContent& file) {
  const std::filesystem::path path = folder / file.path;
  for (FileMove& link : removeLinksWithin(folder, file.path.parent_path())) links_.push_back(std::move(link));
  makeFolder(path.parent_path());
  writeAt(path, file);
}

void FilesTogether::writeAt(const std::filesystem::path& path, const FileContent& file) {
  if (file.pieces) return write(path, file.pieces);
  write(path, [&](const TextSink& sink) { sink(file.content); });
}

void FilesTogether::write(const std::filesystem::path& path, const TextSource& content) {
  removeLitterOf(path);
  if (const int error = whyNoPlace(path)) throw writeError(path, error);
  std::string aside = path.string() + ".part.XXXXXX";
  const int file = ::mkostemp(aside.data(), O_CLOEXEC);
  if (file < 0) throw writeError(path, errno);
  files_.push_back({aside, path});
  giveUsualPermissions(file);
  OpenFile open(file, path);
  content([&](std::string_view piece) { open.write(piece); });
  open.close();
}

void FilesTogether::place() {
  moveFilesWhole(files_);
  files_.clear();
  made_.clear();
  links_.clear();
}

}  // namespace evical
