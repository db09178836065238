// Packets that a server dropped without a mark, as it does for a slow client: gaps in one stream that its own
// rate and its earlier gaps do not explain.
#pragma once

#include "core/data/recording.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace evical {

class LostPackets {
 public:
  // The next packet of the stream: events or samples.
  void add(const Packet& packet);

  // If there were any. `stream`: its name.
  std::optional<RecordingFault> fault(const std::string& stream) const;

 private:
  static constexpr std::size_t kGaps = 32;

  void addEvents(EventSpan events);
  void addSample(std::int64_t time_ns);
  void count(double gap_s, double missing);
  double typicalGap_s() const;  // the largest one for events, the median of samples

  std::array<double, kGaps> gaps_s_ = {};
  std::size_t gaps_ = 0;
  std::optional<std::int64_t> first_ns_, last_ns_;
  double last_rate_hz_ = 0.0;
  bool samples_ = false;
  std::uint64_t lost_ = 0;  // gaps
  double lost_s_ = 0.0, missing_ = 0.0, first_at_s_ = 0.0;
};

}  // namespace evical
