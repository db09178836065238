// Continues times of counters that wrap: a counter of microseconds in 32 bits does after 71.6 min. Readers of
// formats whose counters have a known width do this themselves; tables and messages contain counters of any
// driver. States which streams have times that cannot be true.
#pragma once

#include "core/recording/plausible_times.h"
#include "core/recording/recording_reader.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace evical {

// A step back by the range of a usual counter, within the time to the next item, is a wrap.
class WrapDetector {
 public:
  // The time with all wraps so far.
  std::int64_t unwrap(std::int64_t time_ns);

  std::int64_t wrapped_ns() const { return wrapped_ns_; }
  std::int64_t last_ns() const { return last_ns_; }  // as recorded
  int wraps() const { return wraps_; }
  std::int64_t range_ns() const { return range_ns_; }
  bool started() const { return started_; }
  void startWith(std::int64_t wrapped_ns) { wrapped_ns_ = wrapped_ns; }

 private:
  bool started_ = false;
  std::int64_t last_ns_ = 0, wrapped_ns_ = 0, range_ns_ = 0;
  int wraps_ = 0;
};

class UnwrappedReader : public RecordingReader {
 public:
  explicit UnwrappedReader(std::unique_ptr<RecordingReader> reader);

  const std::vector<StreamInfo>& streams() const override { return reader_->streams(); }
  void select(const std::vector<std::size_t>& streams) override { reader_->select(streams); }
  bool read(Packet& packet) override;
  bool follow(const std::shared_ptr<Growth>& growth) override { return reader_->follow(growth); }
  double fractionRead() const override { return reader_->fractionRead(); }
  const std::vector<RecordingFault>& faults() const override;
  std::string format() const override { return reader_->format(); }

 private:
  void start(WrapDetector& detector, std::int64_t first_ns) const;

  std::unique_ptr<RecordingReader> reader_;
  std::vector<WrapDetector> detectors_;  // by stream
  std::vector<SeenTimes> seen_;          // by stream
  mutable std::vector<RecordingFault> faults_;
};

}  // namespace evical
