#include "core/pipeline/pass/view_rejection.h"

#include "core/base/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

namespace evical {
namespace {

bool earlier(const BoardView& a, const BoardView& b) {
  return a.time_s < b.time_s;
}

// Updates the report of a view's window, which has the same centre time.
void reportAs(WindowOutcome outcome, double time_s, std::vector<WindowReport>& windows) {
  const auto window =
      std::lower_bound(windows.begin(), windows.end(), time_s,
                       [](const WindowReport& each, double at_s) { return each.time_s < at_s; });
  if (window != windows.end() && window->time_s == time_s) window->outcome = outcome;
}

double halfWidthAt_s(double time_s, const std::vector<WindowReport>& windows) {
  const auto window =
      std::lower_bound(windows.begin(), windows.end(), time_s,
                       [](const WindowReport& each, double at_s) { return each.time_s < at_s; });
  return window != windows.end() && window->time_s == time_s ? window->half_width_s : 0.0;
}

// By view: it is the nearest one to a rejected time, which is within its window. After another detection,
// windows may have other centres.
std::vector<bool> areRejected(const std::vector<double>& rejected_s, const std::vector<BoardView>& views,
                              const std::vector<WindowReport>& windows) {
  std::vector<bool> rejected(views.size(), false);
  for (const double time_s : rejected_s) {
    auto nearest = std::lower_bound(views.begin(), views.end(), time_s,
                                    [](const BoardView& each, double at_s) { return each.time_s < at_s; });
    if (nearest == views.end() ||
        (nearest != views.begin() && time_s - std::prev(nearest)->time_s < nearest->time_s - time_s)) {
      if (nearest == views.begin()) continue;
      --nearest;
    }
    if (std::abs(nearest->time_s - time_s) <= halfWidthAt_s(nearest->time_s, windows))
      rejected[static_cast<std::size_t>(nearest - views.begin())] = true;
  }
  return rejected;
}

void divide(const std::vector<double>& rejected_s, BoardObservations& camera,
            std::vector<BoardView>& rejected_views) {
  std::vector<BoardView> all;
  std::merge(std::move_iterator(camera.views.begin()), std::move_iterator(camera.views.end()),
             std::move_iterator(rejected_views.begin()), std::move_iterator(rejected_views.end()),
             std::back_inserter(all), earlier);
  camera.views.clear();
  rejected_views.clear();
  const std::vector<bool> are_rejected = areRejected(rejected_s, all, camera.windows);
  for (std::size_t i = 0; i < all.size(); ++i) {
    BoardView& view = all[i];
    const bool rejected = are_rejected[i];
    const WindowOutcome found =
        view.kind == ViewKind::Complete ? WindowOutcome::Complete : WindowOutcome::Partial;
    reportAs(rejected ? WindowOutcome::RejectedByHand : found, view.time_s, camera.windows);
    (rejected ? rejected_views : camera.views).push_back(std::move(view));
  }
}

}  // namespace

DetectionResult withRejected(const DetectionResult& pass, const RejectedTimes& rejected_s) {
  assert(rejected_s.size() == pass.cameras.size());
  DetectionResult divided = pass;
  divided.rejected_views.resize(pass.cameras.size());
  for (std::size_t k = 0; k < rejected_s.size(); ++k)
    divide(rejected_s[k], divided.cameras[k], divided.rejected_views[k]);
  divided.read_s = divided.detect_s = 0.0;
  return divided;
}

DetectionResult withoutViews(const DetectionResult& pass, std::size_t camera, std::span<const int> views) {
  assert(camera < pass.cameras.size());
  RejectedTimes rejected_s = rejectedTimes_s(pass);
  std::vector<double>& times_s = rejected_s[camera];
  for (const int view : views)
    times_s.push_back(pass.cameras[camera].views.at(static_cast<std::size_t>(view)).time_s);
  std::sort(times_s.begin(), times_s.end());
  return withRejected(pass, rejected_s);
}

RejectedTimes rejectedTimes_s(const DetectionResult& pass) {
  RejectedTimes times_s;
  for (const BoardObservations& camera : pass.cameras) times_s.push_back(rejectedTimes_s(camera));
  return times_s;
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
  std::string text = fmt::format("{}: {} with the board rejected by hand, at", camera.camera,
                                 counted(times_s.size(), "window"));
  for (std::size_t i = 0; i < shown; ++i) text += fmt::format("{} {:.3f}", i == 0 ? "" : ",", times_s[i]);
  if (times_s.size() > shown) text += fmt::format(" and {} more", times_s.size() - shown);
  return text + " s";
}

}  // namespace evical
