#include "core/recording/ros/event_packet_decoder.h"

#include "core/base/time.h"
#include "core/recording/prophesee/word_decoders.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace evical::ros {
namespace {

constexpr std::int64_t kSpan_ns = 3'000'000'000;
constexpr std::size_t kFewestForDrift = 5;  // spans; a drift of 20 ppm is then 0.3 ms, the jitter of delays
constexpr double kNs_s = 1e-9;

}  // namespace

void HostClock::add(std::int64_t sensor_ns, std::int64_t host_ns) {
  const Earliest candidate{sensor_ns, host_ns - sensor_ns};
  const auto [found, is_new] = earliest_.try_emplace(sensor_ns / kSpan_ns, candidate);
  if (!is_new && candidate.offset_ns < found->second.offset_ns) found->second = candidate;
}

std::optional<HostClockOffset> HostClock::offset() const {
  if (earliest_.empty()) return std::nullopt;
  const auto lower = [](const auto& a, const auto& b) { return a.second.offset_ns < b.second.offset_ns; };
  const std::int64_t min_ns = std::min_element(earliest_.begin(), earliest_.end(), lower)->second.offset_ns;
  if (earliest_.size() < kFewestForDrift) return HostClockOffset{kNs_s * static_cast<double>(min_ns), {}};
  // Least-squares line, with numbers small enough for doubles.
  const std::int64_t first_ns = earliest_.begin()->second.sensor_ns;
  double mean_t = 0.0, mean_o = 0.0, tt = 0.0, to = 0.0;
  const auto count = static_cast<double>(earliest_.size());
  const auto seconds = [&](const Earliest& e) { return kNs_s * static_cast<double>(e.sensor_ns - first_ns); };
  const auto beyond = [&](const Earliest& e) { return kNs_s * static_cast<double>(e.offset_ns - min_ns); };
  for (const auto& [span, earliest] : earliest_) {
    mean_t += seconds(earliest) / count;
    mean_o += beyond(earliest) / count;
  }
  for (const auto& [span, earliest] : earliest_) {
    tt += (seconds(earliest) - mean_t) * (seconds(earliest) - mean_t);
    to += (seconds(earliest) - mean_t) * (beyond(earliest) - mean_o);
  }
  const double middle_s = 0.5 * seconds(earliest_.rbegin()->second);
  const double slope = to / tt;
  return HostClockOffset{kNs_s * static_cast<double>(min_ns) + mean_o + slope * (middle_s - mean_t),
                         1e6 * slope};
}

namespace {

constexpr std::int64_t kLongest_us = std::int64_t{1} << 41;  // per message; larger times are damage
constexpr std::int64_t kLatestBase_ns = kLatestTime_ns - 1000 * 2 * kLongest_us;

template <class Word>
Word wordAt(std::string_view bytes, std::size_t position) {
  Word word{};
  std::memcpy(&word, bytes.data() + position, sizeof word);
  return word;
}

// u64: bits 0-31 ns since the time base, 32-47 x, 48-62 y, 63 polarity.
void decodeMono(const EventPacket& packet, std::vector<Event>& events) {
  for (std::size_t i = 0; i + 8 <= packet.events.size(); i += 8) {
    const auto word = wordAt<std::uint64_t>(packet.events, i);
    events.push_back({packet.time_base_ns + static_cast<std::int64_t>(word & 0xFFFFFFFFU),
                      static_cast<std::uint16_t>(word >> 32),
                      static_cast<std::uint16_t>(word >> 48 & 0x7FFFU), word >> 63 != 0});
  }
}

// u32: bit 0 valid, 1 polarity, 2-16 y, 17-31 x; then i32 us since the time base.
bool decodeLibcaer(const EventPacket& packet, std::vector<Event>& events) {
  constexpr std::int64_t kWrap_us = std::int64_t{1} << 31;
  std::int64_t wraps_us = 0, last_us = 0;
  for (std::size_t i = 0; i + 8 <= packet.events.size(); i += 8) {
    const auto word = wordAt<std::uint32_t>(packet.events, i);
    if ((word & 1U) == 0) continue;
    const std::int64_t stamp_us = wordAt<std::int32_t>(packet.events, i + 4);
    if (stamp_us < last_us - kWrap_us / 2) wraps_us += kWrap_us;
    if (wraps_us > kLongest_us) return false;
    last_us = stamp_us;
    events.push_back({packet.time_base_ns + 1000 * (wraps_us + stamp_us),
                      static_cast<std::uint16_t>(word >> 17), static_cast<std::uint16_t>(word >> 2 & 0x7FFFU),
                      (word & 2U) != 0});
  }
  return true;
}

// u16 words, code in bits 12-15; each message starts without a state.
void decodeLibcaerCmp(const EventPacket& packet, std::vector<Event>& events) {
  std::int64_t high_us = 0, low_us = 0;
  std::uint32_t x_px = 0, y_px = 0;
  bool brighter = false;
  const auto add = [&](std::uint32_t x, std::uint32_t y) {
    events.push_back({packet.time_base_ns + 1000 * (high_us | low_us), static_cast<std::uint16_t>(x),
                      static_cast<std::uint16_t>(y), brighter});
  };
  for (std::size_t i = 0; i + 2 <= packet.events.size(); i += 2) {
    const auto word = wordAt<std::uint16_t>(packet.events, i);
    switch (word >> 12) {
      case 0:
        high_us = (word & 0xFFF) << 12;
        break;
      case 1:
        low_us = word & 0xFFF;
        break;
      case 2:
        x_px = word & 0x7FFU;
        break;
      case 3:
        brighter = (word & 0x800) != 0;
        add(x_px, word & 0x7FFU);
        break;
      case 4:
        y_px = word & 0x7FFU;
        brighter = (word & 0x800) != 0;
        break;
      case 5:
        for (std::uint32_t bit = 0; bit < 8; ++bit)
          if ((word >> bit & 1) != 0) add(x_px, y_px + bit);
        y_px += 8;
        break;
      default:
        break;
    }
  }
}

// Words of a packet, from a few of them on, nearly all of a known kind.
template <class Word, class Fits>
bool fitsWords(std::string_view bytes, const Fits& fits) {
  constexpr double kNearlyAll = 0.99;
  const std::size_t words = bytes.size() / sizeof(Word);
  std::size_t good = 0;
  for (std::size_t i = 0; i < words; ++i) good += fits(wordAt<Word>(bytes, i * sizeof(Word))) ? 1 : 0;
  return static_cast<double>(good) >= kNearlyAll * static_cast<double>(words);
}

// Kinds of EVT2 and EVT2.1: off, on, high time, trigger, IMU, others, continued.
bool isKnownKind(unsigned kind) {
  return kind <= 1 || kind == 8 || kind == 0xA || kind >= 0xD;
}

// The columns of EVT2.1's vectors begin at multiples of 32.
bool isEvt21(std::uint64_t word) {
  const auto kind = static_cast<unsigned>(word >> 60);
  return isKnownKind(kind) && (kind > 1 || (word >> 43 & 0x1F) == 0);
}

bool fits(Encoding encoding, std::string_view bytes) {
  switch (encoding) {
    case Encoding::Evt2:
      return fitsWords<std::uint32_t>(bytes, [](std::uint32_t word) { return isKnownKind(word >> 28); });
    case Encoding::Evt21:
      return fitsWords<std::uint64_t>(bytes, isEvt21) ||
             fitsWords<std::uint64_t>(bytes, [](std::uint64_t word) { return isEvt21(std::rotl(word, 32)); });
    default:
      return fitsWords<std::uint16_t>(bytes, [](unsigned word) {
        const unsigned kind = word >> 12;
        return kind != 1 && kind != 9 && (kind < 0xB || kind > 0xD);
      });
  }
}

}  // namespace

Encoding encodingOf(std::string_view name) {
  if (name == "evt2") return Encoding::Evt2;
  if (name == "evt21") return Encoding::Evt21;
  if (name == "evt3") return Encoding::Evt3;
  if (name == "mono") return Encoding::Mono;
  if (name == "trigger") return Encoding::Trigger;
  if (name == "libcaer") return Encoding::Libcaer;
  return name == "libcaer_cmp" ? Encoding::LibcaerCmp : Encoding::Unknown;
}

bool EventPacketDecoder::decode(const EventPacket& packet, std::vector<Event>& events) {
  followSequence(packet.sequence);
  if (packet.big_endian) return false;
  const std::size_t size = packet.events.size();
  const Encoding encoding = encodingOf(packet.encoding);
  const bool has_base = !isOfSensor(encoding) && encoding != Encoding::Trigger;
  if (has_base && (packet.time_base_ns < 0 || packet.time_base_ns > kLatestBase_ns)) return false;
  switch (encoding) {
    case Encoding::Evt2:
    case Encoding::Evt21:
    case Encoding::Evt3:
      if (words_encoding_ == Encoding::Unknown) lookAtWords(packet, encoding);
      decodeWords(packet, events);
      return size % 2 == 0;
    case Encoding::Mono:
      decodeMono(packet, events);
      return size % 8 == 0;
    case Encoding::Trigger:
      triggers_ += size / 8;
      return size % 8 == 0;
    case Encoding::Libcaer:
      return decodeLibcaer(packet, events) && size % 8 == 0;
    case Encoding::LibcaerCmp:
      decodeLibcaerCmp(packet, events);
      return size % 2 == 0;
    case Encoding::Unknown:
      break;
  }
  return false;
}

void EventPacketDecoder::followSequence(std::uint64_t sequence) {
  const std::uint64_t expected = last_sequence_ + 1;
  if (has_sequence_ && sequence != expected) {
    lost_messages_ += sequence > expected ? sequence - expected : 0;
    evt3_.forgetPosition();
  }
  has_sequence_ = true;
  last_sequence_ = sequence;
}

// Drivers may state another encoding than the sensor's.
void EventPacketDecoder::lookAtWords(const EventPacket& packet, Encoding stated) {
  constexpr std::size_t kEnough_bytes = 256;
  Encoding content = stated;
  if (!fits(stated, packet.events) && packet.events.size() >= kEnough_bytes) {
    for (const Encoding other : {Encoding::Evt21, Encoding::Evt2, Encoding::Evt3})
      if (content == stated && other != stated && fits(other, packet.events)) content = other;
    other_encoding_ = content == stated            ? ""
                      : content == Encoding::Evt21 ? "evt21"
                      : content == Encoding::Evt2  ? "evt2"
                                                   : "evt3";
  }
  if (packet.events.size() >= kEnough_bytes) words_encoding_ = content;
  if (words_ || content == Encoding::Evt3) return;
  if (content == Encoding::Evt2) {
    words_ = std::make_unique<prophesee::Evt2Decoder>(packet.resolution_px);
  } else {
    const bool exchanged = !fitsWords<std::uint64_t>(packet.events, isEvt21);
    words_ = std::make_unique<prophesee::Evt21Decoder>(packet.resolution_px, exchanged);
  }
}

void EventPacketDecoder::decodeWords(const EventPacket& packet, std::vector<Event>& events) {
  evt3_.setResolution(packet.resolution_px);
  const std::size_t before = events.size();
  if (words_)
    words_->decode(packet.events, 0, events);
  else
    evt3_.decode(packet.events, events);
  if (events.size() > before && packet.stamp_ns != 0)
    host_clock_.add(events[before].time_ns, packet.stamp_ns);
}

}  // namespace evical::ros
