// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/event_cache.h"

#include <algorithm>
#include <limits>

namespace evical::ui {
namespace {

constexpr std::size_t kBlockEvents = 8192;
constexpr std::int64_t kLongestBlock_ns = std::numeric_limits<std::uint32_t>::max();

}  // namespace

EventCache::EventCache(const std::filesystem::path& folder)
    : file_(folder, {"events", "Free some space there: 8 bytes per event are needed"}),
      complete_until_ns_(std::numeric_limits<std::int64_t>::min()),
      last_written_ns_(complete_until_ns_) {
  open_.reserve(kBlockEvents);
}

void EventCache::append(EventSpan events) {
  for (const Event& event : events) {
    if (open_.size() == kBlockEvents || (!open_.empty() && event.time_ns - open_first_ns_ > kLongestBlock_ns))
      writeBlock();
    if (open_.empty()) open_first_ns_ = event.time_ns;
    last_ns_ = event.time_ns;
    open_.push_back({static_cast<std::uint32_t>(event.time_ns - open_first_ns_), event.x_px,
                     static_cast<std::uint16_t>(2 * event.y_px + event.brighter)});
  }
}

void EventCache::finish() {
  if (!open_.empty()) writeBlock();
  const std::lock_guard lock(mutex_);
  complete_until_ns_ = std::numeric_limits<std::int64_t>::max();
}

void EventCache::writeBlock() {
  file_.write(open_.data(), open_.size() * sizeof(Stored), written_ * sizeof(Stored));
  const std::lock_guard lock(mutex_);
  blocks_.push_back({open_first_ns_, written_, open_.size()});
  written_ += open_.size();
  complete_until_ns_ = last_written_ns_ = last_ns_;
  open_.clear();
}

std::int64_t EventCache::completeUntil_ns() const {
  const std::lock_guard lock(mutex_);
  return complete_until_ns_;
}

std::int64_t EventCache::lastEvent_ns() const {
  const std::lock_guard lock(mutex_);
  return last_written_ns_;
}

std::uint64_t EventCache::eventCount() const {
  const std::lock_guard lock(mutex_);
  return written_;
}

void EventCache::readBlock(const Block& block, std::vector<Stored>& stored) const {
  stored.resize(block.count);
  file_.read(stored.data(), stored.size() * sizeof(Stored), block.offset * sizeof(Stored));
}

std::vector<EventCache::Block> EventCache::blocksWithin(std::int64_t begin_ns, std::int64_t end_ns) const {
  const std::lock_guard lock(mutex_);
  const auto later = [](std::int64_t time_ns, const Block& block) { return time_ns <= block.first_ns; };
  auto first = std::upper_bound(blocks_.begin(), blocks_.end(), begin_ns, later);
  if (first != blocks_.begin()) --first;
  const auto last =
      std::find_if(first, blocks_.end(), [=](const Block& block) { return block.first_ns >= end_ns; });
  return {first, last};
}

std::span<const EventCache::Stored> EventCache::readWithin(const Block& block, std::int64_t begin_ns,
                                                           std::int64_t end_ns,
                                                           std::vector<Stored>& stored) const {
  readBlock(block, stored);
  const auto earlier = [&](const Stored& event, std::int64_t time_ns) {
    return block.first_ns + event.after_ns < time_ns;
  };
  const auto first = std::lower_bound(stored.begin(), stored.end(), begin_ns, earlier);
  return {first, std::lower_bound(first, stored.end(), end_ns, earlier)};
}

void EventCache::gather(std::int64_t begin_ns, std::int64_t end_ns, std::vector<Event>& events) const {
  if (begin_ns >= end_ns) return;
  std::vector<Stored> stored;
  for (const Block& block : blocksWithin(begin_ns, end_ns)) {
    for (const Stored& event : readWithin(block, begin_ns, end_ns, stored)) {
      events.push_back({block.first_ns + event.after_ns, event.x_px,
                        static_cast<std::uint16_t>(event.y_px_and_brighter >> 1),
                        (event.y_px_and_brighter & 1) != 0});
    }
  }
}

std::size_t EventCache::count(std::int64_t begin_ns, std::int64_t end_ns) const {
  if (begin_ns >= end_ns) return 0;
  const std::vector<Block> blocks = blocksWithin(begin_ns, end_ns);
  std::vector<Stored> stored;
  std::size_t count = 0;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    const bool whole = blocks[k].first_ns >= begin_ns && k + 1 < blocks.size();
    count += whole ? blocks[k].count : readWithin(blocks[k], begin_ns, end_ns, stored).size();
  }
  return count;
}

}  // namespace evical::ui
