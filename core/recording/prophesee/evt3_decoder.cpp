#include "core/recording/prophesee/evt3_decoder.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

namespace evical {
namespace {

constexpr std::int64_t kWrap_us = std::int64_t{1} << 24;
constexpr std::uint32_t kHalfHigh = 1U << 11;  // a larger step back is a wrap, a smaller one disorder
constexpr std::uint32_t kNearWrap = 1U << 6;   // largest distance of a late word from before a wrap
constexpr std::uint32_t kLargestHigh = 0xFFF;
constexpr std::uint32_t kEvt3Side_px = 1U << 11;

enum class Code : unsigned {
  Y = 0x0,
  Event = 0x2,
  BaseX = 0x3,
  Vector12 = 0x4,
  Vector8 = 0x5,
  TimeLow = 0x6,
  TimeHigh = 0x8,
  Trigger = 0xA,
};

}  // namespace

void Evt3Decoder::setResolution(Resolution resolution_px) {
  const auto side = [&](int length_px) {
    return resolution_px.known() ? std::min(static_cast<std::uint32_t>(length_px), kEvt3Side_px)
                                 : kEvt3Side_px;
  };
  width_px_ = side(resolution_px.width_px);
  height_px_ = side(resolution_px.height_px);
}

void Evt3Decoder::decode(std::string_view words, std::vector<Event>& events) {
  for (std::size_t i = 0; i + 1 < words.size(); i += 2) {
    std::uint16_t word = 0;
    std::memcpy(&word, words.data() + i, sizeof word);
    const std::uint32_t value = word & 0xFFFU;
    switch (static_cast<Code>(word >> 12)) {
      case Code::Y:
        y_px_ = word & 0x7FFU;
        has_y_ = true;
        break;
      case Code::Event:
        addEvent(word, events);
        break;
      case Code::BaseX:
        base_px_ = word & 0x7FFU;
        base_brighter_ = (word & 0x800U) != 0;
        has_base_ = true;
        break;
      case Code::Vector12:
        addVector(value, 12, events);
        break;
      case Code::Vector8:
        addVector(word & 0xFFU, 8, events);
        break;
      case Code::TimeLow:
        setTimeLow(value);
        break;
      case Code::TimeHigh:
        setTimeHigh(value);
        break;
      case Code::Trigger:
        ++counts_.triggers;
        break;
    }
  }
}

void Evt3Decoder::forgetPosition() {
  has_y_ = has_base_ = false;
}

void Evt3Decoder::setTimeHigh(std::uint32_t high) {
  if (has_high_ && high == high_) return;
  if (has_high_ && high + kHalfHigh <= high_) {
    wraps_us_ += kWrap_us;
  } else if (wraps_us_ > 0 && high_ < kNearWrap && high > kLargestHigh - kNearWrap) {
    wraps_us_ -= kWrap_us;
  }
  if (!has_high_) has_low_ = false;  // an earlier one belongs to another high
  has_high_ = true;
  high_ = high;
  low_ = 0;  // the next word states it
  time_ns_ = 1000 * (wraps_us_ + (std::int64_t{high_} << 12));
}

void Evt3Decoder::setTimeLow(std::uint32_t low) {
  has_low_ = true;
  low_ = low;
  time_ns_ = 1000 * (wraps_us_ + (std::int64_t{high_} << 12) + low_);
}

void Evt3Decoder::addEvent(std::uint16_t word, std::vector<Event>& events) {
  const std::uint32_t x_px = word & 0x7FFU;
  if (!has_low_ || !has_high_ || !has_y_) {
    ++counts_.unplaced;
  } else if (x_px >= width_px_ || y_px_ >= height_px_) {
    ++counts_.outside;
  } else {
    events.push_back({time_ns_, static_cast<std::uint16_t>(x_px), static_cast<std::uint16_t>(y_px_),
                      (word & 0x800U) != 0});
  }
}

void Evt3Decoder::addVector(std::uint32_t mask, int width, std::vector<Event>& events) {
  if (!has_low_ || !has_high_ || !has_y_ || !has_base_) {
    ++counts_.unplaced;
    return;
  }
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const std::uint32_t x_px = base_px_ + static_cast<std::uint32_t>(std::countr_zero(rest));
    if (x_px >= width_px_ || y_px_ >= height_px_) {
      ++counts_.outside;
      continue;
    }
    events.push_back(
        {time_ns_, static_cast<std::uint16_t>(x_px), static_cast<std::uint16_t>(y_px_), base_brighter_});
  }
  base_px_ += static_cast<std::uint32_t>(width);
}

}  // namespace evical
