#include "core/frontend/burst_window.h"

#include "core/base/time.h"

#include <algorithm>
#include <utility>

namespace evical {
namespace {

// Bursts are not ordered by place: their pixels are prefetched this many bursts ahead.
constexpr std::size_t kBurstsFetchedAhead = 16;
constexpr std::int64_t kSlice_ns = 5'000'000;  // storage only: results do not depend on it

std::int64_t sliceOf(std::int64_t time_ns) {
  return time_ns >= 0 ? time_ns / kSlice_ns : (time_ns - kSlice_ns + 1) / kSlice_ns;
}

}  // namespace

BurstHistory::Slices::const_iterator BurstHistory::firstFrom(std::int64_t index) const {
  return std::lower_bound(slices_.begin(), slices_.end(), index,
                          [](const Slice& slice, std::int64_t wanted) { return slice.index < wanted; });
}

std::vector<EdgeCrossing> BurstHistory::emptySlice() {
  if (spare_.empty()) return {};
  std::vector<EdgeCrossing> slice = std::move(spare_.back());
  spare_.pop_back();
  slice.clear();
  return slice;
}

std::vector<EdgeCrossing>& BurstHistory::sliceAt(std::int64_t index) {
  if (slices_.empty() || slices_.back().index < index)
    return slices_.emplace_back(Slice{index, emptySlice()}).bursts;
  // Without empty slices, the index gives the place.
  const auto place = static_cast<std::size_t>(std::max<std::int64_t>(index - slices_.front().index, 0));
  if (place < slices_.size() && slices_[place].index == index) return slices_[place].bursts;
  const auto found = firstFrom(index);
  const auto at = slices_.begin() + (found - slices_.cbegin());
  return at != slices_.end() && at->index == index ? at->bursts
                                                   : slices_.insert(at, Slice{index, emptySlice()})->bursts;
}

void BurstHistory::add(const std::vector<EdgeCrossing>& bursts) {
  for (const EdgeCrossing& burst : bursts) sliceAt(sliceOf(burst.time_ns)).push_back(burst);
}

void BurstHistory::dropBefore(std::int64_t time_ns) {
  const std::int64_t slice = sliceOf(time_ns);
  while (!slices_.empty() && slices_.front().index < slice) {
    spare_.push_back(std::move(slices_.front().bursts));
    slices_.pop_front();
  }
}

void BurstHistory::gather(std::int64_t begin_ns, std::int64_t end_ns,
                          std::vector<EdgeCrossing>& bursts) const {
  const std::int64_t last = sliceOf(end_ns - 1);
  for (auto slice = firstFrom(sliceOf(begin_ns)); slice != slices_.end() && slice->index <= last; ++slice) {
    for (const EdgeCrossing& burst : slice->bursts) {
      if (burst.time_ns >= begin_ns && burst.time_ns < end_ns) bursts.push_back(burst);
    }
  }
}

std::size_t BurstHistory::count(std::int64_t begin_ns, std::int64_t end_ns, bool single_events) const {
  std::size_t sum = 0;
  const std::int64_t last = sliceOf(end_ns - 1);
  for (auto slice = firstFrom(sliceOf(begin_ns)); slice != slices_.end() && slice->index <= last; ++slice)
    sum += single_events ? slice->bursts.size()
                         : static_cast<std::size_t>(
                               std::count_if(slice->bursts.begin(), slice->bursts.end(),
                                             [](const EdgeCrossing& burst) { return burst.events > 0; }));
  return sum;
}

std::optional<std::int64_t> BurstHistory::nextAfter(std::int64_t from_ns) const {
  const auto slice = firstFrom(sliceOf(from_ns));
  if (slice == slices_.end()) return std::nullopt;
  return std::max(from_ns, slice->index * kSlice_ns);
}

void keepSupported(Resolution resolution_px, int min_support, std::vector<EdgeCrossing>& bursts) {
  const int stride = resolution_px.width_px + 2;
  std::vector<std::uint8_t> occupied(static_cast<std::size_t>(stride * (resolution_px.height_px + 2)), 0);
  for (const EdgeCrossing& burst : bursts) {
    occupied[static_cast<std::size_t>((burst.y_px + 1) * stride + burst.x_px + 1)] |= burst.brighter ? 1 : 2;
  }
  std::erase_if(bursts, [&](const EdgeCrossing& burst) {
    const std::uint8_t bit = burst.brighter ? 1 : 2;
    int support = 0;
    for (int dy = 0; dy <= 2; ++dy) {
      const auto row = static_cast<std::size_t>((burst.y_px + dy) * stride + burst.x_px);
      for (std::size_t dx = 0; dx <= 2; ++dx) support += (occupied[row + dx] & bit) != 0;
    }
    return support < min_support;
  });
}

BurstWindow::BurstWindow(const BoardScene& scene)
    : resolution_px_(scene.resolution_px),
      drops_single_events_(!scene.single_events && burstsFor(scene.board, BurstOptions()).single_events),
      pixels_(scene.pixels),
      dark_circles_(scene.board.circles == CircleShade::Dark),
      columns_((scene.resolution_px.width_px >> kCellShift) + 1),
      rows_((scene.resolution_px.height_px >> kCellShift) + 1) {}

void BurstWindow::assign(const std::vector<EdgeCrossing>& bursts, std::int64_t middle_ns) {
  middle_ns_ = middle_ns;
  cell_begin_.assign(static_cast<std::size_t>(columns_ * rows_) + 2, 0);
  const auto cellOf = [&](const EdgeCrossing& burst) {
    return static_cast<std::size_t>((burst.y_px >> kCellShift) * columns_ + (burst.x_px >> kCellShift));
  };
  for (const EdgeCrossing& burst : bursts) ++cell_begin_[cellOf(burst) + 2];
  for (std::size_t i = 2; i < cell_begin_.size(); ++i) cell_begin_[i] += cell_begin_[i - 1];
  bursts_.resize(bursts.size());
  const IdealPixels* const pixels = pixels_.get();
  const auto indexOf = [&](const EdgeCrossing& burst) {
    return static_cast<std::size_t>(burst.y_px * resolution_px_.width_px + burst.x_px);
  };
  for (std::size_t k = 0; k < bursts.size(); ++k) {
    const EdgeCrossing& burst = bursts[k];
    if (pixels && k + kBurstsFetchedAhead < bursts.size()) {
      const EdgeCrossing& later = bursts[k + kBurstsFetchedAhead];
      __builtin_prefetch(&pixels->ideal(later.x_px, later.y_px));
      __builtin_prefetch(pixels->stretch.data() + indexOf(later));
    }
    WindowBurst& out = bursts_[cell_begin_[cellOf(burst) + 1]++];
    out.x_px = burst.x_px;
    out.y_px = burst.y_px;
    out.ideal_x_px = out.x_px;
    out.ideal_y_px = out.y_px;
    out.stretch = {};
    if (pixels) {
      const Eigen::Vector2f& ideal = pixels->ideal(burst.x_px, burst.y_px);
      out.ideal_x_px = ideal.x();
      out.ideal_y_px = ideal.y();
      out.stretch = pixels->stretch[indexOf(burst)];
    }
    out.time_s = static_cast<float>(static_cast<double>(burst.time_ns - middle_ns) * 1e-9);
    out.events = std::max<float>(burst.events, 1.0f);
    out.lead = burst.brighter == dark_circles_ ? -1.0f : 1.0f;
  }
}

void BurstWindow::gather(const BurstHistory& history, std::int64_t middle_ns, double half_window_s) {
  const std::int64_t half_ns = nanosecondsFrom(half_window_s);
  gathered_.clear();
  history.gather(middle_ns - half_ns, middle_ns + half_ns, gathered_);
  if (drops_single_events_)
    std::erase_if(gathered_, [](const EdgeCrossing& burst) { return burst.events == 0; });
}

void BurstWindow::fill(const BurstHistory& history, std::int64_t middle_ns, double half_window_s) {
  gather(history, middle_ns, half_window_s);
  assign(gathered_, middle_ns);
}

void BurstWindow::fillSupported(const BurstHistory& history, std::int64_t middle_ns, double half_window_s,
                                int min_support) {
  gather(history, middle_ns, half_window_s);
  keepSupported(resolution_px_, min_support, gathered_);
  assign(gathered_, middle_ns);
}

}  // namespace evical
