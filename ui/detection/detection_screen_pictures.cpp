// SPDX-License-Identifier: GPL-3.0-or-later
// The two cameras of a rig with events and frames in one sight.
#include "ui/detection/detection_engine.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/event_view.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QSignalBlocker>
#include <QStandardItemModel>

#include <cmath>

namespace evical::ui {
namespace {

// The measured view of the window in sight; empty where there is none.
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
  const bool possible = companion_ && (chosen != PictureChoice::Overlaid || whyNoOverlay().isEmpty());
  return possible ? chosen : PictureChoice::Alone;
}

QString DetectionScreen::whyNoOverlay() const {
  if (!companion_) return tr("There is no camera of the other kind");
  if (!framesInView()) return tr("Choose the camera with frames: events are drawn over its picture");
  const CalibrationRun* const run = runInView();
  if (!run) return tr("Calibrate first: the result tells where the frame camera sees what events saw");
  if (!EventsOverFrame::isPossible(run->result.state, *companion_, camera_))
    return tr("The last run has no lens of one of the two cameras, or no trajectory");
  if (run_session_.boardIndexOf(camera_) + run_session_.boardIndexOf(*companion_) > 0)
    return tr("Both cameras must see one board, whose frame is the world");
  return {};
}

void DetectionScreen::offerPictures() {
  const QString why_not = whyNoOverlay();
  const QSignalBlocker quiet(picture_box_);
  const auto overlaid = static_cast<int>(PictureChoice::Overlaid);
  if (companion_ && !why_not.isEmpty() && picture_box_->currentIndex() == overlaid)
    picture_box_->setCurrentIndex(static_cast<int>(PictureChoice::Alone));
  picture_box_->setVisible(companion_.has_value());
  picture_box_->setItemText(static_cast<int>(PictureChoice::Alone),
                            framesInView() ? tr("Frame") : tr("Events"));
  auto* const item = qobject_cast<QStandardItemModel*>(picture_box_->model())->item(overlaid);
  item->setEnabled(why_not.isEmpty());
  const QString help =
      tr("Each event where the frame camera sees it at the frame's time: from its pixel to the board's "
         "plane and\ninto the frame, through the lenses, poses and time offsets of the last run");
  item->setToolTip(why_not.isEmpty() ? help : why_not);
  picture_box_->setToolTip(why_not.isEmpty() ? tr("This camera's picture, or both cameras'")
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
  const auto drawn = static_cast<qulonglong>(frame.events);
  if (frame.window_events && *frame.window_events != frame.events)
    text += tr("    %L1 events in the window, %L2 drawn")
                .arg(static_cast<qulonglong>(*frame.window_events))
                .arg(drawn);
  else if (frame.window_events)
    text += tr("    %L1 events in the window").arg(drawn);
  else if (!frame.photograph || frame.events > 0)
    text += tr("    %L1 events").arg(drawn);
  return text;
}

std::vector<QPolygonF> DetectionScreen::reprojectionInto(std::size_t camera, double time_s) const {
  const CalibrationRun* const run = runInView();
  if (!run || !hasPoses(*run) || !shown(Layer::Reprojection)) return {};
  return reprojectBoard(run->result.state, camera, run_session_.seenBoard(camera), time_s,
                        viewAt(run->pass.cameras, camera, time_s),
                        run_session_.options.optimisation.slow_edge_speed_px_s);
}

void DetectionScreen::refreshCompanion() {
  const auto& frame = companion_view_->frame();
  if (!frame || !companion_ || picture() != PictureChoice::SideBySide) return;
  companion_view_->setCaption(QString::fromStdString(session_->cameras[*companion_].name) + tr("    ") +
                              captionOf(*frame));
  companion_view_->setOverlay(
      [reprojection = reprojectionInto(*companion_, frame->time_s)](QPainter& painter, double scale) {
        LayerSet layers;
        layers.set(static_cast<std::size_t>(Layer::Reprojection));
        paintLayers(painter, scale, layers, nullptr, reprojection);
      });
}

}  // namespace evical::ui
