#include "core/pipeline/detection/view_rejection.h"

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
  const auto window = std::ranges::lower_bound(windows, time_s, {}, &WindowReport::time_s);
  if (window != windows.end() && window->time_s == time_s) window->outcome = outcome;
}

bool hasBoard(const WindowReport& window) {
  return window.outcome == WindowOutcome::Complete || window.outcome == WindowOutcome::Partial ||
         window.outcome == WindowOutcome::RejectedByHand;
}

// The window with the board that contains this time; null: none. Frames without exposure have no width, and
// people round.
const WindowReport* windowWithBoardAt(double time_s, const BoardObservations& camera) {
  constexpr double kRounding_s = 1e-3;
  const auto from = std::ranges::lower_bound(camera.windows, time_s, {}, &WindowReport::time_s);
  const auto later = std::find_if(from, camera.windows.end(), hasBoard);
  const auto before = std::find_if(std::make_reverse_iterator(from), camera.windows.rend(), hasBoard);
  const WindowReport* nearest = later == camera.windows.end() ? nullptr : &*later;
  if (before != camera.windows.rend() &&
      (nearest == nullptr || time_s - before->time_s <= nearest->time_s - time_s))
    nearest = &*before;
  if (nearest == nullptr) return nullptr;
  const double reach_s = std::max(kRounding_s, nearest->half_width_s);
  return std::abs(nearest->time_s - time_s) <= reach_s ? nearest : nullptr;
}

// Times of another recording, say, or with a typing error, exclude nothing.
void noteUnmatched(const SessionCamera& camera, const BoardObservations& observations,
                   std::vector<RecordingFault>& faults) {
  std::vector<double> unmatched_s;
  for (const double time_s : camera.rejected_windows_s)
    if (windowWithBoardAt(time_s, observations) == nullptr) unmatched_s.push_back(time_s);
  if (unmatched_s.empty()) return;
  addUnlessListed(
      {camera.stream, FaultKind::Outside, unmatched_s.front(),
       fmt::format("{}: the board was not found at {} of its {} in rejected_windows_s, first at {:.3f} s",
                   camera.name, unmatched_s.size(), counted(camera.rejected_windows_s.size(), "time"),
                   unmatched_s.front())},
      faults);
}

void divide(const std::vector<double>& rejected_s, BoardObservations& camera,
            std::vector<BoardView>& rejected_views) {
  std::vector<BoardView> all;
  std::merge(std::move_iterator(camera.views.begin()), std::move_iterator(camera.views.end()),
             std::move_iterator(rejected_views.begin()), std::move_iterator(rejected_views.end()),
             std::back_inserter(all), earlier);
  camera.views.clear();
  rejected_views.clear();
  const std::vector<double> centres_s = windowsAt(rejected_s, camera);
  for (BoardView& view : all) {
    const bool rejected = std::ranges::binary_search(centres_s, view.time_s);
    const WindowOutcome found =
        view.kind == ViewKind::Complete ? WindowOutcome::Complete : WindowOutcome::Partial;
    reportAs(rejected ? WindowOutcome::RejectedByHand : found, view.time_s, camera.windows);
    (rejected ? rejected_views : camera.views).push_back(std::move(view));
  }
}

}  // namespace

DetectionResult withRejected(const DetectionResult& detections, const RejectedTimes& rejected_s) {
  assert(rejected_s.size() == detections.cameras.size());
  DetectionResult divided = detections;
  divided.rejected_views.resize(detections.cameras.size());
  for (std::size_t k = 0; k < rejected_s.size(); ++k)
    divide(rejected_s[k], divided.cameras[k], divided.rejected_views[k]);
  divided.read_s = divided.detect_s = 0.0;
  return divided;
}

std::vector<double> windowsAt(const std::vector<double>& times_s, const BoardObservations& camera) {
  std::vector<double> centres_s;
  for (const double time_s : times_s) {
    const WindowReport* const window = windowWithBoardAt(time_s, camera);
    centres_s.push_back(window != nullptr ? window->time_s : time_s);
  }
  std::ranges::sort(centres_s);
  centres_s.erase(std::unique(centres_s.begin(), centres_s.end()), centres_s.end());
  return centres_s;
}

void rejectAsIn(const Session& session, DetectionResult& detections) {
  for (std::size_t k = 0; k < std::min(session.cameras.size(), detections.cameras.size()); ++k) {
    std::vector<double> times_s = session.cameras[k].rejected_windows_s;
    if (times_s.empty()) continue;
    noteUnmatched(session.cameras[k], detections.cameras[k], detections.faults);
    detections.rejected_views.resize(detections.cameras.size());
    const std::vector<double> before_s = rejectedTimes_s(detections.cameras[k]);
    times_s.insert(times_s.end(), before_s.begin(), before_s.end());
    divide(times_s, detections.cameras[k], detections.rejected_views[k]);
  }
}

DetectionResult withoutViews(const DetectionResult& detections, std::size_t camera,
                             std::span<const int> views) {
  assert(camera < detections.cameras.size());
  RejectedTimes rejected_s = rejectedTimes_s(detections);
  std::vector<double>& times_s = rejected_s[camera];
  for (const int view : views)
    times_s.push_back(detections.cameras[camera].views.at(static_cast<std::size_t>(view)).time_s);
  std::sort(times_s.begin(), times_s.end());
  return withRejected(detections, rejected_s);
}

RejectedTimes rejectedTimes_s(const DetectionResult& detections) {
  RejectedTimes times_s;
  for (const BoardObservations& camera : detections.cameras) times_s.push_back(rejectedTimes_s(camera));
  return times_s;
}

std::vector<double> rejectedTimes_s(const BoardObservations& camera) {
  std::vector<double> times_s;
  for (const WindowReport& window : camera.windows)
    if (window.outcome == WindowOutcome::RejectedByHand) times_s.push_back(window.time_s);
  return times_s;
}

std::string rejectedSentence(const BoardObservations& camera) {
  constexpr std::size_t kMaxTimes = 20;
  const std::vector<double> times_s = rejectedTimes_s(camera);
  if (times_s.empty()) return {};
  const std::size_t shown = std::min(times_s.size(), kMaxTimes);
  std::string text = fmt::format("{}: {} with the board rejected by hand, at", camera.camera,
                                 counted(times_s.size(), "window"));
  for (std::size_t i = 0; i < shown; ++i) text += fmt::format("{} {:.3f}", i == 0 ? "" : ",", times_s[i]);
  if (times_s.size() > shown) text += fmt::format(" and {} more", times_s.size() - shown);
  return text + " s";
}

}  // namespace evical
