// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/frame_cache.h"

#include <algorithm>

namespace evical::ui {
namespace {

constexpr auto kEarlier = [](const auto& stored, std::int64_t time_ns) {
  return stored.head.time_ns < time_ns;
};
Frame withoutBytes(const Frame& frame) {
  Frame head;
  head.time_ns = frame.time_ns;
  head.exposure_s = frame.exposure_s;
  head.format = frame.format;
  head.big_endian = frame.big_endian;
  head.size_px = frame.size_px;
  head.row_bytes = frame.row_bytes;
  return head;
}

}  // namespace

FrameCache::FrameCache(const std::filesystem::path& folder)
    : file_(folder, {"frames", "Free some space there: as much as the frames take in the recording"}) {}

void FrameCache::append(const Frame& frame) {
  if (const auto last_ns = lastTime_ns(); last_ns && frame.time_ns <= *last_ns) return;
  file_.write(frame.bytes.data(), frame.bytes.size(), end_);
  const std::lock_guard lock(mutex_);
  frames_.push_back({withoutBytes(frame), end_, frame.bytes.size()});
  end_ += frame.bytes.size();
}

std::size_t FrameCache::count() const {
  const std::lock_guard lock(mutex_);
  return frames_.size();
}

std::vector<std::int64_t> FrameCache::times_ns() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::int64_t> times_ns;
  times_ns.reserve(frames_.size());
  for (const Stored& stored : frames_) times_ns.push_back(stored.head.time_ns);
  return times_ns;
}

std::optional<std::int64_t> FrameCache::lastTime_ns() const {
  const std::lock_guard lock(mutex_);
  return frames_.empty() ? std::nullopt : std::optional(frames_.back().head.time_ns);
}

std::optional<std::size_t> FrameCache::nearest(std::int64_t time_ns) const {
  const std::lock_guard lock(mutex_);
  if (frames_.empty()) return std::nullopt;
  const auto after = std::lower_bound(frames_.begin(), frames_.end(), time_ns, kEarlier);
  const bool before =
      after != frames_.begin() &&
      (after == frames_.end() || time_ns - std::prev(after)->head.time_ns < after->head.time_ns - time_ns);
  return static_cast<std::size_t>((before ? std::prev(after) : after) - frames_.begin());
}

std::int64_t FrameCache::time_ns(std::size_t frame) const {
  const std::lock_guard lock(mutex_);
  return frames_[frame].head.time_ns;
}

Frame FrameCache::frame(std::size_t frame) const {
  Stored stored;
  {
    const std::lock_guard lock(mutex_);
    stored = frames_[frame];
  }
  stored.head.bytes.resize(stored.size);
  file_.read(stored.head.bytes.data(), stored.size, stored.offset);
  return std::move(stored.head);
}

}  // namespace evical::ui
