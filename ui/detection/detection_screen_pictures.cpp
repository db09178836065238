// SPDX-License-Identifier: GPL-3.0-or-later
// Two cameras of a rig in one view: of different kinds, or of the same kind.
#include "core/optimisation/optimisation_options.h"
#include "ui/detection/detection_engine.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/event_view.h"
#include "ui/detection/second_camera.h"
#include "ui/detection/trajectory_pose.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QListView>
#include <QSignalBlocker>
#include <QStandardItemModel>

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

// The measured board view of the shown window; empty if there is none.
BoardView viewAt(const std::vector<BoardObservations>& cameras, std::size_t camera, double time_s) {
  if (camera >= cameras.size()) return {};
  constexpr double kHalfWindow_s = 0.05;
  const BoardView* nearest = nullptr;
  double distance_s = kHalfWindow_s;
  for (const BoardView& view : cameras[camera].views) {
    if (std::abs(view.time_s - time_s) > distance_s) continue;
    distance_s = std::abs(view.time_s - time_s);
    nearest = &view;
  }
  return nearest != nullptr ? *nearest : BoardView{};
}

}  // namespace

void DetectionScreen::connectPictures() {
  connect(engine_.get(), &DetectionEngine::companionReady, this, &DetectionScreen::takeCompanion);
  second_camera_ = new SecondCamera(
      *companion_view_,
      [this](std::size_t camera, double time_s) { return reprojectionInto(camera, time_s); }, this);
  connect(second_camera_, &SecondCamera::frameReady, this, &DetectionScreen::refreshCompanion);
  connect(picture_box_, &QComboBox::currentIndexChanged, this, [this] {
    offerPictures();
    request();
    refresh();
  });
}

void DetectionScreen::setPicture(PictureChoice picture) {
  picture_box_->setCurrentIndex(static_cast<int>(picture));
}

PictureChoice DetectionScreen::picture() const {
  const auto chosen = static_cast<PictureChoice>(picture_box_->currentIndex());
  const bool possible =
      chosen == PictureChoice::Overlaid ? companion_ && whyNoOverlay().isEmpty() : companion_ || second_;
  return possible ? chosen : PictureChoice::Alone;
}

QString DetectionScreen::whyNoOverlay() const {
  if (!companion_) return tr("There is no camera of the other kind");
  if (!framesInView()) return tr("Choose the frame camera: events are drawn over its picture");
  const CalibrationRun* const run = runInView();
  if (!run) return tr("Calibrate first: the projection of events into the frame needs the result");
  if (!EventsOverFrame::isPossible(run->result.state, *companion_, camera_))
    return tr("The last run lacks a lens of the two cameras, or the trajectory");
  if (run_session_.boardIndexOf(camera_) + run_session_.boardIndexOf(*companion_) > 0)
    return tr("Both cameras must see the first board, whose frame is the world frame");
  return {};
}

void DetectionScreen::offerPictures() {
  const QString why_not = whyNoOverlay();
  const QSignalBlocker quiet(picture_box_);
  const auto overlaid = static_cast<int>(PictureChoice::Overlaid);
  if ((companion_ || second_) && !why_not.isEmpty() && picture_box_->currentIndex() == overlaid)
    picture_box_->setCurrentIndex(static_cast<int>(PictureChoice::Alone));
  picture_box_->setVisible(companion_ || second_);
  picture_box_->setItemText(static_cast<int>(PictureChoice::Alone), second_          ? tr("This camera")
                                                                    : framesInView() ? tr("Frame")
                                                                                     : tr("Events"));
  picture_box_->setItemText(static_cast<int>(PictureChoice::SideBySide),
                            second_ ? tr("Both cameras") : tr("Side by side"));
  qobject_cast<QListView*>(picture_box_->view())->setRowHidden(overlaid, second_.has_value());
  auto* const item = qobject_cast<QStandardItemModel*>(picture_box_->model())->item(overlaid);
  item->setEnabled(why_not.isEmpty());
  const QString help =
      tr("Each event is projected into the frame at the frame's time: from its pixel to the board's "
         "plane and\ninto the frame, through the lenses, poses and time offsets of the last run");
  item->setToolTip(why_not.isEmpty() ? help : why_not);
  picture_box_->setToolTip(why_not.isEmpty() || second_ ? tr("Picture of this camera, or of both")
                                                        : tr("No events over the frame: %1").arg(why_not));
  const bool beside = picture() == PictureChoice::SideBySide;
  companion_view_->setVisible(beside);
  const bool fades = !framesInView() || picture() != PictureChoice::Alone;
  fade_label_->setVisible(fades);
  fade_box_->setVisible(fades);
}

void DetectionScreen::takeCompanion() {
  companion_view_->setFrame(engine_->takeCompanion());
  refreshCompanion();
}

QString DetectionScreen::captionOf(const SurfaceFrame& frame) {
  QString text = tr("%1 s").arg(frame.time_s, 0, 'f', 4);
  if (const auto& label = frame.photograph)
    text += tr("    frame %L1 of %L2")
                .arg(static_cast<qulonglong>(label->number))
                .arg(static_cast<qulonglong>(label->count));
  if (frame.window_events)
    text += tr("    %L1 events in the event window").arg(static_cast<qulonglong>(*frame.window_events));
  else if (!frame.photograph || frame.events > 0)
    text += tr("    %L1 events").arg(static_cast<qulonglong>(frame.events));
  return text;
}

ColourLegend DetectionScreen::legendOf(const SurfaceFrame& frame, SurfaceMode mode) {
  if (frame.photograph) return frame.events > 0 ? ColourLegend::Polarity : ColourLegend::None;
  return mode == SurfaceMode::NormalFlow ? ColourLegend::Direction : ColourLegend::Polarity;
}

std::vector<QPolygonF> DetectionScreen::reprojectionInto(std::size_t camera, double time_s) const {
  const CalibrationRun* const run = runInView();
  if (!run || !hasPoses(*run) || !shown(Layer::Reprojection)) return {};
  return reprojectBoard(run->result.state, camera, run_session_.seenBoard(camera), time_s,
                        viewAt(run->detections.cameras, camera, time_s),
                        run_session_.options.optimisation->slow_edge_speed_px_s);
}

std::shared_ptr<const BoardObservations> DetectionScreen::seenBy(std::size_t camera) const {
  if (runInView() == nullptr) return nullptr;
  return {run_, &run_->detections.cameras.at(camera)};
}

void DetectionScreen::keepSecondOpen() {
  if (!second_ || picture() != PictureChoice::SideBySide) return second_camera_->close();
  if (!second_camera_->isOf(*second_)) second_camera_->open(*session_, *second_);
}

// At the same moment, if a result contains the time offset between the clocks.
void DetectionScreen::showSecond(const DetectionRequest& wish) {
  if (!second_ || !second_camera_->isOf(*second_)) return;
  second_camera_->know(*session_, detectionSetupOf(*second_), seenBy(*second_));
  DetectionRequest there = wish;
  const CalibrationRun* const run = runInView();
  if (run && std::max(camera_, *second_) < run->result.state.cameras.size())
    there.time_s =
        timeOnClockOf_s(run->result.state.cameras[*second_], run->result.state.cameras[camera_], wish.time_s);
  there.picture = PictureChoice::Alone;
  second_camera_->show(there, layers_);
}

void DetectionScreen::refreshCompanion() {
  const auto& frame = companion_view_->frame();
  const auto shown = companion_ ? companion_ : second_;
  if (!frame || !shown || picture() != PictureChoice::SideBySide) return;
  companion_view_->setCaption(QString::fromStdString(session_->cameras[*shown].name) + tr("    ") +
                              captionOf(*frame));
  companion_view_->setLegend(legendOf(*frame, companion_ ? SurfaceMode::Decayed : style().mode));
  if (!companion_) return;  // the second camera has its own layers
  companion_view_->setOverlay(
      [reprojection = reprojectionInto(*companion_, frame->time_s)](QPainter& painter, double scale) {
        LayerSet layers;
        layers.set(static_cast<std::size_t>(Layer::Reprojection));
        paintLayers(painter, scale, layers, nullptr, reprojection);
      });
}

}  // namespace evical::ui
