#include "core/recording/aedat/aps_frames.h"

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
