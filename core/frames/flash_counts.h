// Events per pixel, counted over half periods of a blinking light, and the picture that they form.
#pragma once

#include "core/data/event.h"
#include "core/frames/gray_image.h"

#include <cstdint>
#include <span>
#include <vector>

namespace evical {

// The flashing part of a board: printed dark areas that turn bright, or bright areas that turn dark.
enum class Flashing { Ink, Paper };

struct FlashCounts {
  std::int64_t begin_ns = 0, end_ns = 0;
  int half_periods = 0;
  std::vector<std::uint16_t> counts;  // row by row

  void add(const Event& event, int width_px) {
    std::uint16_t& count =
        counts[static_cast<std::size_t>(event.y_px) * static_cast<std::size_t>(width_px) + event.x_px];
    if (count < UINT16_MAX) ++count;
  }
};

// Sum of consecutive counts.
FlashCounts sumOf(std::span<const FlashCounts> parts);

// Number of pixels that fired in every half period, on average.
std::size_t flashingPixels(const FlashCounts& sum);

// Brightness as in a frame: flashing pixels are dark for ink, bright for paper.
GrayImage pictureOf(const FlashCounts& sum, Resolution size_px, Flashing flashing);

// Enlarged `times` times; a place x of the picture is at times (x + 0.5) - 0.5 of the larger one.
GrayImage enlarged(const GrayImage& image, int times);

}  // namespace evical
