// A DAVIS's frames in AEDAT 2.0: each pixel's voltage is read once after its reset and once after its
// exposure, and the frame is the difference (as jAER's DavisBaseCamera reads it).
#pragma once

#include "core/data/frame.h"

#include <cstdint>
#include <vector>

namespace evical::aedat {

bool isApsSample(std::uint32_t address);

class ApsFrames {
 public:
  explicit ApsFrames(const Resolution& size_px) : size_px_(size_px) {}

  // Number of samples, this one or earlier ones, that belong to no complete frame.
  std::uint64_t add(std::uint32_t address, std::int64_t time_ns);
  // Number of samples of a frame that is cut by the file's end.
  std::uint64_t left() const { return read_; }

  // Complete frames since the vector was last emptied: at the middle of their exposures, brighter is larger.
  std::vector<Frame>& frames() { return frames_; }
  std::uint64_t rolling() const {
    return rolling_;
  }  // frames whose pixels are exposed one column after the other

 private:
  struct Pixel {
    std::int64_t reset_ns = 0;
    std::uint64_t order = 0;  // of its reset among all samples
    std::uint16_t reset = 0;
    bool has_reset = false, has_signal = false;
  };
  void begin();
  // The next frame began before this one was complete: with the resets since the last signal, if they belong
  // to it.
  std::uint64_t beginAnew(const Pixel& read_again);
  void takeReset(std::size_t at, std::uint16_t value, std::int64_t time_ns);
  void takeSignal(std::size_t at, std::uint16_t value, std::int64_t time_ns);
  void finish();

  Resolution size_px_;
  std::vector<Pixel> pixels_;  // row by row
  std::vector<std::uint16_t> values_;
  std::uint64_t read_ = 0;  // samples of the incomplete frame
  std::size_t signals_ = 0;
  std::uint64_t order_ = 0, last_signal_order_ = 0;
  std::int64_t last_reset_ns_ = 0, first_signal_ns_ = 0;
  double exposures_s_ = 0.0, middles_s_ = 0.0;  // sums; middles after the first reset
  std::int64_t first_reset_ns_ = 0;
  std::vector<Frame> frames_;
  std::uint64_t rolling_ = 0;
};

}  // namespace evical::aedat
