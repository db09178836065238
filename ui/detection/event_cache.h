// SPDX-License-Identifier: GPL-3.0-or-later
// All events of one camera, with random access by time. The recording is read once, in order; its events are
// stored in a temporary file of 8 bytes per event (half of a bag's), which is deleted with the cache. Memory:
// an index of 24 bytes per 8192 events. A look-up reads the blocks around it, at about 10 ns per event at any
// place while the system has them in memory.
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
  // Throws CalibrationError if no file can be created in the folder.
  explicit EventCache(const std::filesystem::path& folder);

  // One thread writes, in order of time; x and y below 32768. Throws CalibrationError if the disk is full.
  void append(EventSpan events);
  void finish();  // no more events

  // Thread-safe. All events before this time have been stored; the maximum of the type after finish().
  std::int64_t completeUntil_ns() const;
  std::int64_t lastEvent_ns() const;  // last stored event; the minimum of the type if none
  std::uint64_t eventCount() const;
  // Appends the stored events with begin_ns <= time < end_ns, in order of time.
  void gather(std::int64_t begin_ns, std::int64_t end_ns, std::vector<Event>& events) const;
  std::size_t count(std::int64_t begin_ns, std::int64_t end_ns) const;  // number that gather() would append

 private:
  struct Stored {
    std::uint32_t after_ns;  // since the block's first event
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
  std::vector<Stored> open_;  // of the writing thread
  std::int64_t open_first_ns_ = 0, last_ns_ = 0;

  mutable std::mutex mutex_;
  std::vector<Block> blocks_;
  std::uint64_t written_ = 0;
  std::int64_t complete_until_ns_, last_written_ns_;
};

}  // namespace evical::ui
