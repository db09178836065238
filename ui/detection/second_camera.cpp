// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/second_camera.h"

#include "core/frames/frame_options.h"
#include "core/frontend/detection_options.h"
#include "ui/detection/event_view.h"

#include <QPainter>

#include <cmath>
#include <utility>

namespace evical::ui {

SecondCamera::SecondCamera(EventView& view, Reprojection reprojection, QObject* parent)
    : QObject(parent), view_(view), reprojection_(std::move(reprojection)) {}

SecondCamera::~SecondCamera() = default;

void SecondCamera::open(const Session& session, std::size_t camera) {
  close();
  camera_ = camera;
  view_.setMessage(tr("Opening the recording ..."));
  engine_ = std::make_unique<DetectionEngine>();
  connect(engine_.get(), &DetectionEngine::overviewChanged, this, &SecondCamera::takeOverview);
  connect(engine_.get(), &DetectionEngine::frameReady, this, [this] {
    view_.setFrame(engine_->takeFrame());
    refresh();
  });
  connect(engine_.get(), &DetectionEngine::analysisReady, this, [this] {
    analysis_ = engine_->takeAnalysis();
    refresh();
  });
  engine_->open(session, camera);
}

void SecondCamera::close() {
  engine_.reset();
  wish_.reset();
  analysis_.reset();
  view_.setFrame(nullptr);
}

void SecondCamera::know(const Session& session, const DetectionSetup& sight,
                        std::shared_ptr<const BoardObservations> seen) {
  if (!engine_) return;
  engine_->setOptions(*session.options.front_end, *session.options.frames);
  engine_->setSight(sight);
  engine_->setObservations(std::move(seen));
}

void SecondCamera::show(const DetectionRequest& wish, const LayerSet& layers) {
  if (!engine_) return;
  wish_ = wish;
  layers_ = layers;
  engine_->show(wish);
  refresh();
}

void SecondCamera::showLive(std::shared_ptr<const LiveWindow> window, const SurfaceStyle& style) {
  if (!engine_) return;
  analysis_ = window->analysis;
  engine_->showLive(std::move(window), style);
}

// More of the recording has been read.
void SecondCamera::takeOverview() {
  const RecordingOverview overview = engine_->overview();
  if (!overview.error.empty())
    view_.setMessage(tr("The recording cannot be read.\n%1").arg(QString::fromStdString(overview.error)));
  if (overview.started && wish_) engine_->show(*wish_);
}

void SecondCamera::refresh() {
  const auto& frame = view_.frame();
  if (!frame) return;
  const bool here = analysis_ && std::abs(analysis_->time_s - frame->time_s) <= analysis_->half_width_s;
  view_.setOverlay([analysis = here ? analysis_ : nullptr, layers = layers_,
                    reprojection = reprojection_(camera_, frame->time_s)](QPainter& painter, double scale) {
    paintLayers(painter, scale, layers, analysis.get(), reprojection);
  });
  emit frameReady();
}

}  // namespace evical::ui
