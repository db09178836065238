#include "core/recording/live/lost_packets.h"

#include "core/base/number.h"
#include "core/base/time.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
namespace {

// Packets of drivers last 1 to 33 ms. Gaps of 4 times the largest one so far, in which 50 events are
// expected, are not chance; a lamp that flickers has regular ones.
constexpr double kMinGap_s = 5e-3, kTimesGap = 4.0, kMissingEvents = 50.0;
constexpr double kTimesPeriod = 1.8;

}  // namespace

void LostPackets::add(const Packet& packet) {
  if (!packet.events.empty()) addEvents(packet.events);
  for (const RawImuSample& sample : packet.imu_samples) addSample(sample.time_ns);
}

double LostPackets::typicalGap_s() const {
  std::array<double, kGaps> sorted = gaps_s_;
  std::sort(sorted.begin(), sorted.end());
  return samples_ ? sorted[kGaps / 2] : sorted.back();
}

void LostPackets::addEvents(EventSpan events) {
  const std::int64_t first_ns = events.front().time_ns, last_ns = events.back().time_ns;
  const double rate_hz =
      static_cast<double>(events.size() - 1) / std::max(kMinGap_s, secondsSince(first_ns, last_ns));
  if (last_ns_) {
    const double gap_s = secondsSince(*last_ns_, first_ns);
    const double missing = std::min(rate_hz, last_rate_hz_) * gap_s - 1.0;
    const bool lost = gaps_ >= kGaps && gap_s >= std::max(kMinGap_s, kTimesGap * typicalGap_s());
    if (lost && missing >= kMissingEvents) count(gap_s, missing);
    gaps_s_[gaps_++ % kGaps] = std::max(0.0, gap_s);
  } else {
    first_ns_ = first_ns;
  }
  last_ns_ = std::max(last_ns_.value_or(last_ns), last_ns);
  last_rate_hz_ = rate_hz;
}

void LostPackets::addSample(std::int64_t time_ns) {
  samples_ = true;
  if (last_ns_) {
    const double gap_s = secondsSince(*last_ns_, time_ns), period_s = typicalGap_s();
    if (gaps_ >= kGaps && gap_s > kTimesPeriod * period_s) count(gap_s, gap_s / period_s - 1.0);
    gaps_s_[gaps_++ % kGaps] = std::max(0.0, gap_s);
  } else {
    first_ns_ = time_ns;
  }
  last_ns_ = std::max(last_ns_.value_or(time_ns), time_ns);
}

void LostPackets::count(double gap_s, double missing) {
  if (lost_++ == 0) first_at_s_ = secondsSince(*first_ns_, *last_ns_);
  lost_s_ += gap_s;
  missing_ += missing;
}

std::optional<RecordingFault> LostPackets::fault(const std::string& stream) const {
  if (lost_ == 0) return std::nullopt;
  return RecordingFault{
      stream, FaultKind::LostMessages, first_at_s_,
      fmt::format(
          "About {:.0f} {} are missing in {} of {:.0f} ms in all, the first at {:.3f} s: the sender or "
          "the network dropped packets.",
          missing_, samples_ ? "samples" : "events", counted(lost_, "gap"), 1e3 * lost_s_, first_at_s_)};
}

}  // namespace evical
