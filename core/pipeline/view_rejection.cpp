#include "core/pipeline/view_rejection.h"

#include <cassert>
#include <utility>
#include <vector>

namespace evical {

RecordingPass withoutViews(const RecordingPass& pass, std::size_t camera, std::span<const int> views) {
  assert(camera < pass.cameras.size());
  RecordingPass kept = pass;
  std::vector<BoardView>& all = kept.cameras[camera].views;
  std::vector<bool> rejected(all.size(), false);
  for (const int view : views) {
    assert(view >= 0 && static_cast<std::size_t>(view) < all.size());
    rejected[static_cast<std::size_t>(view)] = true;
  }
  std::size_t count = 0;
  for (std::size_t view = 0; view < all.size(); ++view) {
    if (rejected[view]) continue;
    if (count != view) all[count] = std::move(all[view]);
    ++count;
  }
  all.resize(count);
  return kept;
}

}  // namespace evical
