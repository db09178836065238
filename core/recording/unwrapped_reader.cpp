#include "core/recording/unwrapped_reader.h"

#include "core/base/time.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace evical {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
// Ranges of counters in ns: 32, 31 and 24 bits of us, 32 bits of ns, 16 and 32 bits of ms.
constexpr std::array<std::int64_t, 6> kRanges_ns = {
    (std::int64_t{1} << 32) * kMicrosecond_ns, (std::int64_t{1} << 31) * kMicrosecond_ns,
    (std::int64_t{1} << 24) * kMicrosecond_ns, std::int64_t{1} << 32,
    (std::int64_t{1} << 16) * kMillisecond_ns, (std::int64_t{1} << 32) * kMillisecond_ns};
// A wrap and a later item from before it, both out of order by at most this.
constexpr std::int64_t kDisorder_ns = 10 * kMillisecond_ns;

// Longest time from the last item before a wrap to the first one after it. A counter that starts anywhere, or
// has an offset, is recognised by its step only, which must then be more exact, and not short.
std::int64_t longest_ns(std::int64_t range_ns, std::int64_t last_ns, std::int64_t time_ns) {
  constexpr std::int64_t kShare = 100, kMin_ns = kSecond_ns / 4, kMax_ns = 60 * kSecond_ns;
  constexpr std::int64_t kExact_ns = kSecond_ns / 10, kLongRange_ns = 1000 * kSecond_ns;
  const bool without_sign = last_ns < range_ns && time_ns >= 0;
  const bool with_sign = last_ns < range_ns / 2 && time_ns >= -range_ns / 2;
  if (without_sign || with_sign) return std::clamp(range_ns / kShare, kMin_ns, kMax_ns);
  return range_ns > kLongRange_ns ? kExact_ns : -1;
}

template <class Items>
void unwrapAll(WrapDetector& detector, Items& items) {
  for (auto& item : items) item.time_ns = detector.unwrap(item.time_ns);
}

std::int64_t earliest_ns(const Packet& packet) {
  if (!packet.events.empty()) return packet.events.front().time_ns;
  if (!packet.imu_samples.empty()) return packet.imu_samples.front().time_ns;
  return packet.frames.empty() ? packet.points.front().time_ns : packet.frames.front().time_ns;
}

}  // namespace

std::int64_t WrapDetector::unwrap(std::int64_t time_ns) {
  const std::int64_t back_ns = last_ns_ - time_ns;
  if (started_ && wraps_ > 0 && std::abs(back_ns + range_ns_) <= kDisorder_ns)
    return time_ns + wrapped_ns_ - range_ns_;
  if (started_ && back_ns > kSecond_ns) {
    for (const std::int64_t range_ns : kRanges_ns) {
      const std::int64_t ahead_ns = range_ns - back_ns;
      if (ahead_ns < -kDisorder_ns || ahead_ns > longest_ns(range_ns, last_ns_, time_ns)) continue;
      wrapped_ns_ += range_ns;
      range_ns_ = range_ns;
      ++wraps_;
      break;
    }
  }
  started_ = true;
  last_ns_ = time_ns;
  return time_ns + wrapped_ns_;
}

UnwrappedReader::UnwrappedReader(std::unique_ptr<RecordingReader> reader) : reader_(std::move(reader)) {}

// A stream that starts after another one of the recording has wrapped.
void UnwrappedReader::start(WrapDetector& detector, std::int64_t first_ns) const {
  for (const WrapDetector& other : detectors_)
    if (other.wraps() > 0 && std::abs(other.last_ns() - first_ns) < kSecond_ns)
      detector.startWith(other.wrapped_ns());
}

bool UnwrappedReader::read(Packet& packet) {
  if (!reader_->read(packet)) return false;
  if (detectors_.size() < reader_->streams().size()) detectors_.resize(reader_->streams().size());
  WrapDetector& detector = detectors_[packet.stream];
  if (packet.empty()) return true;
  if (!detector.started()) start(detector, earliest_ns(packet));
  if (!packet.events.empty()) {  // in order, so that a wrap is only between packets
    const std::int64_t first_ns = packet.events.front().time_ns, last_ns = packet.events.back().time_ns;
    const std::int64_t add_ns = detector.unwrap(first_ns) - first_ns;
    static_cast<void>(detector.unwrap(last_ns));
    if (add_ns != 0)
      for (Event& event : packet.events) event.time_ns += add_ns;
  }
  unwrapAll(detector, packet.imu_samples);
  unwrapAll(detector, packet.frames);
  unwrapAll(detector, packet.points);
  seen_.resize(detectors_.size());
  if (reader_->streams()[packet.stream].timed) seen_[packet.stream].add(packet);
  return true;
}

const std::vector<RecordingFault>& UnwrappedReader::faults() const {
  faults_.clear();
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    const StreamInfo& info = reader_->streams()[k];
    if (const auto why = whyImplausible(info.type, seen_[k]))
      faults_.push_back({info.name, FaultKind::Unit, 0.0, *why});
  }
  const std::vector<RecordingFault>& own = reader_->faults();
  faults_.insert(faults_.end(), own.begin(), own.end());
  for (std::size_t k = 0; k < detectors_.size(); ++k)
    if (const WrapDetector& detector = detectors_[k]; detector.wraps() > 0)
      faults_.push_back(
          {reader_->streams()[k].name, FaultKind::TimeWrap, 0.0,
           fmt::format("The time counter wraps {} (its range is {:.6g} s): times continue.",
                       detector.wraps() == 1 ? "once" : fmt::format("{} times", detector.wraps()),
                       secondsSince(0, detector.range_ns()))});
  return faults_;
}

}  // namespace evical
