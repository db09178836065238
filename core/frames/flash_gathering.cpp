#include "core/frames/flash_gathering.h"

#include "core/base/time.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace evical {
namespace {

bool isFlashing(const FlashCounts& sum, std::uint16_t count) {
  return count >= std::max(1, sum.half_periods);
}

// Count of a pixel that sees the full flash: the mean of flashing pixels around it. A screen is less bright
// from the side, and a corner between fields of different darkness would be displaced.
cv::Mat fullCounts(const FlashCounts& sum, const Resolution& size_px) {
  constexpr double kAround = 0.05;   // sigma relative to the picture's longer side
  constexpr double kFarAway = 0.02;  // if a smaller share flashes, the whole picture's mean dominates
  constexpr double kFull = 1.1;      // corrects the mean for pixels at edges
  cv::Mat flashing(size_px.height_px, size_px.width_px, CV_32F), counted(flashing.size(), CV_32F);
  for (int k = 0; k < size_px.pixelCount(); ++k) {
    const std::uint16_t count = sum.counts[static_cast<std::size_t>(k)];
    const bool flashes = isFlashing(sum, count);
    flashing.at<float>(k / size_px.width_px, k % size_px.width_px) = flashes ? 1.0f : 0.0f;
    counted.at<float>(k / size_px.width_px, k % size_px.width_px) =
        flashes ? static_cast<float>(count) : 0.0f;
  }
  const double mean = std::max(1.0, cv::sum(counted)[0] / std::max(1.0, cv::sum(flashing)[0]));
  const double sigma = kAround * std::max(size_px.width_px, size_px.height_px);
  cv::GaussianBlur(flashing, flashing, {}, sigma);
  cv::GaussianBlur(counted, counted, {}, sigma);
  return kFull * (counted + kFarAway * mean) / (flashing + kFarAway);
}

}  // namespace

FlashCounts sumOf(std::span<const FlashCounts> parts) {
  FlashCounts sum = parts.front();
  for (const FlashCounts& part : parts.subspan(1)) {
    sum.end_ns = part.end_ns;
    sum.half_periods += part.half_periods;
    for (std::size_t k = 0; k < sum.counts.size(); ++k)
      sum.counts[k] = static_cast<std::uint16_t>(
          std::min<std::uint32_t>(UINT16_MAX, std::uint32_t{sum.counts[k]} + part.counts[k]));
  }
  return sum;
}

std::size_t flashingPixels(const FlashCounts& sum) {
  return static_cast<std::size_t>(std::count_if(sum.counts.begin(), sum.counts.end(),
                                                [&](std::uint16_t count) { return isFlashing(sum, count); }));
}

GrayImage pictureOf(const FlashCounts& sum, Resolution size_px, Flashing flashing) {
  const cv::Mat full = fullCounts(sum, size_px);
  GrayImage image{size_px, {}};
  image.pixels.reserve(sum.counts.size());
  for (int k = 0; k < size_px.pixelCount(); ++k) {
    const double whole = full.at<float>(k / size_px.width_px, k % size_px.width_px);
    const double part = std::min(1.0, sum.counts[static_cast<std::size_t>(k)] / whole);
    image.pixels.push_back(
        static_cast<std::uint8_t>(std::lround(255.0 * (flashing == Flashing::Ink ? 1.0 - part : part))));
  }
  return image;
}

GrayImage enlarged(const GrayImage& image, int times) {
  if (times <= 1) return image;
  const cv::Mat seen(image.size_px.height_px, image.size_px.width_px, CV_8UC1,
                     const_cast<std::uint8_t*>(image.pixels.data()));
  GrayImage larger{{times * image.size_px.width_px, times * image.size_px.height_px}, {}};
  larger.pixels.resize(static_cast<std::size_t>(larger.size_px.pixelCount()));
  cv::Mat made(larger.size_px.height_px, larger.size_px.width_px, CV_8UC1, larger.pixels.data());
  cv::resize(seen, made, made.size(), 0.0, 0.0, cv::INTER_CUBIC);
  return larger;
}

// A turn is detected as soon as the new events outweigh the old ones in the smoothed bins: after half of
// these if a pixel fires continuously, immediately if it fires in short bursts.
bool HalfPeriods::add(double balance) {
  constexpr double kClear = 0.15;  // relative to the maximum of the last two periods
  last_[count_ % kSmoothed] = balance;
  const double smooth = std::accumulate(last_.begin(), last_.end(), 0.0);
  heights_[count_ % heights_.size()] = std::abs(smooth);
  ++count_;
  const double height = *std::max_element(heights_.begin(), heights_.end());
  const int sign = smooth > kClear * height ? 1 : smooth < -kClear * height ? -1 : 0;
  return sign != 0 && std::exchange(sign_, sign) == -sign;
}

namespace {

constexpr int kMaxParts = 16;         // per slot
constexpr double kLongestHalf = 1.2;  // periods: in a longer one the light was out of sight
constexpr int kLongestPause = 3;      // periods without any event

}  // namespace

FlashGathering::FlashGathering(Resolution resolution_px, double period_s, double slot_s, Sink sink)
    : resolution_px_(resolution_px),
      period_ns_(nanosecondsFrom(period_s)),
      bin_ns_(std::max<std::int64_t>(1, period_ns_ / HalfPeriods::kBinsPerPeriod)),
      slot_ns_(nanosecondsFrom(std::max(slot_s, period_s))),
      part_ns_(slot_ns_ / kMaxParts),
      sink_(std::move(sink)) {}

void FlashGathering::start(std::int64_t time_ns) {
  handOut();
  half_periods_ = {};
  pending_.clear();
  balance_ = 0.0;
  bin_end_ns_ = time_ns + bin_ns_;
  current_ = {time_ns, time_ns, 0,
              std::vector<std::uint16_t>(static_cast<std::size_t>(resolution_px_.pixelCount()))};
  whole_ = false;
  started_ = true;
}

void FlashGathering::add(const Event& event) {
  if (!started_ || event.time_ns > bin_end_ns_ + kLongestPause * period_ns_) start(event.time_ns);
  while (event.time_ns >= bin_end_ns_) closeBin();
  balance_ += event.brighter ? 1.0 : -1.0;
  pending_.push_back(event);
}

void FlashGathering::closeBin() {
  const bool turned = half_periods_.add(std::exchange(balance_, 0.0));
  const std::int64_t settled_ns = bin_end_ns_ - HalfPeriods::kTurn_bins * bin_ns_;
  for (; !pending_.empty() && pending_.front().time_ns < settled_ns; pending_.pop_front())
    current_.add(pending_.front(), resolution_px_.width_px);
  if (turned) endHalfPeriod(settled_ns);
  bin_end_ns_ += bin_ns_;
}

void FlashGathering::endHalfPeriod(std::int64_t at_ns) {
  FlashCounts half = std::move(current_);
  half.end_ns = at_ns;
  half.half_periods = 1;
  current_ = {at_ns, at_ns, 0, std::vector<std::uint16_t>(half.counts.size())};
  const bool fits = std::exchange(whole_, true) && static_cast<double>(at_ns - half.begin_ns) <
                                                       kLongestHalf * static_cast<double>(period_ns_);
  if (!fits) return handOut();
  if (!slot_.empty() && slot_.back().end_ns - slot_.back().begin_ns < part_ns_)
    slot_.back() = sumOf(std::array{std::move(slot_.back()), std::move(half)});
  else
    slot_.push_back(std::move(half));
  if (at_ns - slot_.front().begin_ns >= slot_ns_) handOut();
}

// A single half period may be half as bright as the next.
void FlashGathering::handOut() {
  int half_periods = 0;
  for (const FlashCounts& part : slot_) half_periods += part.half_periods;
  if (half_periods >= 2) sink_(slot_);
  slot_.clear();
}

}  // namespace evical
