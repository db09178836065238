// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/live_view.h"

#include "core/data/intrinsics_result.h"

#include <utility>

namespace evical::ui {
namespace {

constexpr std::chrono::milliseconds kBetweenDetections{150};

QString liveText(std::string_view text) {
  return QString::fromUtf8(text.data(), static_cast<qsizetype>(text.size()));
}

// Tracking backwards inserts views before others, and finds more circles in some.
bool isCopyOf(const BoardView& copy, const BoardView& view) {
  return copy.time_s == view.time_s && copy.circles.size() == view.circles.size();
}

// Copies only views that `before` does not contain.
SharedViews viewsSoFar(const std::vector<BoardView>& views, const SharedViews& before) {
  SharedViews now;
  now.reserve(views.size());
  auto old = before.begin();
  for (const BoardView& view : views) {
    while (old != before.end() && (*old)->time_s < view.time_s) ++old;
    const bool known = old != before.end() && isCopyOf(**old, view);
    now.push_back(known ? *old : std::make_shared<const BoardView>(view));
  }
  return now;
}

}  // namespace

SharedViews sharedViews(const std::shared_ptr<const BoardObservations>& observations) {
  SharedViews views;
  for (const BoardView& view : observations->views) views.emplace_back(observations, &view);
  return views;
}

FrontEndObserver* LiveView::windowObserver(std::size_t camera, const BoardTracker& tracker) {
  return windows_ ? windows_->windowObserver(only_.value_or(camera), tracker) : nullptr;
}

void LiveView::windowsDetected(std::size_t camera, const BoardObservations& so_far) {
  const auto now = std::chrono::steady_clock::now();
  if (now < detected_next_) return;
  detected_next_ = now + kBetweenDetections;
  LiveCamera& detected = detected_.at(only_.value_or(camera));
  detected = {so_far.windows.size(), viewsSoFar(so_far.views, detected.views)};
  detections.put(std::make_shared<LiveDetections>(detected_));
}

void LiveView::intrinsicsPassDone(int pass, const IntrinsicsResult& so_far) {
  passes_.push_back({pass, so_far.views_found, so_far.reprojection_rms_px, so_far.moved_px});
  passes.put(std::make_shared<std::vector<LensPass>>(passes_));
}

void LiveView::initialisationStepDone(std::string_view step, std::string_view subject,
                                      std::string_view result, double duration_s) {
  notes_.push_back({liveText(step), liveText(subject), liveText(result), duration_s});
  notes.put(std::make_shared<std::vector<InitialisationNote>>(notes_));
}

void LiveView::iterationDone(const IterationRecord& iteration, const CalibrationState& state) {
  records_.push_back(iteration);
  iterations.put(std::make_shared<LiveIterations>(LiveIterations{records_, state}));
}

}  // namespace evical::ui
