// One camera's data from a recording: the motion of every window, and edges for the joint fit.
#pragma once

#include "core/data/edge_slope.h"
#include "core/egomotion/window_motion.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace evical {

// Slopes of windows, in bounded memory: if a window has more than options.kept_slopes, every second, third,
// ... is kept; with more than options.kept_windows windows, every second, fourth, ... window.
class KeptSlopes {
 public:
  struct Window {
    std::size_t index = 0;  // in the recording
    std::int64_t begin_ns = 0;
    std::vector<EdgeSlope> slopes;
  };

  // Windows in order.
  void add(std::size_t index, std::int64_t begin_ns, std::span<const EdgeSlope> slopes,
           const EgomotionOptions& options);
  const std::vector<Window>& windows() const { return windows_; }

 private:
  std::size_t every_ = 1;
  std::vector<Window> windows_;
};

struct CameraRecord {
  std::vector<WindowMotion> windows;
  KeptSlopes slopes;
};

}  // namespace evical
