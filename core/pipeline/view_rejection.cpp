#include "core/pipeline/view_rejection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

namespace evical {
namespace {

// Each view is of one window: of the same middle.
void markWindows(const std::vector<BoardView>& views, const std::vector<bool>& rejected,
                 std::vector<WindowReport>& windows) {
  auto window = windows.begin();
  for (std::size_t view = 0; view < views.size(); ++view) {
    if (!rejected[view]) continue;
    const auto before = [](const WindowReport& each, double time_s) { return each.time_s < time_s; };
    window = std::lower_bound(window, windows.end(), views[view].time_s, before);
    if (window != windows.end() && window->time_s == views[view].time_s)
      window->outcome = WindowOutcome::RejectedByHand;
  }
}

}  // namespace

RecordingPass withoutViews(const RecordingPass& pass, std::size_t camera, std::span<const int> views) {
  assert(camera < pass.cameras.size());
  RecordingPass kept = pass;
  std::vector<BoardView>& all = kept.cameras[camera].views;
  std::vector<bool> rejected(all.size(), false);
  for (const int view : views) {
    assert(view >= 0 && static_cast<std::size_t>(view) < all.size());
    rejected[static_cast<std::size_t>(view)] = true;
  }
  markWindows(all, rejected, kept.cameras[camera].windows);
  kept.read_s = kept.detect_s = 0.0;
  std::size_t count = 0;
  for (std::size_t view = 0; view < all.size(); ++view) {
    if (rejected[view]) continue;
    if (count != view) all[count] = std::move(all[view]);
    ++count;
  }
  all.resize(count);
  return kept;
}

std::vector<double> rejectedTimes_s(const BoardObservations& camera) {
  std::vector<double> times_s;
  for (const WindowReport& window : camera.windows)
    if (window.outcome == WindowOutcome::RejectedByHand) times_s.push_back(window.time_s);
  return times_s;
}

std::string rejectedSentence(const BoardObservations& camera) {
  constexpr std::size_t kMostTimes = 20;
  const std::vector<double> times_s = rejectedTimes_s(camera);
  if (times_s.empty()) return {};
  const std::size_t shown = std::min(times_s.size(), kMostTimes);
  std::string text = fmt::format("{}: a person rejected {} window{} with the board, at", camera.camera,
                                 times_s.size(), times_s.size() == 1 ? "" : "s");
  for (std::size_t i = 0; i < shown; ++i) text += fmt::format("{} {:.3f}", i == 0 ? "" : ",", times_s[i]);
  if (times_s.size() > shown) text += fmt::format(" and {} more", times_s.size() - shown);
  return text + " s";
}

}  // namespace evical
