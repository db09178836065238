// SPDX-License-Identifier: GPL-3.0-or-later
// All frames of one camera, with random access, in the encoding of the recording: in a temporary file of the
// same size. Memory: an index of about 80 bytes per frame.
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
  // Throws CalibrationError if no file can be created in the folder.
  explicit FrameCache(const std::filesystem::path& folder);

  // One thread writes; a frame that is not later than the previous one is skipped, as in the calibration.
  // Throws CalibrationError if the disk is full.
  void append(const Frame& frame);

  // Thread-safe; for the stored frames.
  std::size_t count() const;
  std::vector<std::int64_t> times_ns() const;
  std::optional<std::int64_t> lastTime_ns() const;
  std::optional<std::size_t> nearest(std::int64_t time_ns) const;  // none if no frame is stored
  std::int64_t time_ns(std::size_t frame) const;
  // Throws CalibrationError if the frame cannot be read.
  Frame frame(std::size_t frame) const;

 private:
  struct Stored {
    Frame head;  // without its data
    std::uint64_t offset = 0;
    std::size_t size = 0;
  };

  CacheFile file_;
  std::uint64_t end_ = 0;  // of the writing thread
  mutable std::mutex mutex_;
  std::vector<Stored> frames_;
};

}  // namespace evical::ui
