// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/growing_recording.h"

#include <algorithm>
#include <system_error>

namespace evical::ui {
namespace {

constexpr int kPoll_ms = 1000;
constexpr int kWorthALook_ms = 3000;  // duration of growth before a check
constexpr int kEnded_ms = 5000;       // without growth

}  // namespace

std::uintmax_t bytesOf(const std::vector<std::filesystem::path>& files) {
  namespace fs = std::filesystem;
  // Results of this program in a recording's folder do not count as growth.
  const auto isOwnFile = [](const fs::path& file) { return file.extension() == ".yaml"; };
  const auto isOwnFolder = [](const fs::path& folder) {
    std::error_code ignored;
    return fs::exists(folder / "result.yaml", ignored) || fs::exists(folder / "run_session.yaml", ignored) ||
           folder.filename().string().starts_with('.');
  };
  std::uintmax_t sum = 0;
  std::error_code error;
  const auto add = [&](const fs::path& file) {
    const std::uintmax_t size = fs::file_size(file, error);
    if (!error) sum += size;
  };
  for (const fs::path& path : files) {
    if (!fs::is_directory(path, error)) {
      add(path);
      continue;
    }
    fs::recursive_directory_iterator entry(path, fs::directory_options::skip_permission_denied, error), end;
    while (!error && entry != end) {
      if (entry->is_directory(error) && isOwnFolder(entry->path())) entry.disable_recursion_pending();
      if (entry->is_regular_file(error) && !isOwnFile(entry->path())) add(entry->path());
      entry.increment(error);
    }
  }
  return sum;
}

GrowingRecording::GrowingRecording(QObject* parent) : QObject(parent) {
  timer_.setInterval(kPoll_ms);
  connect(&timer_, &QTimer::timeout, this, &GrowingRecording::poll);
}

void GrowingRecording::setFiles(const std::vector<std::filesystem::path>& files) {
  if (files == files_) return;
  setFollowing(false);
  files_ = files;
  known_ = grown_ = followed_to_end_ = looking_ = false;
  size_ = seen_size_ = 0;
  size_job_.discard();
  if (files_.empty()) return timer_.stop();
  timer_.start();
  poll();
}

void GrowingRecording::setFollowing(bool following) {
  if (following == following_) return;
  following_ = following;
  followed_to_end_ = false;
  seen_size_ = 0;
  since_growth_.start();
  since_look_.start();
  emit followingChanged(following);
}

void GrowingRecording::lookBegan() {
  looking_ = true;
  seen_size_ = size_;
  since_look_.start();
}

void GrowingRecording::lookEnded() {
  looking_ = false;
}

void GrowingRecording::poll() {
  if (size_job_.busy()) return;
  size_job_.start([this, files = files_](const std::stop_token&) {
    const std::uintmax_t size = bytesOf(files);
    return [this, size] { take(size); };
  });
}

void GrowingRecording::take(std::uintmax_t size) {
  if (!known_) opened_size_ = size_ = size;
  known_ = true;
  if (size != size_) since_growth_.start();
  size_ = size;
  if (!grown_ && size > opened_size_) {
    grown_ = true;
    emit growthNoticed();
  }
  if (!following_ || looking_) return;
  const bool ended = since_growth_.elapsed() >= kEnded_ms;
  if (size_ != seen_size_) {
    if (ended || since_look_.elapsed() >= kWorthALook_ms) emit lookWanted();
    return;
  }
  if (!ended) return;
  // The recording may continue later.
  opened_size_ = size_;
  grown_ = false;
  setFollowing(false);
  followed_to_end_ = true;
  emit endReached();
}

}  // namespace evical::ui
