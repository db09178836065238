// SPDX-License-Identifier: GPL-3.0-or-later
// List of windows next to the picture.
#include "ui/detection/detection_engine.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/timeline.h"
#include "ui/detection/window_list.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QResizeEvent>
#include <QSignalBlocker>
#include <QToolButton>

#include <algorithm>
#include <iterator>
#include <utility>

namespace evical::ui {
namespace {

constexpr int kRoomForBoth_px = 1350;                // for the list, the layers and a picture between them
constexpr int kSideWidth_px = 272;                   // of layers and verdict
constexpr double kListShare = 0.455;                 // of the page
constexpr int kListMin_px = 330, kListMax_px = 360;  // leaves a picture of 1000 px at a width of 1920

int countOnlyIn(const std::vector<double>& these, const std::vector<double>& others) {
  std::vector<double> only;
  std::set_difference(these.begin(), these.end(), others.begin(), others.end(), std::back_inserter(only));
  return static_cast<int>(only.size());
}

}  // namespace

void DetectionScreen::makeWindowList() {
  list_ = new WindowList;
  connect(list_, &WindowList::windowChosen, this, [this](double time_s) {
    setPlaying(false);
    following_ = false;
    follow_button_->setChecked(false);
    select(time_s);
  });
  connect(list_, &WindowList::rejectionWanted, this,
          [this](const std::vector<double>& times_s, const QString& what) {
            if (!rejections_ || camera_ >= rejections_->size()) return;
            RejectedTimes wanted = *rejections_;
            wanted[camera_] = times_s;
            emit rejectionsWanted(wanted, what);
          });
}

void DetectionScreen::addListButton(QHBoxLayout* row) {
  list_button_ = addButton(row, "report", tr("List of event windows (W)"));
  list_button_->setText(tr("Windows"));
  list_button_->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  list_button_->setCheckable(true);
  connect(list_button_, &QToolButton::clicked, this, &DetectionScreen::setWindowsListed);
}

void DetectionScreen::addMissedButtons(QHBoxLayout* row) {
  row->addWidget(new QLabel(tr("Missed")));
  connect(addButton(row, "missed-before", tr("Previous missed event window (Shift+M)")),
          &QToolButton::clicked, this, [this] { stepToMissed(-1); });
  connect(addButton(row, "missed-next", tr("Next missed event window (M)")), &QToolButton::clicked, this,
          [this] { stepToMissed(+1); });
}

void DetectionScreen::setWindowsListed(bool listed) {
  list_wanted_ = listed;
  layOutSides();
}

void DetectionScreen::layOutSides() {
  const bool room = width() >= kRoomForBoth_px;
  const bool listed = list_wanted_.value_or(room);
  const int list_px = std::clamp(static_cast<int>(kListShare * width()), kListMin_px, kListMax_px);
  list_->setFixedWidth(list_px);
  list_->setVisible(listed);
  // In a narrow window the list takes the place of the layers, above the verdict.
  sides_->setDirection(room ? QBoxLayout::LeftToRight : QBoxLayout::TopToBottom);
  side_->setFixedWidth(listed && !room ? list_px : kSideWidth_px);
  layers_part_->setVisible(room || !listed);
  const QSignalBlocker quiet(list_button_);
  list_button_->setChecked(listed);
}

void DetectionScreen::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  layOutSides();
}

void DetectionScreen::listWindows() {
  const CalibrationRun* const run = live_ ? nullptr : runInView();
  list_->setRun(run != nullptr ? run_ : nullptr, camera_,
                live_ ? tr("The event windows will be listed when the detection is complete.")
                      : tr("Calibrate (F5) to list the event windows, each with its picture, outcome "
                           "and fit."));
  showRejections();
  showPictures();
}

void DetectionScreen::showPictures() {
  if (engine_) list_->setSource(engine_->pictureSource(), style());
}

void DetectionScreen::setRejections(const std::optional<RejectedTimes>& rejections) {
  rejections_ = rejections;
  showRejections();
}

void DetectionScreen::showRejections() {
  const CalibrationRun* const run = runInView();
  const bool possible =
      run != nullptr && rejections_ && rejections_->size() == run->detections.cameras.size();
  list_->setRejectable(possible);
  if (!possible) {
    list_->setRejected({});
    return list_->setPending(0, 0);
  }
  list_->setRejected(rejections_->at(camera_));
  int to_reject = 0, to_keep = 0;
  for (std::size_t k = 0; k < rejections_->size(); ++k) {
    const std::vector<double> left_out = rejectedTimes_s(run->detections.cameras[k]);
    to_reject += countOnlyIn((*rejections_)[k], left_out);
    to_keep += countOnlyIn(left_out, (*rejections_)[k]);
  }
  list_->setPending(to_reject, to_keep);
}

void DetectionScreen::setBusy(bool busy) {
  list_->setBusy(busy);
}

void DetectionScreen::stepToMissed(int direction) {
  setPlaying(false);
  following_ = false;
  follow_button_->setChecked(false);
  const auto missed_s = timeline_->missedFrom(time_s_, direction);
  if (missed_s) select(*missed_s);
}

}  // namespace evical::ui
