#include "core/frames/flash_counts.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

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

}  // namespace evical
