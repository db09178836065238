// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/timeline.h"
#include "ui/theme/theme.h"

#include <QPainter>
#include <QPainterPath>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace evical::ui {
namespace {

constexpr double kHeader_px = 25.0, kFooter_px = 18.0, kTicks_px = 14.0, kSide_px = 62.0;
constexpr double kFoundMarkHeight = 0.7;  // of the row
constexpr double kMinMissed_px = 4.0;     // narrower marks are easily overlooked

QString rateText(double events_s) {
  if (events_s >= 1e6) return QStringLiteral("%1 Mev/s").arg(1e-6 * events_s, 0, 'g', 3);
  return QStringLiteral("%1 kev/s").arg(1e-3 * events_s, 0, 'g', 3);
}

QString turnText(double deg_s) {
  return QStringLiteral("%1 °/s").arg(deg_s, 0, 'f', deg_s < 10.0 ? 1 : 0);
}

// Distance of time labels: 1, 2 or 5 times a power of ten, about 90 px apart.
double labelStep_s(double visible_s, double width_px) {
  const double wanted_s = std::max(1e-6, 90.0 * visible_s / std::max(width_px, 1.0));
  const double power = std::pow(10.0, std::floor(std::log10(wanted_s)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= wanted_s) return factor * power;
  }
  return 10.0 * power;
}

QColor faded(QColor colour, float alpha) {
  colour.setAlphaF(alpha);
  return colour;
}

QColor eventColour() {
  return theme().faint_text;
}
QColor rotationColour() {
  return theme().accent;
}

}  // namespace

QColor windowColour(WindowClass window_class) {
  switch (window_class) {
    case WindowClass::Complete:
      return theme().good;
    case WindowClass::Partial:
      return theme().warning;
    case WindowClass::Rejected:
      return theme().text;
    case WindowClass::Missed:
      break;
  }
  return theme().bad;
}

QBrush windowBrush(WindowClass window_class) {
  return {windowColour(window_class),
          window_class == WindowClass::Partial ? Qt::Dense4Pattern : Qt::SolidPattern};
}

QRectF Timeline::curveArea() const {
  return {kSide_px, kHeader_px, std::max(1.0, width() - 2.0 * kSide_px),
          std::max(1.0, height() - kHeader_px - kFooter_px - kTicks_px - 3.0)};
}

QRectF Timeline::tickArea() const {
  const QRectF curves = curveArea();
  return {curves.left(), curves.bottom() + 3.0, curves.width(), kTicks_px};
}

void Timeline::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), theme().window);
  painter.fillRect(curveArea(), theme().panel);
  painter.fillRect(tickArea(), theme().panel);
  if (!(end_s_ > begin_s_)) {
    painter.setPen(theme().faint_text);
    painter.drawText(curveArea(), Qt::AlignCenter, tr("No recording"));
    return;
  }
  paintAxis(painter);
  painter.save();
  painter.setClipRect(QRectF(curveArea().topLeft(), tickArea().bottomRight()));
  paintCurves(painter);
  paintTicks(painter);
  paintUnused(painter);
  painter.restore();
  paintHeader(painter);
  paintCursor(painter);
  if (hasFocus()) {
    painter.setPen(QPen(faded(theme().accent, 0.6f), 1));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(QRectF(curveArea().topLeft(), tickArea().bottomRight()).adjusted(-1, -1, 0, 0));
  }
}

// Left: values of the curves at the cursor. Right: number of windows of each kind.
void Timeline::paintHeader(QPainter& painter) const {
  const QFontMetrics metrics = painter.fontMetrics();
  double x = curveArea().left();
  const auto word = [&](const QBrush& brush, const QString& text) {
    painter.fillRect(QRectF(x, 7.0, 10.0, 8.0), brush);
    painter.setPen(theme().text);
    painter.drawText(QPointF(x + 15.0, kHeader_px - 10.0), text);
    x += 15.0 + metrics.horizontalAdvance(text) + 18.0;
  };
  const auto valueAt = [&](const RateCurve& curve) {
    const std::size_t bin = curve.binAt(time_s_);
    return bin < curve.values.size() ? static_cast<double>(curve.values[bin]) : NAN;
  };
  const double events_s = valueAt(event_rate_), deg_s = valueAt(rotation_rate_);
  if (!event_rate_.values.empty())
    word(eventColour(), std::isfinite(events_s) ? tr("events %1").arg(rateText(events_s)) : tr("events"));
  if (!rotation_rate_.values.empty())
    word(rotationColour(), std::isfinite(deg_s) ? tr("rotation %1").arg(turnText(deg_s)) : tr("rotation"));
  if (windows_.empty()) return;
  ColumnCounts counts{};
  for (const WindowReport& window : windows_) ++counts[static_cast<std::size_t>(windowClass(window.outcome))];
  std::array<QString, kWindowClassCount> words = {
      tr("complete %1").arg(counts[0]), tr("partial %1").arg(counts[1]), tr("rejected %1").arg(counts[2]),
      tr("missed %1").arg(counts[3])};
  if (counts[static_cast<std::size_t>(WindowClass::Rejected)] == 0)
    words[static_cast<std::size_t>(WindowClass::Rejected)].clear();
  double needed = -18.0;
  for (const QString& text : words)
    if (!text.isEmpty()) needed += 33.0 + metrics.horizontalAdvance(text);
  x = std::max(x, curveArea().right() - needed);
  for (std::size_t k = 0; k < words.size(); ++k)
    if (!words[k].isEmpty()) word(windowBrush(static_cast<WindowClass>(k)), words[k]);
}

void Timeline::paintAxis(QPainter& painter) const {
  const QRectF curves = curveArea(), ticks = tickArea();
  const double step_s = labelStep_s(visible_end_s_ - visible_begin_s_, curves.width());
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step_s) - 1e-9)));
  for (double at_s = std::ceil(visible_begin_s_ / step_s) * step_s; at_s <= visible_end_s_ + 1e-9;
       at_s += step_s) {
    const double x = xOf(at_s);
    painter.setPen(theme().grid_line);
    painter.drawLine(QPointF(x, curves.top()), QPointF(x, ticks.bottom()));
    painter.setPen(theme().faint_text);
    painter.drawText(QRectF(x - 40.0, ticks.bottom(), 80.0, kFooter_px), Qt::AlignCenter,
                     tr("%1 s").arg(at_s, 0, 'f', decimals));
  }
  painter.setPen(eventColour());
  if (!event_rate_.values.empty())
    painter.drawText(QRectF(0.0, curves.top() - 2.0, kSide_px - 5.0, 16.0), Qt::AlignRight | Qt::AlignVCenter,
                     rateText(event_top_));
  painter.setPen(rotationColour());
  if (!rotation_rate_.values.empty())
    painter.drawText(QRectF(curves.right() + 5.0, curves.top() - 2.0, kSide_px - 5.0, 16.0),
                     Qt::AlignLeft | Qt::AlignVCenter, turnText(rotation_top_));
  painter.setPen(theme().faint_text);
  painter.drawText(QRectF(0.0, ticks.top(), kSide_px - 5.0, ticks.height()),
                   Qt::AlignRight | Qt::AlignVCenter, tr("windows"));
}

// Maximum of the bins in each pixel column, so that peaks remain visible at any zoom.
void Timeline::paintCurve(QPainter& painter, const RateCurve& curve, double top, const QColor& colour,
                          bool filled) const {
  const QRectF area = curveArea();
  QPolygonF line;
  const auto heightOf = [&](float value) {
    return area.bottom() - 1.0 -
           (area.height() - 3.0) * std::clamp(static_cast<double>(value) / top, 0.0, 1.0);
  };
  const auto last = static_cast<double>(curve.values.size());
  const auto binOf = [&](double time_s) {
    return std::clamp(std::floor((time_s - curve.begin_s) / curve.step_s), 0.0, last);
  };
  std::size_t done = static_cast<std::size_t>(binOf(visible_begin_s_));
  const double first_x = std::max(area.left(), xOf(curve.begin_s));
  for (double x = first_x; x <= std::min(area.right(), xOf(curve.end_s())); x += 1.0) {
    const auto end = std::min(curve.values.size(), static_cast<std::size_t>(binOf(timeOf(x + 1.0))) + 1);
    float most = NAN;
    for (std::size_t bin = std::min(done, end - (end > 0)); bin < end; ++bin) {
      const float value = curve.values[bin];
      if (std::isfinite(value) && !(most >= value)) most = value;
    }
    done = end > 0 ? end - 1 : 0;
    if (std::isfinite(most)) line << QPointF(x, heightOf(most));
  }
  if (line.size() < 2) return;
  painter.setRenderHint(QPainter::Antialiasing);
  if (filled) {
    QPolygonF shape = line;
    shape << QPointF(line.last().x(), area.bottom()) << QPointF(line.first().x(), area.bottom());
    painter.setPen(Qt::NoPen);
    painter.setBrush(faded(colour, 0.25f));
    painter.drawPolygon(shape);
  }
  painter.setPen(QPen(colour, 1.2));
  painter.drawPolyline(line);
  painter.setRenderHint(QPainter::Antialiasing, false);
}

void Timeline::paintCurves(QPainter& painter) {
  const qreal ratio = devicePixelRatioF();
  const bool drawn = !curves_.picture.isNull() && curves_.size == size() && curves_.dark == theme().dark &&
                     curves_.picture.devicePixelRatio() == ratio && curves_.begin_s == visible_begin_s_ &&
                     curves_.end_s == visible_end_s_;
  if (!drawn) {
    curves_ = {QPixmap(size() * ratio), size(), visible_begin_s_, visible_end_s_, theme().dark};
    curves_.picture.setDevicePixelRatio(ratio);
    curves_.picture.fill(Qt::transparent);
    QPainter on_picture(&curves_.picture);
    paintCurve(on_picture, event_rate_, event_top_, eventColour(), true);
    paintCurve(on_picture, rotation_rate_, rotation_top_, rotationColour(), false);
  }
  painter.drawPixmap(0, 0, curves_.picture);
}

std::vector<Timeline::ColumnCounts> Timeline::countColumns() const {
  const QRectF area = tickArea();
  std::vector<ColumnCounts> columns(static_cast<std::size_t>(area.width()) + 1, ColumnCounts{});
  for (auto window = firstEndingAfter(visible_begin_s_); window != windows_.end(); ++window) {
    if (window->time_s - window->half_width_s > visible_end_s_) break;
    double from = xOf(window->time_s - window->half_width_s) - area.left();
    double to = xOf(endOfWindow(*window)) - area.left();
    if (const double lacking = kMinMissed_px - (to - from);
        lacking > 0.0 && windowClass(window->outcome) == WindowClass::Missed) {
      from -= 0.5 * lacking;
      to += 0.5 * lacking;
    }
    // Wide windows are separated by one pixel.
    const double gap = to - from > 4.0 ? 1.0 : 0.0;
    const auto begin = static_cast<std::size_t>(std::max(0.0, std::round(from)));
    const auto end =
        static_cast<std::size_t>(std::max(std::round(to) - gap, std::round(std::max(0.0, from)) + 1.0));
    for (std::size_t column = begin; column < std::min(end, columns.size()); ++column)
      ++columns[column][static_cast<std::size_t>(windowClass(window->outcome))];
  }
  return columns;
}

// A column with several windows is divided among them, with missed ones on top. Those are taller, to be
// visible without colour vision.
void Timeline::paintTicks(QPainter& painter) const {
  const QRectF area = tickArea();
  const std::vector<ColumnCounts> columns = countColumns();
  for (std::size_t column = 0; column < columns.size(); ++column) {
    const int sum = std::accumulate(columns[column].begin(), columns[column].end(), 0);
    if (sum == 0) continue;
    double bottom = area.bottom();
    const bool missed = columns[column][static_cast<std::size_t>(WindowClass::Missed)] > 0;
    const double whole = area.height() * (missed ? 1.0 : kFoundMarkHeight);
    for (std::size_t k = 0; k < kWindowClassCount; ++k) {
      const double height = whole * columns[column][k] / sum;
      painter.fillRect(QRectF(area.left() + static_cast<double>(column), bottom - height, 1.0, height),
                       windowBrush(static_cast<WindowClass>(k)));
      bottom -= height;
    }
  }
}

// Parts outside the session's time range are faded, and the range has brackets.
void Timeline::paintUnused(QPainter& painter) const {
  if (!used_s_) return;
  const QRectF area(curveArea().topLeft(), tickArea().bottomRight());
  const double from = std::clamp(xOf((*used_s_)[0]), area.left(), area.right());
  const double to = std::clamp(xOf((*used_s_)[1]), area.left(), area.right());
  const QColor veil = faded(theme().window, 0.75f);
  painter.fillRect(QRectF(area.topLeft(), QPointF(from, area.bottom())), veil);
  painter.fillRect(QRectF(QPointF(to, area.top()), area.bottomRight()), veil);
  painter.setPen(QPen(theme().accent, 2.0));
  constexpr double kHook_px = 5.0;
  for (const auto& [x, inwards] : {std::pair{from, 1.0}, std::pair{to, -1.0}}) {
    if (x <= area.left() || x >= area.right()) continue;
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
    painter.drawLine(QPointF(x, area.top() + 1.0), QPointF(x + inwards * kHook_px, area.top() + 1.0));
    painter.drawLine(QPointF(x, area.bottom() - 1.0), QPointF(x + inwards * kHook_px, area.bottom() - 1.0));
  }
}

void Timeline::paintCursor(QPainter& painter) const {
  const double x = xOf(time_s_);
  if (x < curveArea().left() - 1.0 || x > curveArea().right() + 1.0) return;
  if (const auto window = windowAt(time_s_)) {
    const double from = xOf(window->time_s - window->half_width_s);
    painter.fillRect(QRectF(from, curveArea().top(), xOf(endOfWindow(*window)) - from, curveArea().height()),
                     faded(theme().accent, 0.18f));
  }
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(theme().text, 1.5));
  painter.drawLine(QPointF(x, curveArea().top() - 2.0), QPointF(x, tickArea().bottom()));
  QPainterPath handle;
  handle.addPolygon(
      QPolygonF({QPointF(x - 5.0, curveArea().top() - 6.0), QPointF(x + 5.0, curveArea().top() - 6.0),
                 QPointF(x, curveArea().top() + 1.0)}));
  painter.fillPath(handle, theme().text);
}

}  // namespace evical::ui
