// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/observability_view.h"

#include "ui/theme/theme.h"

#include <QPainter>

#include <algorithm>
#include <cmath>

namespace evical::ui {

ObservabilityView::ObservabilityView(QWidget* parent) : QWidget(parent) {}

void ObservabilityView::setObservability(const std::vector<double>& information, const QString& weakest) {
  needed_over_sigma_.clear();
  for (const double value : information) needed_over_sigma_.push_back(std::sqrt(std::max(0.0, value)));
  weakest_ = weakest;
  calibrated_ = true;
  setAccessibleName(text());
  update();
}

QString ObservabilityView::text() const {
  if (!calibrated_) return tr("No calibration yet.");
  if (needed_over_sigma_.empty())
    return tr("Rotations, translations and time offsets were all given: none had to be observed.");
  const double least = needed_over_sigma_.front();
  const auto unmet = std::count_if(needed_over_sigma_.begin(), needed_over_sigma_.end(),
                                   [](double ratio) { return ratio < 1.0; });
  const QString first = tr("The least certain direction is %1: it is known %2 times as well as needed.")
                            .arg(weakest_)
                            .arg(least, 0, 'g', 2);
  if (unmet == 0) return first + " " + tr("All directions are known well enough.");
  return first + " " +
         tr("%1 of %2 directions are not known well enough.").arg(unmet).arg(needed_over_sigma_.size());
}

void ObservabilityView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  if (needed_over_sigma_.empty()) {
    if (calibrated_) return;  // the words above it say why
    painter.setPen(theme().faint_text);
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap, text());
    return;
  }
  // Logarithmic: a factor of ten is as wide everywhere.
  constexpr double kLeast = 0.03, kLabel_px = 58.0, kGap_px = 6.0, kAxis_px = 56.0, kMostBar_px = 26.0;
  const double most = std::max(30.0, 2.0 * needed_over_sigma_.back());
  const double room_px = width() - kLabel_px - 12.0;
  const auto place = [&](double ratio) {
    return room_px * std::log(std::clamp(ratio, kLeast, most) / kLeast) / std::log(most / kLeast);
  };
  const double bar_px =
      std::min(kMostBar_px, (height() - kAxis_px) / static_cast<double>(needed_over_sigma_.size()));
  for (std::size_t i = 0; i < needed_over_sigma_.size(); ++i) {
    const double ratio = needed_over_sigma_[i];
    const double top = static_cast<double>(i) * bar_px;
    const QRectF bar(0.0, top + 2.0, place(ratio), bar_px - 4.0);
    painter.fillRect(bar, ratio < 1.0 ? theme().bad : theme().good);
    painter.setPen(theme().text);
    const QString label = tr("%1 x").arg(ratio, 0, 'g', 3);
    double left = bar.right() + kGap_px;
    const double line = place(1.0);  // no label under it
    if (left < line + kGap_px && left + painter.fontMetrics().horizontalAdvance(label) > line - kGap_px)
      left = line + kGap_px;
    painter.drawText(QRectF(left, top, kLabel_px, bar_px), Qt::AlignVCenter | Qt::TextDontClip, label);
  }
  const double bottom = bar_px * static_cast<double>(needed_over_sigma_.size());
  painter.setPen(QPen(theme().text, 1.5, Qt::DashLine));
  painter.drawLine(QPointF(place(1.0), 0.0), QPointF(place(1.0), bottom + 4.0));
  painter.setPen(theme().faint_text);
  painter.drawText(
      QRectF(0.0, bottom + 6.0, width(), kAxis_px), Qt::AlignLeft | Qt::AlignTop | Qt::TextWordWrap,
      tr("A bar for each direction, a mixture of rotation, translation and time offset; the weakest "
         "is the first. Dashed: as well as needed."));
}

}  // namespace evical::ui
