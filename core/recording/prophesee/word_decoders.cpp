#include "core/recording/prophesee/word_decoders.h"
#include "core/base/time.h"

#include <bit>
#include <cstring>

namespace evical::prophesee {
namespace {

constexpr int kLowBits = 6;  // of the time, in the words of events

// Kinds of words in EVT 2.0 and 2.1.
enum : unsigned {
  kOff = 0,
  kOn = 1,
  kTimeHigh = 8,
  kTrigger = 0xA,
  kImu = 0xD,
  kOthers = 0xE,
  kContinued = 0xF
};

template <class Word>
Word packedWordAt(std::string_view bytes, std::size_t index) {
  Word word;
  std::memcpy(&word, bytes.data() + index * sizeof(Word), sizeof(Word));
  return word;
}

std::int64_t highTime(std::uint64_t count, WrappingCounter& counter, Occurrences& wraps, std::uint64_t byte) {
  bool wrapped = false;
  const std::uint64_t high = counter.unwrap(count, wrapped);
  if (wrapped) wraps.add(byte);
  return static_cast<std::int64_t>(high << kLowBits) * kMicrosecond_ns;
}

std::uint64_t inOrder(std::uint64_t word, bool halves_exchanged) {
  return halves_exchanged ? std::rotl(word, 32) : word;
}

}  // namespace

std::size_t Evt2Decoder::decode(std::string_view bytes, std::uint64_t offset, std::vector<Event>& events) {
  const std::size_t words = bytes.size() / sizeof(std::uint32_t);
  EventAppender appender(events);
  appender.reserve(words);
  for (std::size_t i = 0; i < words; ++i) {
    const auto word = packedWordAt<std::uint32_t>(bytes, i);
    const unsigned kind = word >> 28;
    if (kind > kOn) {
      other(word, offset + i * sizeof word);
      continue;
    }
    const unsigned x = (word >> 11) & 0x7FF, y = word & 0x7FF;
    if (!has_time_) {
      findings_.untimed.add(offset + i * sizeof word);
    } else if (!area_.holds(x, y)) {
      findings_.outside.add(offset + i * sizeof word);
    } else {
      appender.add(high_ns_ + ((word >> 22) & 0x3F) * kMicrosecond_ns, x, y, kind == kOn);
    }
  }
  return words * sizeof(std::uint32_t);
}

void Evt2Decoder::other(std::uint32_t word, std::uint64_t byte) {
  switch (word >> 28) {
    case kTimeHigh:
      high_ns_ = highTime(word & 0xFFFFFFF, high_, findings_.wraps, byte);
      has_time_ = true;
      break;
    case kTrigger:
      ++findings_.triggers;
      break;
    case kImu:
      findings_.imu.add(byte);
      break;
    case kOthers:
    case kContinued:
      break;
    default:
      findings_.unknown.add(byte);
  }
}

std::size_t Evt21Decoder::decode(std::string_view bytes, std::uint64_t offset, std::vector<Event>& events) {
  constexpr std::size_t kMaxEvents = 32;  // per word
  const std::size_t words = bytes.size() / sizeof(std::uint64_t);
  EventAppender appender(events);
  for (std::size_t i = 0; i < words; ++i) {
    const std::uint64_t word = inOrder(packedWordAt<std::uint64_t>(bytes, i), halves_exchanged_);
    if (word >> 60 > kOn) {
      other(word, offset + i * sizeof word);
      continue;
    }
    appender.reserve(kMaxEvents);
    vector(word, offset + i * sizeof word, appender);
  }
  return words * sizeof(std::uint64_t);
}

void Evt21Decoder::vector(std::uint64_t word, std::uint64_t byte, EventAppender& events) {
  auto mask = static_cast<std::uint32_t>(word);
  if (!has_time_) {
    for (; mask != 0; mask &= mask - 1) findings_.untimed.add(byte);
    return;
  }
  const std::int64_t time_ns = high_ns_ + static_cast<std::int64_t>((word >> 54) & 0x3F) * kMicrosecond_ns;
  const auto base_x = static_cast<unsigned>(word >> 43) & 0x7FF,
             y = static_cast<unsigned>(word >> 32) & 0x7FF;
  const bool brighter = word >> 60 == kOn;
  for (; mask != 0; mask &= mask - 1) {
    const unsigned x = base_x + static_cast<unsigned>(std::countr_zero(mask));
    if (area_.holds(x, y)) {
      events.add(time_ns, x, y, brighter);
    } else {
      findings_.outside.add(byte);
    }
  }
}

void Evt21Decoder::other(std::uint64_t word, std::uint64_t byte) {
  switch (word >> 60) {
    case kTimeHigh:
      high_ns_ = highTime((word >> 32) & 0xFFFFFFF, high_, findings_.wraps, byte);
      has_time_ = true;
      break;
    case kTrigger:
      ++findings_.triggers;
      break;
    case kOthers:
    case kContinued:
      break;
    default:
      findings_.unknown.add(byte);
  }
}

bool looksExchanged(std::string_view data) {
  std::size_t plain = 0, exchanged = 0;
  const auto isKnown = [](std::uint64_t word) {
    const std::uint64_t kind = word >> 60;
    return kind == kOff || kind == kOn || kind == kTimeHigh || kind == kTrigger;
  };
  for (std::size_t i = 0; i < data.size() / sizeof(std::uint64_t); ++i) {
    const auto word = packedWordAt<std::uint64_t>(data, i);
    // Words of events fit both orders if their mask is small, so only words of times are counted.
    plain += isKnown(word) && word >> 60 == kTimeHigh;
    exchanged += isKnown(std::rotl(word, 32)) && std::rotl(word, 32) >> 60 == kTimeHigh;
  }
  return exchanged >= plain;
}

std::size_t Evt3BlockDecoder::decode(std::string_view bytes, std::uint64_t offset,
                                     std::vector<Event>& events) {
  decoder_.decode(bytes, events);
  const Evt3Counts& counts = decoder_.counts();
  const auto count = [offset](Occurrences& occurrences, std::uint64_t total) {
    if (occurrences.count == 0 && total > 0) occurrences.first_byte = offset;
    occurrences.count = total;
  };
  count(findings_.outside, counts.outside);
  count(findings_.untimed, counts.unplaced);
  findings_.triggers = counts.triggers;
  return bytes.size() / sizeof(std::uint16_t) * sizeof(std::uint16_t);
}

std::size_t DatDecoder::decode(std::string_view bytes, std::uint64_t offset, std::vector<Event>& events) {
  const std::size_t records = bytes.size() / sizeof(std::uint64_t);
  if (triggers_) {
    findings_.triggers += records;
    return records * sizeof(std::uint64_t);
  }
  EventAppender appender(events);
  appender.reserve(records);
  for (std::size_t i = 0; i < records; ++i) {
    const auto record = packedWordAt<std::uint64_t>(bytes, i);
    bool wrapped = false;
    const std::uint64_t time_us = time_.unwrap(record & 0xFFFFFFFF, wrapped);
    if (wrapped) findings_.wraps.add(offset + i * sizeof record);
    const auto place = static_cast<std::uint32_t>(record >> 32);
    const unsigned x = old_ ? place & 0x1FF : place & 0x3FFF;
    const unsigned y = old_ ? (place >> 9) & 0xFF : (place >> 14) & 0x3FFF;
    const bool brighter = old_ ? ((place >> 17) & 1) != 0 : place >> 28 != 0;
    if (area_.holds(x, y)) {
      appender.add(static_cast<std::int64_t>(time_us) * kMicrosecond_ns, x, y, brighter);
    } else {
      findings_.outside.add(offset + i * sizeof record);
    }
  }
  return records * sizeof(std::uint64_t);
}

}  // namespace evical::prophesee
