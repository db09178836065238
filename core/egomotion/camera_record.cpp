#include "core/egomotion/camera_record.h"

namespace evical {

void KeptSlopes::add(std::size_t index, std::int64_t begin_ns, std::span<const EdgeSlope> slopes,
                     const EgomotionOptions& options) {
  if (windows_.size() >= static_cast<std::size_t>(options.kept_windows)) {
    every_ *= 2;
    std::erase_if(windows_, [this](const Window& window) { return window.index % every_ != 0; });
  }
  if (index % every_ != 0) return;
  Window& window = windows_.emplace_back();
  window.index = index;
  window.begin_ns = begin_ns;
  const std::size_t step = 1 + slopes.size() / static_cast<std::size_t>(options.kept_slopes);
  window.slopes.reserve(slopes.size() / step + 1);
  for (std::size_t k = 0; k < slopes.size(); k += step) window.slopes.push_back(slopes[k]);
}

}  // namespace evical
