// SPDX-License-Identifier: GPL-3.0-or-later
// All frames of one camera where each can be looked up at once, as the recording holds them: in a temporary file
// as large as they are there. Memory: an index of some 80 bytes a frame.
#pragma once

#include "core/data/frame.h"
#include "ui/detection/cache_file.h"

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <vector>

namespace evical::ui {

class FrameCache {
 public:
  // Throws CalibrationError if there can be no file in the folder.
  explicit FrameCache(const std::filesystem::path& folder);

  // One thread writes; a frame that is not later than the one before is left out, as the calibration does. Throws
  // CalibrationError if the disk is full.
  void append(const Frame& frame);

  // Any thread; of the frames that have been stored.
  std::size_t count() const;
  std::vector<std::int64_t> times_ns() const;
  std::optional<std::int64_t> lastTime_ns() const;
  std::optional<std::size_t> nearest(std::int64_t time_ns) const;  // nothing where there is none yet
  std::int64_t time_ns(std::size_t frame) const;
  // Throws CalibrationError if it cannot be read.
  Frame frame(std::size_t frame) const;

 private:
  struct Stored {
    Frame head;  // without its bytes
    std::uint64_t offset = 0;
    std::size_t size = 0;
  };

  CacheFile file_;
  std::uint64_t end_ = 0;  // the writer's own
  mutable std::mutex mutex_;
  std::vector<Stored> frames_;
};

}  // namespace evical::ui
