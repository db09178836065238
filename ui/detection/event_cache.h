// SPDX-License-Identifier: GPL-3.0-or-later
// All events of one camera where any instant can be looked up at once. Recordings are read once and in order;
// to scrub in them, their events are kept in a temporary file of 8 bytes an event (half of what a bag takes)
// that is gone when the cache is. Memory: an index of 24 bytes every 8192 events. Looking something up reads
// the blocks it lies in, about 10 ns an event while the system still has them in memory, whatever the place.
#pragma once

#include "core/data/event.h"
#include "ui/detection/cache_file.h"

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <vector>

namespace evical::ui {

class EventCache {
 public:
  // Throws CalibrationError if there can be no file in the folder.
  explicit EventCache(const std::filesystem::path& folder);

  // One thread writes, events in order of time; x and y below 32768. Throws CalibrationError
  // if the disk is full.
  void append(EventSpan events);
  void finish();  // no more will come

  // Any thread. Events before this time have all been stored; the largest time there is once finished.
  std::int64_t completeUntil_ns() const;
  std::int64_t lastEvent_ns() const;  // of those stored; the smallest time there is if none are
  std::uint64_t eventCount() const;
  // Appends the events with begin_ns <= time < end_ns in order of time, as far as they are stored.
  void gather(std::int64_t begin_ns, std::int64_t end_ns, std::vector<Event>& events) const;
  std::size_t count(std::int64_t begin_ns, std::int64_t end_ns) const;  // of what gather() would append

 private:
  struct Stored {
    std::uint32_t after_ns;  // since the block's first
    std::uint16_t x_px;
    std::uint16_t y_px_and_brighter;  // brighter in the lowest bit
  };
  static_assert(sizeof(Stored) == 8);
  struct Block {
    std::int64_t first_ns;
    std::uint64_t offset;  // in events
    std::uint64_t count;
  };

  void writeBlock();
  void readBlock(const Block& block, std::vector<Stored>& stored) const;
  std::vector<Block> blocksWithin(std::int64_t begin_ns, std::int64_t end_ns) const;
  std::span<const Stored> readWithin(const Block& block, std::int64_t begin_ns, std::int64_t end_ns,
                                     std::vector<Stored>& stored) const;

  CacheFile file_;
  std::vector<Stored> open_;  // the writer's own
  std::int64_t open_first_ns_ = 0, last_ns_ = 0;

  mutable std::mutex mutex_;
  std::vector<Block> blocks_;
  std::uint64_t written_ = 0;
  std::int64_t complete_until_ns_, last_written_ns_;
};

}  // namespace evical::ui
