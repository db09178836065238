// Statistics of one event stream for inspection, gathered packet by packet.
#pragma once

#include "core/recording/inspection.h"
#include "core/recording/stray_stamps.h"

#include <cstdint>
#include <vector>

namespace evical {

class EventStatistics {
 public:
  EventStatistics(const StreamInfo& info, const InspectionOptions& options);

  void add(EventSpan events);

  // Completes the summary's numbers and appends faults.
  void finish(StreamSummary& summary, std::vector<RecordingFault>& faults);

 private:
  static constexpr std::uint32_t kInterval_us = 5, kIntervals = 4000;

  unsigned rowsWith(unsigned y_px);
  void checkInterval(std::int64_t previous_ns, std::int64_t time_ns, std::uint64_t before);
  double shortestInterval_s() const;
  void findHotPixels(double duration_s, StreamSummary& summary, std::vector<RecordingFault>& faults) const;
  std::uint32_t neighbourMedian(int x_px, int y_px) const;
  void addFault(FaultKind kind, std::int64_t at_ns, std::string text);

  InspectionOptions options_;
  StreamSummary numbers_;
  std::vector<RecordingFault> faults_;
  struct Pixel {
    std::uint32_t events = 0, last_us = 0;  // time modulo 2^32
  };
  std::vector<Pixel> pixels_;             // row by row
  std::vector<std::uint32_t> intervals_;  // of one pixel, by their length in kInterval_us
  Resolution counted_px_;                 // of pixels_: as many rows as events reached
  int max_rows_ = 0;
  std::uint64_t outside_ = 0;
  StampStep stamp_step_;
  struct {
    std::uint64_t count = 0;   // of the events before it
    std::int64_t time_ns = 0;  // before it
  } last_step_;                // of hours
};

}  // namespace evical
