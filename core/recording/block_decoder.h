// Decoder of the bytes after a file's header into events, block by block; see block_reader.h.
#pragma once

#include "core/data/event.h"
#include "core/data/frame.h"
#include "core/data/imu_units.h"
#include "core/geometry/resolution.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace evical {

// Number of occurrences, and the byte of the first one in the file.
struct Occurrences {
  std::uint64_t count = 0, first_byte = 0;
  void add(std::uint64_t byte) {
    if (count++ == 0) first_byte = byte;
  }
};

// Data that decoders drop or count; the reader reports them as faults.
struct BlockFindings {
  Occurrences outside;               // events beyond the sensor
  Occurrences untimed;               // events before the first complete time
  Occurrences unknown;               // records of no known kind
  Occurrences wraps;                 // of the time, which continues
  Occurrences imu;                   // IMU records without a known scale
  Occurrences exposure;              // events that measure grey levels and belong to no frame
  std::uint64_t rolling_frames = 0;  // exposed column by column
  std::uint64_t triggers = 0;
};

class BlockDecoder {
 public:
  virtual ~BlockDecoder() = default;

  // Appends the events of all whole records at the front of `bytes`, which are at `offset` in the file;
  // returns the size of these records in bytes.
  virtual std::size_t decode(std::string_view bytes, std::uint64_t offset, std::vector<Event>& events) = 0;

  const BlockFindings& findings() const { return findings_; }

  // IMU samples between the events, since the vector was last emptied; for formats with an IMU.
  std::vector<RawImuSample>& imuSamples() { return imu_samples_; }
  // Frames, as above.
  virtual std::vector<Frame>* frames() { return nullptr; }
  virtual void finish() {}  // called at the file's end

 protected:
  std::vector<RawImuSample> imu_samples_;
  BlockFindings findings_;
};

// Range of valid coordinates on the sensor; all if its size is unknown.
class SensorArea {
 public:
  SensorArea() = default;
  explicit SensorArea(const Resolution& size_px)
      : width_(size_px.known() ? static_cast<unsigned>(size_px.width_px) : 65536),
        height_(size_px.known() ? static_cast<unsigned>(size_px.height_px) : 65536) {}
  bool holds(unsigned x_px, unsigned y_px) const { return x_px < width_ && y_px < height_; }

 private:
  unsigned width_ = 65536, height_ = 65536;
};

// Appends to a vector without a check per event: room for `most` is reserved first.
class EventAppender {
 public:
  explicit EventAppender(std::vector<Event>& events) : events_(events), count_(events.size()) {}
  ~EventAppender() { events_.resize(count_); }
  EventAppender(const EventAppender&) = delete;
  EventAppender& operator=(const EventAppender&) = delete;

  void reserve(std::size_t most) {
    if (events_.size() - count_ < most) events_.resize(count_ + std::max(most, count_));
  }
  void add(std::int64_t time_ns, unsigned x_px, unsigned y_px, bool brighter) {
    events_[count_++] = {time_ns, static_cast<std::uint16_t>(x_px), static_cast<std::uint16_t>(y_px),
                         brighter};
  }

 private:
  std::vector<Event>& events_;
  std::size_t count_;
};

}  // namespace evical
