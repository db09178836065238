// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/colour_scale.h"

#include "ui/scene/trajectory_track.h"
#include "ui/theme/theme.h"

#include <QPainter>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical::ui {
namespace {

// Lightness is monotonic, away from the background's.
constexpr std::array<std::array<double, 3>, 5> kOnDark = {
    {{0.33, 0.36, 0.85}, {0.16, 0.60, 0.80}, {0.20, 0.76, 0.55}, {0.72, 0.85, 0.25}, {1.00, 0.93, 0.35}}};
constexpr std::array<std::array<double, 3>, 5> kOnLight = {
    {{0.98, 0.66, 0.18}, {0.93, 0.40, 0.29}, {0.78, 0.18, 0.46}, {0.47, 0.08, 0.60}, {0.13, 0.06, 0.45}}};

constexpr double kOutliers = 0.02;
constexpr double kMostTicks = 6.0;

}  // namespace

QColor ColourScale::colourOf(double value) const {
  if (!std::isfinite(value)) return dark ? QColor(0x55, 0x5b, 0x64) : QColor(0xb4, 0xb9, 0xc0);
  const auto& stops = dark ? kOnDark : kOnLight;
  const double place = std::clamp(value / high, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), stops.size() - 2);
  const double share = place - static_cast<double>(below);
  const auto mixed = [&](std::size_t channel) {
    return static_cast<float>((1.0 - share) * stops[below][channel] + share * stops[below + 1][channel]);
  };
  return QColor::fromRgbF(mixed(0), mixed(1), mixed(2));
}

double scaleEnd(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return 1.0;
  const auto index = static_cast<std::ptrdiff_t>((1.0 - kOutliers) * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  const double value = values[static_cast<std::size_t>(index)], step = roundedUp(value / kMostTicks);
  return step * std::max(1.0, std::ceil(value / step - 1e-9));
}

void paintColourBar(QPainter& painter, const QRectF& area, const ColourScale& scale) {
  const QFontMetricsF metrics(painter.font());
  const double line = metrics.height();
  const QRectF bar(area.left(), area.top() + 1.6 * line, 12.0, area.height() - 2.1 * line);
  painter.setPen(theme().text);
  painter.drawText(QRectF(area.left(), area.top(), area.width(), line), Qt::AlignLeft | Qt::AlignVCenter,
                   scale.title);
  QLinearGradient gradient(bar.bottomLeft(), bar.topLeft());
  constexpr int kStops = 16;
  for (int k = 0; k <= kStops; ++k) {
    const double share = static_cast<double>(k) / kStops;
    gradient.setColorAt(share, scale.colourOf(share * scale.high));
  }
  painter.setPen(Qt::NoPen);
  painter.setBrush(gradient);
  painter.drawRoundedRect(bar, 3.0, 3.0);
  painter.setPen(theme().faint_text);
  const double step = roundedUp(scale.high / kMostTicks);
  for (int k = 0; k * step <= scale.high * (1.0 + 1e-9); ++k) {
    const double share = k * step / scale.high;
    const QPointF at(bar.right(), bar.bottom() - share * bar.height());
    painter.drawLine(at, at + QPointF(4.0, 0.0));
    painter.drawText(QRectF(at.x() + 8.0, at.y() - 0.5 * line, area.width() - 20.0, line),
                     Qt::AlignLeft | Qt::AlignVCenter, QString::number(k * step, 'g', 3));
  }
}

}  // namespace evical::ui
