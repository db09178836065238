#include "core/frontend/board_tracker.h"

#include "core/base/time.h"
#include "core/frontend/board_extent.h"
#include "core/frontend/board_search.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace evical {
namespace {

constexpr std::int64_t kLongAgo = std::numeric_limits<std::int64_t>::min() / 2;
constexpr std::int64_t kLongPause_ns = 1'000'000'000;
constexpr double kSearchIntervalGrowth = 1.2;  // per search without result

}  // namespace

BoardTracker::BoardTracker(const Board& board, Resolution resolution_px,
                           std::optional<CameraIntrinsics> camera, const FrontEndOptions& options,
                           std::int64_t start_ns)
    : scene_(board, resolution_px, std::move(camera)),
      given_options_(options),
      options_(options),
      start_ns_(start_ns),
      window_(scene_),
      complete_until_ns_(kLongAgo),
      last_burst_ns_(kLongAgo),
      last_search_ns_(kLongAgo),
      search_interval_s_(options.detection.search_interval_s),
      tracked_until_ns_(kLongAgo),
      placement_watch_(scene_, options.grid) {}

void BoardTracker::add(EventSpan events) {
  if (events.empty()) return;
  if (!extractor_) extractor_.emplace(scene_.resolution_px, burstsFor(scene_.board, options_.bursts));
  new_bursts_.clear();
  extractor_->add(events, new_bursts_);
  addBursts(new_bursts_, events.front().time_ns, extractor_->completeUntil_ns());
}

void BoardTracker::addBursts(const std::vector<EdgeCrossing>& bursts, std::int64_t first_event_ns,
                             std::int64_t complete_until_ns) {
  if (!started_) {
    next_begin_ns_ = first_event_ns;
    started_ = true;
  }
  history_.add(bursts);
  for (const EdgeCrossing& burst : bursts) last_burst_ns_ = std::max(last_burst_ns_, burst.time_ns);
  complete_until_ns_ = complete_until_ns;
  processWindows();
}

BoardObservations BoardTracker::finish() {
  new_bursts_.clear();
  if (extractor_) extractor_->finish(new_bursts_);
  for (const EdgeCrossing& burst : new_bursts_) last_burst_ns_ = std::max(last_burst_ns_, burst.time_ns);
  history_.add(new_bursts_);
  const std::int64_t shortest_ns = nanosecondsFrom(options_.detection.min_window_s);
  while (started_ && next_begin_ns_ + shortest_ns < last_burst_ns_ && !stop_.stop_requested()) {
    skipEmptyTime(last_burst_ns_);
    const WindowSlot slot = nextSlot();
    processSlot(slot);
    next_begin_ns_ = slot.end_ns;
  }
  endTrack();
  if (extractor_) observations_.events = extractor_->eventCount();
  const auto earlier = [](const auto& a, const auto& b) { return a.time_s < b.time_s; };
  std::sort(observations_.views.begin(), observations_.views.end(), earlier);
  std::sort(observations_.windows.begin(), observations_.windows.end(), earlier);
  observations_.single_events = scene_.single_events;
  observations_.polarity_delay = polarity_delay_.result(scene_.board.circles);
  return std::move(observations_);
}

std::string BoardTracker::doubt() const {
  return numbers_ ? otherTagsText(scene_.board, numbers_->first, numbers_->second) : std::string();
}

std::string BoardTracker::remark() const {
  if (!scene_.edges || !scene_.board.hasTags()) return {};
  const TagPrint& print = scene_.edges->print;
  const int counterclockwise = (kTagCornerCount - print.quarter_turns) % kTagCornerCount;
  return scene_.board.type == BoardType::AprilGrid ? layoutRemark({print.order, counterclockwise})
                                                   : markerRemark(counterclockwise);
}

std::int64_t BoardTracker::slotLength_ns(const BoardMotion* motion) const {
  const DetectionOptions& d = options_.detection;
  if (!motion) return nanosecondsFrom(0.5 * (d.min_window_s + d.max_window_s));
  const double speed = std::max(boardSpeed_px_s(*motion, scene_), 1.0);
  return nanosecondsFrom(std::clamp(d.window_travel_px / speed, d.min_window_s, d.max_window_s));
}

WindowSlot BoardTracker::nextSlot() const {
  return {next_begin_ns_, next_begin_ns_ + slotLength_ns(motion_ ? &*motion_ : nullptr)};
}

// Skips long times without motion, which have no windows to process.
void BoardTracker::skipEmptyTime(std::int64_t until_ns) {
  if (motion_) return;
  const std::int64_t margin_ns = nanosecondsFrom(options_.tracking.max_fit_half_window_s);
  const std::int64_t next_ns = history_.nextAfter(next_begin_ns_ - margin_ns).value_or(until_ns);
  const std::int64_t end_ns = std::min(next_ns, until_ns) - margin_ns;
  if (end_ns - next_begin_ns_ > kLongPause_ns) next_begin_ns_ = end_ns;
}

void BoardTracker::processWindows() {
  const std::int64_t margin_ns = nanosecondsFrom(options_.tracking.max_fit_half_window_s);
  while (!stop_.stop_requested()) {
    skipEmptyTime(complete_until_ns_);
    const WindowSlot slot = nextSlot();
    if (slot.end_ns + margin_ns > complete_until_ns_) return;
    processSlot(slot);
    next_begin_ns_ = slot.end_ns;
    history_.dropBefore(slot.begin_ns - margin_ns - nanosecondsFrom(options_.detection.history_s));
  }
}

void BoardTracker::processSlot(const WindowSlot& slot) {
  const std::int64_t middle_ns = slot.middle_ns();
  if (motion_) {
    if (scene_.single_events) searchNearPrediction(middle_ns);
    WindowTrace trace = track(slot, *motion_);
    if (trace.held()) {
      reconsiderPlacement(slot, trace);
      motion_ = trace.motion;
      tracked_until_ns_ = slot.end_ns;
      keep(trace);
      return;
    }
    if (static_cast<double>(middle_ns - motion_->time_ns) * 1e-9 > options_.tracking.max_gap_s) {
      motion_.reset();
      endTrack();
      if (scene_.single_events && observations_.views.empty())
        useSingleEvents(false);  // it was not the board
    }
  }
  if (middle_ns - last_search_ns_ < nanosecondsFrom(search_interval_s_)) {
    miss(slot, nullptr);
    return;
  }
  last_search_ns_ = middle_ns;
  const BoardSearch search = searchWindow(middle_ns);
  if (observer_) observer_->windowSearched(search, middle_ns);
  if (search.outcome == WindowOutcome::TooSmall)
    observations_.narrowest_px = std::max(observations_.narrowest_px, search.narrowest_px);
  if (search.extent.rows.lines > 0) countWhole(search.extent.rows.lines, observations_.extent.rows);
  if (search.extent.cols.lines > 0) countWhole(search.extent.cols.lines, observations_.extent.cols);
  if (search.numbers && !scene_.print_known) {
    const auto [first, last] = numbers_.value_or(*search.numbers);
    numbers_ = {std::min(first, search.numbers->first), std::max(last, search.numbers->second)};
  }
  if (search.motion) {
    search_interval_s_ = options_.detection.search_interval_s;
    scene_.print_known = true;
    numbers_.reset();
    if (search.edges && search.edges != scene_.edges) {
      scene_.edges = search.edges;
      placement_watch_ = PlacementWatch(scene_, options_.grid);
    }
    acquire(slot, *search.motion, search.distinguished);
  } else {
    search_interval_s_ =
        std::min(kSearchIntervalGrowth * search_interval_s_, options_.detection.max_search_interval_s);
    miss(slot, &search);
  }
}

// A search tries single events, too, while the board is hardly found and they are many more than bursts.
BoardSearch BoardTracker::searchWindow(std::int64_t middle_ns) {
  constexpr std::int64_t kAround_ns = 50'000'000;
  constexpr std::size_t kManyMore = 3;
  constexpr double kFound = 0.1;  // of the windows
  BoardSearch search = searchBoard(history_, middle_ns, scene_, options_).back();
  const bool found_often = kFound * static_cast<double>(observations_.windows.size()) <
                           static_cast<double>(observations_.views.size());
  if (search.motion || scene_.single_events || found_often) return search;
  const std::size_t all = history_.count(middle_ns - kAround_ns, middle_ns + kAround_ns, true),
                    bursts = history_.count(middle_ns - kAround_ns, middle_ns + kAround_ns, false);
  if (all < kManyMore * bursts || all == bursts) return search;
  BoardScene scene = scene_;
  scene.single_events = true;
  BoardSearch in_single = searchBoard(history_, middle_ns, scene, forSingleEvents(options_)).back();
  // Most single events are noise, unless edges fire no more.
  if (!in_single.motion || in_single.motion->typical_events > 1.0) return search;
  useSingleEvents(true);
  return in_single;
}

void BoardTracker::useSingleEvents(bool use) {
  scene_.single_events = use;
  options_ = use ? forSingleEvents(given_options_) : given_options_;
  window_ = BurstWindow(scene_);
}

// Single events hardly determine the motion across edges that move along themselves, and a fit from window to
// window drifts. Each window is searched; the board is expected near its prediction.
void BoardTracker::searchNearPrediction(std::int64_t middle_ns) {
  constexpr std::int64_t kLongest_ns = 150'000'000;  // later, another placement may be as near
  if (middle_ns - motion_->time_ns > kLongest_ns) return;
  const BoardSearch search = searchBoard(history_, middle_ns, scene_, options_).back();
  if (!search.motion) return;
  const auto shift =
      placement_watch_.continuationOf(predicted(*motion_, middle_ns), *search.motion, scene_.board);
  if (shift) motion_ = shifted(*search.motion, *shift);
}

void BoardTracker::acquire(const WindowSlot& slot, const BoardMotion& motion, bool distinguished) {
  WindowTrace trace = track(slot, motion);
  if (!trace.held()) {
    miss(slot, nullptr);
    return;
  }
  trace.report.tracked = false;
  motion_ = trace.motion;
  endTrack();
  placement_watch_.begin(scene_.edges ? std::optional(distinguished) : std::nullopt);
  trackBackwards(slot, *trace.motion);
  tracked_until_ns_ = slot.end_ns;
  keep(trace);
}

void BoardTracker::trackBackwards(const WindowSlot& from, BoardMotion motion) {
  const std::int64_t oldest_ns =
      std::max(tracked_until_ns_, from.begin_ns - nanosecondsFrom(options_.detection.history_s));
  std::int64_t end_ns = from.begin_ns;
  while (end_ns > oldest_ns) {
    const std::int64_t length_ns = slotLength_ns(&motion);
    const WindowSlot slot{std::max(end_ns - length_ns, oldest_ns), end_ns};
    if (slot.end_ns - slot.begin_ns < nanosecondsFrom(0.5 * options_.detection.min_window_s)) break;
    WindowTrace trace = track(slot, motion);
    if (!trace.held()) break;
    motion = *trace.motion;
    std::erase_if(observations_.windows, [&](const WindowReport& report) {
      return report.time_s >= secondsSince(start_ns_, slot.begin_ns) &&
             report.time_s < secondsSince(start_ns_, end_ns) && !report.tracked;
    });
    keep(trace);
    end_ns = slot.begin_ns;
  }
}

WindowTrace BoardTracker::track(const WindowSlot& slot, const BoardMotion& last) {
  WindowTrace trace = trackWindow({history_, scene_, options_, start_ns_}, slot, last, window_);
  // Single events are too few to tell whether a line of corners is missing.
  if (trace.held() && !scene_.single_events && held_windows_++ % options_.extent.every_windows == 0)
    judgeExtent(window_, trace, scene_, options_, observations_.extent);
  if (observer_) observer_->windowTracked(window_, trace);
  return trace;
}

void BoardTracker::reconsiderPlacement(const WindowSlot& slot, WindowTrace& trace) {
  if (!placement_watch_.isDue()) {
    placement_watch_.skip();
    return;
  }
  const std::optional<Eigen::Matrix3d> shift =
      placement_watch_.look(window_, trace, scene_, options_.tracking);
  if (placement_watch_.isSettled()) open_begin_ = observations_.views.size();
  if (!shift) return;
  WindowTrace anew =
      trackWindow({history_, scene_, options_, start_ns_}, slot, shifted(*trace.motion, *shift), window_);
  if (!anew.held() || anew.report.circles <= trace.report.circles) return;
  // The counts of the extent are kept: if the board has more rows than the session states, placements keep
  // changing.
  renumberTrack(*shift);
  trace = std::move(anew);
}

// Circles seen since the placement was last confirmed, with their present numbers.
void BoardTracker::renumberTrack(const Eigen::Matrix3d& shift) {
  const std::vector<int> now = renumbering(scene_.board, shift);
  const auto begin = observations_.views.begin() + static_cast<std::ptrdiff_t>(open_begin_);
  for (auto view = begin; view != observations_.views.end(); ++view) {
    for (CircleObservation& circle : view->circles)
      circle.circle = now[static_cast<std::size_t>(circle.circle)];
    std::erase_if(view->circles, [](const CircleObservation& circle) { return circle.circle < 0; });
    std::sort(view->circles.begin(), view->circles.end(),
              [](const auto& a, const auto& b) { return a.circle < b.circle; });
    WindowReport& report = reportOf(*view);
    report.circles = static_cast<int>(view->circles.size());
    report.outcome = outcomeOf(report.circles, scene_, options_.grid);
    view->kind = report.outcome == WindowOutcome::Complete ? ViewKind::Complete : ViewKind::Partial;
    if (report.outcome == WindowOutcome::TooFewInGrid) view->circles.clear();
  }
  observations_.views.erase(
      std::remove_if(begin, observations_.views.end(), [](const auto& view) { return view.circles.empty(); }),
      observations_.views.end());
}

// Views of a board that no window distinguished from its rivals are discarded.
void BoardTracker::endTrack() {
  std::vector<BoardView>& views = observations_.views;
  if (!placement_watch_.isDistinguished() && open_begin_ < views.size()) {
    for (std::size_t k = open_begin_; k < views.size(); ++k)
      reportOf(views[k]).outcome = WindowOutcome::Ambiguous;
    views.resize(open_begin_);
  }
  open_begin_ = views.size();
}

WindowReport& BoardTracker::reportOf(const BoardView& view) {
  const auto report = std::find_if(observations_.windows.rbegin(), observations_.windows.rend(),
                                   [&](const auto& window) { return window.time_s == view.time_s; });
  assert(report != observations_.windows.rend());
  return *report;
}

void BoardTracker::keep(WindowTrace& trace) {
  observations_.windows.push_back(trace.report);
  if (trace.report.outcome == WindowOutcome::TooFewInGrid) return;
  const bool complete = trace.report.outcome == WindowOutcome::Complete;
  polarity_delay_.add(boardSpeed_px_s(*trace.motion, scene_), trace.motion->radius_offset_px);
  observations_.views.push_back(
      {trace.report.time_s, complete ? ViewKind::Complete : ViewKind::Partial, std::move(trace.circles)});
}

void BoardTracker::miss(const WindowSlot& slot, const BoardSearch* search) {
  WindowReport report;
  report.time_s = secondsSince(start_ns_, slot.middle_ns());
  report.half_width_s = slot.half_s();
  report.events = static_cast<int>(history_.count(slot.begin_ns, slot.end_ns, scene_.single_events));
  if (search) {
    report.outcome = search->outcome;
    report.candidates = static_cast<int>(search->candidates.size() + search->saddles.size());
  } else if (report.events >= options_.detection.min_window_bursts) {
    // Between two searches: the same reason as the search before.
    report.outcome =
        observations_.windows.empty() ? WindowOutcome::TooFewCircles : observations_.windows.back().outcome;
    if (report.outcome == WindowOutcome::Complete || report.outcome == WindowOutcome::Partial) {
      report.outcome = WindowOutcome::RefinementFailed;
    }
  }
  observations_.windows.push_back(report);
}

}  // namespace evical
