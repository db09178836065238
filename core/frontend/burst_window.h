// The bursts around one instant, indexed by place.
#pragma once

#include "core/frontend/board_scene.h"
#include "core/frontend/edge_crossings.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace evical {

// Recent bursts in slices of time, so that any window of the history can be gathered. Time without bursts
// needs no memory.
class BurstHistory {
 public:
  void add(const std::vector<EdgeCrossing>& bursts);
  void dropBefore(std::int64_t time_ns);

  // Appends all bursts with begin_ns <= time < end_ns.
  void gather(std::int64_t begin_ns, std::int64_t end_ns, std::vector<EdgeCrossing>& bursts) const;
  // To a slice's accuracy.
  std::size_t count(std::int64_t begin_ns, std::int64_t end_ns, bool single_events = false) const;
  // End of the time without bursts from this time on, to a slice's accuracy; empty without later bursts.
  std::optional<std::int64_t> nextAfter(std::int64_t from_ns) const;
  bool empty() const { return slices_.empty(); }

 private:
  struct Slice {
    std::int64_t index;  // time over a slice's length
    std::vector<EdgeCrossing> bursts;
  };
  using Slices = std::deque<Slice>;

  std::vector<EdgeCrossing>& sliceAt(std::int64_t index);
  std::vector<EdgeCrossing> emptySlice();
  Slices::const_iterator firstFrom(std::int64_t index) const;

  Slices slices_;                                 // ascending, none of them empty
  std::vector<std::vector<EdgeCrossing>> spare_;  // memory of dropped slices, for new ones
};

// Drops isolated bursts: fewer than `min_support` of their kind in a 3x3 neighbourhood, themselves
// included.
void keepSupported(Resolution resolution_px, int min_support, std::vector<EdgeCrossing>& bursts);

// A burst in a window. Pixels are the sensor's; ideal pixels as in camera_model.h (equal to the sensor's for
// an unknown camera).
struct WindowBurst {
  float x_px, y_px;
  float ideal_x_px, ideal_y_px;
  PixelStretch stretch;
  float time_s;  // since the window's middle
  float events;  // fired by the edge here
  float lead;    // +1 for the polarity of a circle's leading edge, -1 for its trailing edge
};

// Bursts sorted into cells of 8 x 8 pixels.
class BurstWindow {
 public:
  static constexpr int kCellShift = 3;

  explicit BurstWindow(const BoardScene& scene);

  void assign(const std::vector<EdgeCrossing>& bursts, std::int64_t middle_ns);
  // Selects the history's bursts within half_window_s of the middle.
  void fill(const BurstHistory& history, std::int64_t middle_ns, double half_window_s);
  // The same without isolated bursts (keepSupported).
  void fillSupported(const BurstHistory& history, std::int64_t middle_ns, double half_window_s,
                     int min_support);

  const std::vector<WindowBurst>& bursts() const { return bursts_; }
  Resolution resolution_px() const { return resolution_px_; }
  std::int64_t middle_ns() const { return middle_ns_; }

  // Calls visit(index of burst) for all bursts in the cells that the box touches.
  template <class Visit>
  void visitBox(double x_low_px, double x_high_px, double y_low_px, double y_high_px, Visit&& visit) const;

 private:
  int cellColumn(double x_px) const;
  int cellRow(double y_px) const;
  void gather(const BurstHistory& history, std::int64_t middle_ns, double half_window_s);

  Resolution resolution_px_;
  bool drops_single_events_;
  std::shared_ptr<const IdealPixels> pixels_;
  bool dark_circles_;
  int columns_, rows_;
  std::int64_t middle_ns_ = 0;
  std::vector<EdgeCrossing> gathered_;  // kept to reuse its memory
  std::vector<WindowBurst> bursts_;
  std::vector<std::uint32_t> cell_begin_;  // columns_ * rows_ + 1
};

inline int BurstWindow::cellColumn(double x_px) const {
  return x_px <= 0.0 ? 0 : std::min(static_cast<int>(x_px) >> kCellShift, columns_ - 1);
}

inline int BurstWindow::cellRow(double y_px) const {
  return y_px <= 0.0 ? 0 : std::min(static_cast<int>(y_px) >> kCellShift, rows_ - 1);
}

template <class Visit>
void BurstWindow::visitBox(double x_low_px, double x_high_px, double y_low_px, double y_high_px,
                           Visit&& visit) const {
  if (x_high_px < 0.0 || y_high_px < 0.0 || x_low_px > resolution_px_.width_px ||
      y_low_px > resolution_px_.height_px)
    return;
  const int column_end = cellColumn(x_high_px) + 1;
  const int column_begin = cellColumn(x_low_px);
  const int row_end = cellRow(y_high_px) + 1;
  for (int row = cellRow(y_low_px); row < row_end; ++row) {
    const std::uint32_t begin = cell_begin_[static_cast<std::size_t>(row * columns_ + column_begin)];
    const std::uint32_t end = cell_begin_[static_cast<std::size_t>(row * columns_ + column_end)];
    for (std::uint32_t i = begin; i < end; ++i) visit(i);
  }
}

}  // namespace evical
