#include "core/recording/aedat/aedat2_decoder.h"

#include "core/base/time.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace evical::aedat {
namespace {

constexpr std::uint32_t kApsMask = 0x8000'0000, kReadMask = 0xC00, kReset = 0, kSignal = 0x400;
constexpr int kBits = 10;  // of a voltage

}  // namespace

bool isApsSample(std::uint32_t address) {
  const std::uint32_t read = address & kReadMask;
  return (address & kApsMask) != 0 && (read == kReset || read == kSignal);
}

// Columns are those of the image, unlike those of events; rows are counted from below.
std::uint64_t ApsFrames::add(std::uint32_t address, std::int64_t time_ns) {
  const std::uint32_t x = address >> 12 & 0x3FF, y = address >> 22 & 0x1FF;
  const auto width = static_cast<std::uint32_t>(size_px_.width_px),
             height = static_cast<std::uint32_t>(size_px_.height_px);
  if (x >= width || y >= height) return 1;
  const std::size_t at = std::size_t{height - 1 - y} * width + x;
  const auto value = static_cast<std::uint16_t>(address & ((1U << kBits) - 1));
  if (pixels_.empty()) begin();
  ++order_;
  if ((address & kReadMask) == kSignal) {
    if (!pixels_[at].has_reset || pixels_[at].has_signal) return 1;
    ++read_;
    takeSignal(at, value, time_ns);
    return 0;
  }
  const std::uint64_t lost = pixels_[at].has_reset ? beginAnew(pixels_[at]) : 0;
  takeReset(at, value, time_ns);
  return lost;
}

void ApsFrames::takeReset(std::size_t at, std::uint16_t value, std::int64_t time_ns) {
  if (read_++ == 0) first_reset_ns_ = time_ns;
  last_reset_ns_ = time_ns;
  pixels_[at] = {time_ns, order_, value, true, false};
}

std::uint64_t ApsFrames::beginAnew(const Pixel& read_again) {
  const std::uint64_t had = read_;
  std::vector<std::pair<std::size_t, Pixel>> own;
  if (read_again.order < last_signal_order_)
    for (std::size_t at = 0; at < pixels_.size(); ++at)
      if (pixels_[at].has_reset && pixels_[at].order > last_signal_order_) own.emplace_back(at, pixels_[at]);
  std::sort(own.begin(), own.end(),
            [](const auto& a, const auto& b) { return a.second.order < b.second.order; });
  begin();
  for (const auto& [at, pixel] : own) {
    takeReset(at, pixel.reset, pixel.reset_ns);
    pixels_[at].order = pixel.order;
  }
  return had - read_;
}

void ApsFrames::begin() {
  const std::size_t count =
      static_cast<std::size_t>(size_px_.width_px) * static_cast<std::size_t>(size_px_.height_px);
  pixels_.assign(count, {});
  values_.assign(count, 0);
  read_ = 0;
  signals_ = 0;
  exposures_s_ = middles_s_ = 0.0;
}

void ApsFrames::takeSignal(std::size_t at, std::uint16_t value, std::int64_t time_ns) {
  Pixel& pixel = pixels_[at];
  pixel.has_signal = true;
  last_signal_order_ = order_;
  values_[at] = static_cast<std::uint16_t>(std::max(0, pixel.reset - value) << (16 - kBits));
  if (signals_++ == 0) first_signal_ns_ = time_ns;
  exposures_s_ += secondsSince(pixel.reset_ns, time_ns);
  middles_s_ +=
      0.5 * (secondsSince(first_reset_ns_, pixel.reset_ns) + secondsSince(first_reset_ns_, time_ns));
  if (signals_ == values_.size()) finish();
}

// A global shutter opens when the last pixel has been reset, and closes when the first one is read.
void ApsFrames::finish() {
  const auto count = static_cast<double>(signals_);
  Frame frame;
  const bool global = first_signal_ns_ >= last_reset_ns_;
  frame.exposure_s = global ? secondsSince(last_reset_ns_, first_signal_ns_) : exposures_s_ / count;
  frame.time_ns = global ? last_reset_ns_ + (first_signal_ns_ - last_reset_ns_) / 2
                         : first_reset_ns_ + nanosecondsFrom(middles_s_ / count);
  rolling_ += global ? 0 : 1;
  frame.format = FrameFormat::Gray16;
  frame.big_endian = std::endian::native == std::endian::big;
  frame.size_px = size_px_;
  frame.row_bytes = 2 * static_cast<std::size_t>(size_px_.width_px);
  frame.bytes.resize(2 * values_.size());
  std::memcpy(frame.bytes.data(), values_.data(), frame.bytes.size());
  frames_.push_back(std::move(frame));
  begin();
}

}  // namespace evical::aedat

namespace evical::aedat {
namespace {

constexpr std::int64_t kHalfRange_us = std::int64_t{1} << 31;
constexpr std::int64_t kLargestWrapped_us = kLatestTime_ns / kMicrosecond_ns - 4 * kHalfRange_us;
// MPU-6150 at the full scales that jAER sets: 4 g and 500 deg/s.
constexpr double kAcceleration_per_g = 8192.0, kRate_per_deg_s = 65.5;
constexpr std::uint32_t kImuMask = 0x8000'0C00;

std::int16_t wordOf(std::uint32_t address) {
  return static_cast<std::int16_t>(address >> 12 & 0xFFFF);
}

}  // namespace

std::uint32_t bigEndian32(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

bool isDavisImuWord(std::uint32_t address) {
  return (address & kImuMask) == kImuMask;
}

unsigned davisImuCode(std::uint32_t address) {
  return address >> 28 & 7;
}

double davisAcceleration_g(std::uint32_t address) {
  return wordOf(address) / kAcceleration_per_g;
}

// Bit 10: an edge at the external input; bit 31: a pixel's brightness, or the IMU.
bool isDavisEvent(std::uint32_t address) {
  return (address & 0x8000'0400) == 0;
}

unsigned davisX(std::uint32_t address) {
  return address >> 12 & 0x3FF;
}

unsigned davisY(std::uint32_t address) {
  return address >> 22 & 0x1FF;
}

std::size_t Aedat2Decoder::decode(std::string_view bytes, std::uint64_t offset, std::vector<Event>& events) {
  EventAppender appender(events);
  const std::size_t records = bytes.size() / kAedat2Record_bytes;
  appender.reserve(records);
  for (std::size_t i = 0; i < records; ++i) {
    const std::size_t at = i * kAedat2Record_bytes;
    const std::uint32_t address = bigEndian32(bytes.data() + at);
    const auto time_us = static_cast<std::int32_t>(bigEndian32(bytes.data() + at + 4));
    const std::int64_t time_ns = unwrapped_us(time_us, offset + at) * kMicrosecond_ns;
    if (layout_ == AddressLayout::Davis) {
      addDavis(address, time_ns, offset + at, appender);
    } else {
      addDvs128(address, time_ns, offset + at, appender);
    }
  }
  return records * kAedat2Record_bytes;
}

// A step of more than half the range is a wrap of the counter, or, in the other direction, a late record from
// before a wrap.
std::int64_t Aedat2Decoder::unwrapped_us(std::int32_t time_us, std::uint64_t byte) {
  const std::int64_t step_us = started_ ? std::int64_t{time_us} - last_us_ : 0;
  if (step_us < -kHalfRange_us && wrapped_us_ <= kLargestWrapped_us) {
    wrapped_us_ += 2 * kHalfRange_us;
    findings_.wraps.add(byte);
  } else if (step_us > kHalfRange_us && wrapped_us_ >= 2 * kHalfRange_us) {
    wrapped_us_ -= 2 * kHalfRange_us;
  }
  started_ = true;
  last_us_ = time_us;
  return wrapped_us_ + time_us;
}

void Aedat2Decoder::addDvs128(std::uint32_t address, std::int64_t time_ns, std::uint64_t byte,
                              EventAppender& events) {
  if ((address & 0x8000) != 0) {
    ++findings_.triggers;
  } else if (address >> 16 != 0) {
    findings_.unknown.add(byte);
  } else {
    addEvent(address >> 1 & 0x7F, address >> 8 & 0x7F, (address & 1) == 0, time_ns, byte, events);
  }
}

void Aedat2Decoder::addDavis(std::uint32_t address, std::int64_t time_ns, std::uint64_t byte,
                             EventAppender& events) {
  if (isDavisEvent(address)) {
    addEvent(davisX(address), davisY(address), (address & 0x800) != 0, time_ns, byte, events);
  } else if (isDavisImuWord(address)) {
    addImuWord(address, time_ns, byte);
  } else if (isApsSample(address)) {
    addApsSample(address, time_ns, byte);
  } else if ((address & 0x8000'0000) != 0) {
    findings_.exposure.add(byte);
  } else {
    ++findings_.triggers;
  }
}

void Aedat2Decoder::addApsSample(std::uint32_t address, std::int64_t time_ns, std::uint64_t byte) {
  if (aps_.left() == 0) frame_byte_ = byte;
  addLostSamples(aps_.add(address, time_ns));
  findings_.rolling_frames = aps_.rolling();
}

void Aedat2Decoder::addLostSamples(std::uint64_t count) {
  if (count == 0) return;
  findings_.exposure.add(frame_byte_);
  findings_.exposure.count += count - 1;
}

void Aedat2Decoder::finish() {
  addLostSamples(aps_.left());
}

void Aedat2Decoder::addEvent(unsigned x, unsigned y, bool brighter, std::int64_t time_ns, std::uint64_t byte,
                             EventAppender& events) {
  const auto width = static_cast<unsigned>(size_px_.width_px),
             height = static_cast<unsigned>(size_px_.height_px);
  if (x < width && y < height) {
    events.add(time_ns, width - 1 - x, height - 1 - y, brighter);
  } else {
    findings_.outside.add(byte);
  }
}

// Seven consecutive words: the acceleration's axes, the temperature, the gyroscope's axes, in the chip's
// order.
void Aedat2Decoder::addImuWord(std::uint32_t address, std::int64_t time_ns, std::uint64_t byte) {
  const unsigned code = davisImuCode(address);
  if (code != next_imu_word_ && code != 0) {
    findings_.unknown.add(byte);
    next_imu_word_ = 0;
    return;
  }
  imu_words_[code] = wordOf(address);
  next_imu_word_ = code + 1;
  if (next_imu_word_ < imu_words_.size()) return;
  next_imu_word_ = 0;
  RawImuSample sample;
  sample.time_ns = time_ns;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    sample.specific_force[axis] =
        imu_ranges_ * imu_words_[static_cast<std::size_t>(axis)] / kAcceleration_per_g;
    sample.angular_rate[axis] =
        imu_ranges_ * imu_words_[static_cast<std::size_t>(axis) + 4] / kRate_per_deg_s;
  }
  imu_samples_.push_back(sample);
}

}  // namespace evical::aedat
