// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/time_bar.h"

#include "ui/theme/theme.h"

#include <QComboBox>
#include <QEvent>
#include <QHBoxLayout>
#include <QLabel>
#include <QMouseEvent>
#include <QSlider>
#include <QStyle>
#include <QStyleOptionSlider>
#include <QToolButton>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical::ui {
namespace {

constexpr int kFrame_ms = 33;
constexpr double kStep_s = 0.02;  // without stops
constexpr double kSame_s = 1e-6;
constexpr double kSteps_1_s = 1e3;  // of the slider
constexpr int kRealSpeed = 3;       // in the list

// A press anywhere moves there immediately, like on Detection's timeline.
class ScrubSlider : public QSlider {
 public:
  explicit ScrubSlider(QWidget* parent) : QSlider(Qt::Horizontal, parent) {}

 protected:
  void mousePressEvent(QMouseEvent* event) override {
    if (event->button() == Qt::LeftButton) {
      QStyleOptionSlider option;
      initStyleOption(&option);
      const QRect handle = style()->subControlRect(QStyle::CC_Slider, &option, QStyle::SC_SliderHandle, this);
      const int span = std::max(1, width() - handle.width());
      const int at = static_cast<int>(std::lround(event->position().x())) - handle.width() / 2;
      if (!handle.contains(event->position().toPoint()))
        setValue(QStyle::sliderValueFromPosition(minimum(), maximum(), at, span));
    }
    QSlider::mousePressEvent(event);  // finds the handle under the mouse, and drags it
  }
};

}  // namespace

TimeBar::TimeBar(QWidget* parent)
    : QWidget(parent), slider_(new ScrubSlider(this)), speed_(new QComboBox(this)), label_(new QLabel(this)) {
  auto* const row = new QHBoxLayout(this);
  row->setContentsMargins(8, 4, 12, 0);
  row->setSpacing(4);
  connect(addButton("time_to_start", "to-start", tr("To the start (Home)")), &QToolButton::clicked, this,
          &TimeBar::toStart);
  connect(addButton("time_step_back", "step-back", tr("Previous board view (Left)")), &QToolButton::clicked,
          this, [this] { step(-1); });
  play_ = addButton("time_play", "play", tr("Play (Space)"));
  connect(play_, &QToolButton::clicked, this, &TimeBar::togglePlaying);
  connect(addButton("time_step_forward", "step-forward", tr("Next board view (Right)")),
          &QToolButton::clicked, this, [this] { step(+1); });
  connect(addButton("time_to_end", "to-end", tr("To the end (End)")), &QToolButton::clicked, this,
          &TimeBar::toEnd);
  addSpeeds();
  row->addWidget(speed_);
  row->addWidget(slider_, 1);
  row->addWidget(label_);
  slider_->setObjectName("time_slider");
  slider_->setAccessibleName(tr("Time"));
  slider_->setToolTip(tr("Drag to change the time; the other pages follow"));
  slider_->setFocusPolicy(Qt::TabFocus);
  label_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  label_->setMinimumWidth(label_->fontMetrics().horizontalAdvance("000.000 / 000.00 s") + 6);
  connect(slider_, &QSlider::valueChanged, this,
          [this](int value) { select(std::min(begin_s_ + value / kSteps_1_s, end_s_)); });
  timer_.setInterval(kFrame_ms);
  connect(&timer_, &QTimer::timeout, this, &TimeBar::advance);
  applyIcons();
  setNoTimes();
}

QToolButton* TimeBar::addButton(const char* name, const QString& icon_name, const QString& help) {
  auto* const button = new QToolButton(this);
  button->setObjectName(name);
  button->setAutoRaise(true);
  button->setToolTip(help);
  button->setAccessibleName(help);
  layout()->addWidget(button);
  icons_.emplace_back(button, icon_name);
  return button;
}

void TimeBar::addSpeeds() {
  constexpr std::array kSpeeds = {0.1, 0.25, 0.5, 1.0, 2.0, 5.0};
  for (const double speed : kSpeeds)
    speed_->addItem(speed < 1.0 ? tr("1/%1 speed").arg(1.0 / speed, 0, 'f', 0) : tr("%1 x speed").arg(speed),
                    speed);
  speed_->setCurrentIndex(kRealSpeed);
  speed_->setObjectName("time_speed");
  speed_->setAccessibleName(tr("Playback speed"));
  speed_->setToolTip(tr("Playback speed, relative to the recording"));
}

void TimeBar::setTimes(double begin_s, double end_s, std::vector<double> stops_s) {
  begin_s_ = begin_s;
  end_s_ = std::max(begin_s, end_s);
  stops_s_ = std::move(stops_s);
  setEnabled(hasTimes());
  if (!hasTimes()) setPlaying(false);
  {
    const QSignalBlocker quiet(slider_);
    slider_->setRange(0, static_cast<int>(std::ceil((end_s_ - begin_s_) * kSteps_1_s)));
    slider_->setPageStep(std::max(1, slider_->maximum() / 20));
  }
  setTime(time_s_);
}

void TimeBar::setNoTimes() {
  setTimes(0.0, 0.0, {});
}

void TimeBar::setTime(double time_s) {
  time_s_ = time_s;
  const QSignalBlocker quiet(slider_);
  slider_->setValue(
      static_cast<int>(std::lround((std::clamp(time_s, begin_s_, end_s_) - begin_s_) * kSteps_1_s)));
  label_->setText(hasTimes() ? tr("%1 / %2 s").arg(time_s, 0, 'f', 3).arg(end_s_, 0, 'f', 2) : QString());
}

void TimeBar::select(double time_s) {
  setTime(std::clamp(time_s, begin_s_, end_s_));
  emit timeSelected(time_s_);
}

void TimeBar::setPlaying(bool playing) {
  if (playing == isPlaying() || (playing && !hasTimes())) return;
  if (playing) {
    if (time_s_ >= end_s_ - kSame_s || time_s_ < begin_s_) select(begin_s_);
    since_frame_.start();
    timer_.start();
  } else {
    timer_.stop();
  }
  play_->setToolTip(playing ? tr("Pause (Space)") : tr("Play (Space)"));
  play_->setAccessibleName(play_->toolTip());
  applyIcons();
  emit playingChanged(playing);
}

void TimeBar::advance() {
  const double passed_s = 1e-9 * static_cast<double>(since_frame_.nsecsElapsed());
  since_frame_.restart();
  select(time_s_ + passed_s * speed_->currentData().toDouble());
  if (time_s_ >= end_s_) setPlaying(false);
}

void TimeBar::step(int direction) {
  if (!hasTimes()) return;
  setPlaying(false);
  if (stops_s_.empty()) return select(time_s_ + direction * kStep_s);
  if (direction > 0) {
    const auto next = std::upper_bound(stops_s_.begin(), stops_s_.end(), time_s_ + kSame_s);
    return select(next == stops_s_.end() ? end_s_ : *next);
  }
  const auto next = std::lower_bound(stops_s_.begin(), stops_s_.end(), time_s_ - kSame_s);
  select(next == stops_s_.begin() ? begin_s_ : *std::prev(next));
}

void TimeBar::toStart() {
  if (hasTimes()) select(begin_s_);
}

void TimeBar::toEnd() {
  if (hasTimes()) select(end_s_);
}

void TimeBar::applyIcons() {
  for (const auto& [button, name] : icons_) button->setIcon(icon(name));
  if (play_ != nullptr && isPlaying()) play_->setIcon(icon("pause"));
}

void TimeBar::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange) applyIcons();
  QWidget::changeEvent(event);
}

}  // namespace evical::ui
