// Events counted pixel by pixel over half periods of a blinking light, and the picture they make.
#pragma once

#include "core/data/event.h"
#include "core/frames/gray_image.h"

#include <cstdint>
#include <span>
#include <vector>

namespace evical {

// Which part of a board flashes: what is printed dark and turns bright, or what is bright and turns dark.
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

// Of neighbours in time.
FlashCounts sumOf(std::span<const FlashCounts> parts);

// Pixels that fired in every half period, on average.
std::size_t flashingPixels(const FlashCounts& sum);

// Brightness as a frame would have it: what flashes is dark where it is ink, bright where it is paper.
GrayImage pictureOf(const FlashCounts& sum, Resolution size_px, Flashing flashing);

// So many times as wide and as high; a place x of the picture is at times (x + 0.5) - 0.5 of the larger one.
GrayImage enlarged(const GrayImage& image, int times);

}  // namespace evical
