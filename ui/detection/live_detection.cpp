// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/live_detection.h"

#include "core/base/time.h"
#include "core/frontend/board_tracker.h"
#include "ui/detection/window_analysis.h"

#include <QMetaObject>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <list>
#include <utility>

namespace evical::ui {
namespace {

using Clock = std::chrono::steady_clock;
// Fast enough for the eye; pictures cost the run computing time.
constexpr auto kMinInterval = std::chrono::milliseconds(60);
constexpr auto kReportInterval = std::chrono::milliseconds(200);

}  // namespace

class LiveDetection::CameraObserver final : public FrontEndObserver {
 public:
  CameraObserver(std::shared_ptr<Mailbox<LiveWindow>> box, std::size_t camera, const BoardTracker& tracker,
                 const FrontEndOptions& options)
      : box_(std::move(box)),
        camera_(camera),
        tracker_(tracker),
        scene_(std::make_shared<BoardScene>(tracker.scene())),
        options_(options) {}

  void windowTracked(const BurstWindow& window, const WindowTrace& trace) override {
    start_ns_ = window.middle_ns() - nanosecondsFrom(trace.report.time_s);
    if (!due()) return;
    auto live = begin(window.middle_ns());
    const bool dark = scene_->board.circles == CircleShade::Dark;
    for (const WindowBurst& burst : window.bursts()) {
      if (std::abs(static_cast<double>(burst.time_s)) > trace.report.half_width_s) continue;
      live->bursts.push_back({window.middle_ns() + nanosecondsFrom(static_cast<double>(burst.time_s)),
                              static_cast<std::uint16_t>(burst.x_px), static_cast<std::uint16_t>(burst.y_px),
                              (burst.lead < 0.0f) == dark});
    }
    auto analysis = std::make_shared<WindowAnalysis>();
    analysis->half_width_s = trace.report.half_width_s;
    analysis->tracked = trace;
    analysis->outcome = trace.report.outcome;
    send(std::move(live), std::move(analysis));
  }

  void windowSearched(const BoardSearch& search, std::int64_t middle_ns) override {
    if (search.motion || !due()) return;  // a found board is tracked next
    auto live = begin(middle_ns);
    const std::int64_t half_ns = nanosecondsFrom(search.half_window_s);
    std::vector<EdgeCrossing> bursts;
    tracker_.history().gather(middle_ns - half_ns, middle_ns + half_ns, bursts);
    for (const EdgeCrossing& burst : bursts)
      live->bursts.push_back({burst.time_ns, burst.x_px, burst.y_px, burst.brighter});
    auto analysis = std::make_shared<WindowAnalysis>();
    analysis->half_width_s = search.half_window_s;
    analysis->outcome = search.outcome;
    analysis->searches = {search};
    send(std::move(live), std::move(analysis));
  }

 private:
  bool due() {
    const Clock::time_point now = Clock::now();
    if (now - sent_ < kMinInterval) return false;
    sent_ = now;
    return true;
  }

  std::shared_ptr<LiveWindow> begin(std::int64_t middle_ns) {
    auto live = std::make_shared<LiveWindow>();
    live->camera = camera_;
    live->middle_ns = middle_ns;
    if (start_ns_) live->time_s = secondsSince(*start_ns_, middle_ns);
    return live;
  }

  void send(std::shared_ptr<LiveWindow> live, std::shared_ptr<WindowAnalysis> analysis) {
    analysis->scene = scene_;
    analysis->time_s = live->time_s.value_or(0.0);
    analysis->stages = describeStages(*analysis, options_);
    live->analysis = std::move(analysis);
    if (!reports_ || reports_->empty() || sent_ - reported_ >= kReportInterval) {
      reported_ = sent_;
      reports_ = std::make_shared<std::vector<WindowReport>>(tracker_.observations().windows);
    }
    live->windows = reports_;
    box_->put(std::move(live));
  }

  std::shared_ptr<Mailbox<LiveWindow>> box_;
  std::size_t camera_;
  const BoardTracker& tracker_;
  std::shared_ptr<const BoardScene> scene_;
  FrontEndOptions options_;
  std::optional<std::int64_t> start_ns_;
  Clock::time_point sent_{}, reported_{};
  std::shared_ptr<const std::vector<WindowReport>> reports_;
};

class LiveDetection::RunObserver final : public CalibrationObserver {
 public:
  RunObserver(std::shared_ptr<Mailbox<LiveWindow>> box, const FrontEndOptions& options)
      : box_(std::move(box)), options_(options) {}

  FrontEndObserver* windowObserver(std::size_t camera, const BoardTracker& tracker) override {
    return &cameras_.emplace_back(box_, camera, tracker, options_);
  }

 private:
  std::shared_ptr<Mailbox<LiveWindow>> box_;
  FrontEndOptions options_;
  std::list<CameraObserver> cameras_;
};

LiveDetection::LiveDetection(QObject* parent)
    : QObject(parent), box_(std::make_shared<Mailbox<LiveWindow>>([this] {
        QMetaObject::invokeMethod(this, &LiveDetection::windowReady, Qt::QueuedConnection);
      })) {}

LiveDetection::~LiveDetection() {
  box_->close();
}

std::shared_ptr<CalibrationObserver> LiveDetection::observer(const FrontEndOptions& options) {
  return std::make_shared<RunObserver>(box_, options);
}

std::shared_ptr<const LiveWindow> LiveDetection::take() {
  return box_->take();
}

}  // namespace evical::ui
