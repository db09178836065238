// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/timeline.h"

#include "core/numerics/angles.h"

#include <QHelpEvent>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QToolTip>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical::ui {
namespace {

constexpr double kTimeZoomStep = 1.3;
constexpr double kShortestVisible_s = 0.05;
constexpr double kBlindStep_s = 0.01;

// Rounded up to a round number.
double niceAbove(double value) {
  if (!(value > 0.0)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double factor : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0}) {
    if (factor * power >= value) return factor * power;
  }
  return 10.0 * power;
}

double topOf(const RateCurve& curve) {
  float most = 0.0f;
  for (const float value : curve.values) {
    if (std::isfinite(value)) most = std::max(most, value);
  }
  return niceAbove(static_cast<double>(most));
}

}  // namespace

double endOfWindow(const WindowReport& window) {
  return window.time_s + window.half_width_s;
}

WindowClass windowClass(WindowOutcome outcome) {
  if (outcome == WindowOutcome::Complete) return WindowClass::Complete;
  if (outcome == WindowOutcome::RejectedByHand) return WindowClass::Rejected;
  return outcome == WindowOutcome::Partial ? WindowClass::Partial : WindowClass::Missed;
}

Timeline::Timeline(QWidget* parent) : QWidget(parent) {
  setFocusPolicy(Qt::StrongFocus);
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  setAccessibleName(tr("Timeline"));
}

void Timeline::setRange(double begin_s, double end_s) {
  const bool all = visible_begin_s_ <= begin_s_ && visible_end_s_ >= end_s_;
  begin_s_ = begin_s;
  end_s_ = std::max(begin_s, end_s);
  if (all) showAll();
  scrollBy(0.0);
}

void Timeline::setUsedRange(const std::optional<std::array<double, 2>>& range_s) {
  if (range_s == used_s_) return;
  used_s_ = range_s;
  update();
}

void Timeline::setWindows(std::vector<WindowReport> windows) {
  windows_ = std::move(windows);
  std::sort(windows_.begin(), windows_.end(),
            [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  update();
}

void Timeline::setEventRate(RateCurve events_s) {
  event_rate_ = std::move(events_s);
  curves_ = {};
  event_top_ = topOf(event_rate_);
  update();
}

void Timeline::setRotationRate(RateCurve rad_s) {
  rotation_rate_ = std::move(rad_s);
  curves_ = {};
  for (float& rate : rotation_rate_.values) rate *= static_cast<float>(kDegPerRad);
  rotation_top_ = topOf(rotation_rate_);
  update();
}

std::vector<WindowReport>::const_iterator Timeline::firstEndingAfter(double time_s) const {
  return std::lower_bound(windows_.begin(), windows_.end(), time_s,
                          [](const WindowReport& window, double time) { return endOfWindow(window) < time; });
}

std::optional<WindowReport> Timeline::windowAt(double time_s) const {
  const auto found = firstEndingAfter(time_s);
  if (found == windows_.end() || found->time_s - found->half_width_s > time_s) return std::nullopt;
  return *found;
}

double Timeline::stepFrom(double time_s, int direction) const {
  constexpr double kSame_s = 1e-6;
  if (windows_.empty()) return std::clamp(time_s + direction * kBlindStep_s, begin_s_, end_s_);
  const auto before = [](const WindowReport& window, double time) { return window.time_s < time; };
  if (direction > 0) {
    const auto next = std::lower_bound(windows_.begin(), windows_.end(), time_s + kSame_s, before);
    return next == windows_.end() ? time_s : next->time_s;
  }
  const auto next = std::lower_bound(windows_.begin(), windows_.end(), time_s - kSame_s, before);
  return next == windows_.begin() ? time_s : std::prev(next)->time_s;
}

std::optional<double> Timeline::missedFrom(double time_s, int direction) const {
  constexpr double kSame_s = 1e-6;
  const auto missed = [&](const WindowReport& window) {
    return windowClass(window.outcome) == WindowClass::Missed &&
           direction * (window.time_s - time_s) > kSame_s;
  };
  if (direction > 0) {
    const auto next = std::find_if(windows_.begin(), windows_.end(), missed);
    return next == windows_.end() ? std::nullopt : std::optional(next->time_s);
  }
  const auto before = std::find_if(windows_.rbegin(), windows_.rend(), missed);
  return before == windows_.rend() ? std::nullopt : std::optional(before->time_s);
}

void Timeline::setTime(double time_s) {
  time_s_ = time_s;
  if (time_s < visible_begin_s_ || time_s > visible_end_s_) {
    scrollBy(time_s - visible_begin_s_ - 0.1 * (visible_end_s_ - visible_begin_s_));
  }
  update();
}

void Timeline::select(double time_s) {
  setTime(std::clamp(time_s, begin_s_, end_s_));
  emit timeSelected(time_s_);
}

void Timeline::showAll() {
  visible_begin_s_ = begin_s_;
  visible_end_s_ = end_s_;
  update();
}

void Timeline::zoomBy(double factor, double about_s) {
  const double length_s = visible_end_s_ - visible_begin_s_;
  const double wanted_s = std::max(length_s / factor, std::min(kShortestVisible_s, end_s_ - begin_s_));
  if (!(length_s > 0.0) || wanted_s >= end_s_ - begin_s_) {
    showAll();
    return;
  }
  visible_begin_s_ = about_s - (about_s - visible_begin_s_) * wanted_s / length_s;
  visible_end_s_ = visible_begin_s_ + wanted_s;
  scrollBy(0.0);
}

void Timeline::scrollBy(double shift_s) {
  const double length_s = visible_end_s_ - visible_begin_s_;
  visible_begin_s_ = std::clamp(visible_begin_s_ + shift_s, begin_s_, std::max(begin_s_, end_s_ - length_s));
  visible_end_s_ = std::min(visible_begin_s_ + length_s, end_s_);
  update();
}

double Timeline::xOf(double time_s) const {
  const QRectF area = curveArea();
  const double length_s = std::max(visible_end_s_ - visible_begin_s_, 1e-9);
  return area.left() + area.width() * (time_s - visible_begin_s_) / length_s;
}

double Timeline::timeOf(double x) const {
  const QRectF area = curveArea();
  return visible_begin_s_ + (x - area.left()) / area.width() * (visible_end_s_ - visible_begin_s_);
}

bool Timeline::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* help = static_cast<QHelpEvent*>(event);
  const double at_s = timeOf(help->pos().x());
  if (at_s < visible_begin_s_ || at_s > visible_end_s_) {
    QToolTip::hideText();
    return true;
  }
  QString text = tr("%1 s").arg(at_s, 0, 'f', 3);
  if (const auto window = windowAt(at_s)) {
    text +=
        tr("\n%1: %2 of +-%3 ms, %4 points")
            .arg(windowOutcomeName(window->outcome), window->tracked ? tr("tracked window") : tr("window"))
            .arg(1e3 * window->half_width_s, 0, 'f', 1)
            .arg(window->circles);
  }
  QToolTip::showText(help->globalPos(), text, this);
  return true;
}

void Timeline::wheelEvent(QWheelEvent* event) {
  const QPoint turn = event->angleDelta();
  const double length_s = visible_end_s_ - visible_begin_s_;
  if (event->modifiers() & Qt::ShiftModifier || turn.y() == 0) {
    const int steps = turn.y() != 0 ? turn.y() : turn.x();
    scrollBy(-0.1 * length_s * steps / 120.0);
  } else {
    zoomBy(std::pow(kTimeZoomStep, turn.y() / 120.0), timeOf(event->position().x()));
  }
  event->accept();
}

void Timeline::mousePressEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton) {
    scrubbing_ = true;
    select(timeOf(event->position().x()));
  } else {
    pan_from_x_ = event->position().x();
  }
}

void Timeline::mouseMoveEvent(QMouseEvent* event) {
  if (scrubbing_) select(timeOf(event->position().x()));
  if (!pan_from_x_) return;
  scrollBy(timeOf(*pan_from_x_) - timeOf(event->position().x()));
  pan_from_x_ = event->position().x();
}

void Timeline::mouseReleaseEvent(QMouseEvent*) {
  scrubbing_ = false;
  pan_from_x_.reset();
}

void Timeline::mouseDoubleClickEvent(QMouseEvent*) {
  showAll();
}

void Timeline::keyPressEvent(QKeyEvent* event) {
  switch (event->key()) {
    case Qt::Key_Left:
      select(stepFrom(time_s_, -1));
      return;
    case Qt::Key_Right:
      select(stepFrom(time_s_, +1));
      return;
    case Qt::Key_Home:
      select(begin_s_);
      return;
    case Qt::Key_End:
      select(end_s_);
      return;
    case Qt::Key_Plus:
    case Qt::Key_Equal:
      zoomBy(kTimeZoomStep, time_s_);
      return;
    case Qt::Key_Minus:
      zoomBy(1.0 / kTimeZoomStep, time_s_);
      return;
    default:
      QWidget::keyPressEvent(event);
  }
}

}  // namespace evical::ui
