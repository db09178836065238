// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/job_status.h"

#include "ui/theme/plain_labels.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QProgressBar>

#include <cmath>

namespace evical::ui {

QString durationText(double duration_s) {
  const auto seconds = static_cast<int>(std::ceil(duration_s));
  if (seconds < 60) return QObject::tr("%1 s").arg(seconds);
  return QObject::tr("%1 min %2 s").arg(seconds / 60).arg(seconds % 60);
}

JobStatus::JobStatus(const JobRunner& runner, QWidget* parent)
    : QWidget(parent),
      runner_(runner),
      what_(new QLabel(this)),
      bar_(new QProgressBar(this)),
      time_left_(new QLabel(this)) {
  constexpr int kBar_px = 220;
  bar_->setRange(0, 1000);
  bar_->setTextVisible(false);
  bar_->setFixedWidth(kBar_px);
  bar_->hide();
  auto* const layout = new QHBoxLayout(this);
  layout->setContentsMargins(8, 2, 8, 2);
  layout->setSpacing(10);
  layout->addWidget(what_);
  layout->addWidget(bar_);
  layout->addWidget(time_left_);
  layout->addStretch();
  // Fixed size: the text changes many times a second, which must not trigger layouts of the window.
  keepSize(*time_left_, tr("%1 %, about %2 left").arg("888").arg(durationText(3599.0)));
  reset();
  connect(&runner_, &JobRunner::started, this, &JobStatus::begin);
  connect(&runner_, &JobRunner::progressed, this, &JobStatus::setProgress);
  connect(&runner_, &JobRunner::finished, this, &JobStatus::end);
}

void JobStatus::reset() {
  if (!runner_.running()) what_->setText(tr("Ready"));
}

void JobStatus::setReading(const QString& recording) {
  if (recording.isEmpty()) return reset();
  if (!runner_.running()) what_->setText(tr("Reading %1...").arg(recording));
}

void JobStatus::begin(const QString& title) {
  what_->setText(title);
  bar_->setValue(0);
  bar_->show();
  time_left_->clear();
}

void JobStatus::setProgress(const JobProgress& progress) {
  bar_->setValue(static_cast<int>(1000.0 * progress.fraction));
  if (runner_.cancelling()) {
    what_->setText(tr("Cancelling..."));
    time_left_->clear();
    return;
  }
  QStringList what = {runner_.title(), progress.part, progress.stage};
  what.removeAll(QString());
  what_->setText(what.join(": "));
  time_left_->setText(progress.remaining_s < 0.0 ? tr("%1 %").arg(100.0 * progress.fraction, 0, 'f', 0)
                                                 : tr("%1 %, about %2 left")
                                                       .arg(100.0 * progress.fraction, 0, 'f', 0)
                                                       .arg(durationText(progress.remaining_s)));
}

// Without a duration: that of a result includes the detections that it uses, and is on its page.
void JobStatus::end(JobOutcome outcome) {
  const QString title = runner_.title();
  what_->setText(outcome == JobOutcome::Done        ? tr("%1: done").arg(title)
                 : outcome == JobOutcome::Cancelled ? tr("%1: cancelled").arg(title)
                                                    : tr("%1: failed").arg(title));
  bar_->hide();
  time_left_->clear();
}

QString JobStatus::text() const {
  return what_->text() + (time_left_->text().isEmpty() ? "" : ", " + time_left_->text());
}

}  // namespace evical::ui
