// Sums the events of a blinking light to counts of half periods, and these to slots of a given length, in one
// pass and bounded memory.
#pragma once

#include "core/frames/gray_image.h"

#include "core/data/event.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <span>
#include <vector>

namespace evical {

// Events per pixel, counted over half periods of a blinking light, and the picture that they form.

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

// Detection of a blinking light's half periods: they begin when ON events start to outweigh OFF events, or
// the other way round.
class HalfPeriods {
 public:
  static constexpr int kBinsPerPeriod = 16;
  static constexpr int kTurn_bins = 3;

  // Number of ON minus OFF events of the next bin, a sixteenth of a period. True if the light has turned,
  // kTurn_bins before this bin's end: the events since then are the first of the new half period.
  bool add(double balance);

 private:
  static constexpr std::size_t kSmoothed = 5;  // bins

  std::array<double, kSmoothed> last_{};
  std::array<double, 2 * kBinsPerPeriod> heights_{};  // of two periods
  std::size_t count_ = 0;
  int sign_ = 0;
};

// Consecutive half periods; for a fast blink, several are summed in one element.
using FlashSlot = std::vector<FlashCounts>;

class FlashGathering {
 public:
  using Sink = std::function<void(const FlashSlot&)>;

  FlashGathering(Resolution resolution_px, double period_s, double slot_s, Sink sink);

  // Events in order of time, inside the resolution.
  void add(const Event& event);
  void finish() { handOut(); }

 private:
  void start(std::int64_t time_ns);
  void closeBin();
  void endHalfPeriod(std::int64_t at_ns);
  void handOut();

  Resolution resolution_px_;
  std::int64_t period_ns_, bin_ns_, slot_ns_, part_ns_;
  Sink sink_;
  HalfPeriods half_periods_;
  std::int64_t bin_end_ns_ = 0;
  double balance_ = 0.0;                  // of the current bin
  bool started_ = false, whole_ = false;  // whole_: the current half period was seen from its beginning
  std::deque<Event> pending_;             // may belong to the next half period
  FlashCounts current_;
  FlashSlot slot_;
};

}  // namespace evical
