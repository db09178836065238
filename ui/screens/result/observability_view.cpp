// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/result/observability_view.h"

#include "ui/jobs/file_saver.h"
#include "ui/theme/theme.h"

#include <QContextMenuEvent>
#include <QHelpEvent>
#include <QMenu>
#include <QPainter>
#include <QToolTip>

#include <algorithm>
#include <cmath>

namespace evical::ui {

namespace {

constexpr double kMinRatio = 0.03, kRatioScale_px = 96.0;  // the scale and the text below it
constexpr int kMinRow_px = 26, kMaxRow_px = 40;

}  // namespace

ObservabilityView::ObservabilityView(QWidget* parent) : QWidget(parent), saver_(new FileSaver(this)) {}

void ObservabilityView::setObservability(const std::vector<double>& information,
                                         const QStringList& directions) {
  needed_over_sigma_.clear();
  for (const double value : information) needed_over_sigma_.push_back(std::sqrt(std::max(0.0, value)));
  directions_ = directions;
  calibrated_ = true;
  setAccessibleName(text());
  updateGeometry();
  update();
}

QString ObservabilityView::text() const {
  if (!calibrated_) return tr("No calibration yet.");
  if (needed_over_sigma_.empty())
    return tr("All rotations, translations and time offsets were given: none was estimated.");
  const double least = needed_over_sigma_.front();
  const auto unmet = std::count_if(needed_over_sigma_.begin(), needed_over_sigma_.end(),
                                   [](double ratio) { return ratio < 1.0; });
  const QString first = tr("The weakest direction is %1: its accuracy is %2 times the needed one.")
                            .arg(nameOf(0))
                            .arg(least, 0, 'g', 2);
  if (unmet == 0) return first + " " + tr("All directions reach the needed accuracy.");
  return first + " " +
         tr("%1 of %2 directions do not reach the needed accuracy.")
             .arg(unmet)
             .arg(needed_over_sigma_.size());
}

QString ObservabilityView::nameOf(std::size_t bar) const {
  const QString words = directions_.value(static_cast<qsizetype>(bar));
  return words.isEmpty() ? tr("direction %1").arg(bar + 1) : words;
}

QSize ObservabilityView::minimumSizeHint() const {
  constexpr int kMinWidth_px = 260;
  const auto bars = static_cast<int>(needed_over_sigma_.size());
  return {kMinWidth_px, static_cast<int>(kRatioScale_px) + bars * kMinRow_px};
}

// Logarithmic scale.
double ObservabilityView::place_px(double ratio) const {
  const double most = std::max(30.0, 2.0 * needed_over_sigma_.back());
  return width() * std::log(std::clamp(ratio, kMinRatio, most) / kMinRatio) / std::log(most / kMinRatio);
}

void ObservabilityView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  if (needed_over_sigma_.empty()) {
    if (calibrated_) return;  // the text above gives the reason
    painter.setPen(theme().faint_text);
    painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap, text());
    return;
  }
  for (std::size_t i = 0; i < needed_over_sigma_.size(); ++i) paintBar(painter, i);
  paintScale(painter);
}

double ObservabilityView::rowHeight_px() const {
  const auto bars = static_cast<double>(needed_over_sigma_.size());
  return std::min<double>(kMaxRow_px, (height() - kRatioScale_px) / bars);
}

// Name and value above the bar.
void ObservabilityView::paintBar(QPainter& painter, std::size_t bar) const {
  constexpr double kBar_px = 7.0, kGap_px = 10.0;
  const double ratio = needed_over_sigma_[bar], row_px = rowHeight_px();
  const double top = static_cast<double>(bar) * row_px;
  const QRectF line(0.0, top, width(), row_px - kBar_px - 2.0);
  const QString value = tr("%1 x").arg(ratio, 0, 'g', 3);
  const int name_px = static_cast<int>(width() - kGap_px - painter.fontMetrics().horizontalAdvance(value));
  painter.setPen(theme().text);
  painter.drawText(line, Qt::AlignLeft | Qt::AlignBottom | Qt::TextDontClip,
                   painter.fontMetrics().elidedText(nameOf(bar), Qt::ElideRight, name_px));
  painter.drawText(line, Qt::AlignRight | Qt::AlignBottom | Qt::TextDontClip, value);
  painter.fillRect(QRectF(0.0, top + row_px - kBar_px, place_px(ratio), kBar_px),
                   ratio < 1.0 ? theme().bad : theme().good);
  // Mark of the needed accuracy, only at the bars: names stay readable.
  painter.setPen(QPen(theme().text, 1.5));
  painter.drawLine(QPointF(place_px(1.0), top + row_px - kBar_px - 2.0),
                   QPointF(place_px(1.0), top + row_px + 2.0));
}

void ObservabilityView::paintScale(QPainter& painter) const {
  const double bottom = rowHeight_px() * static_cast<double>(needed_over_sigma_.size()) + 4.0;
  painter.setPen(theme().faint_text);
  for (double ratio = 0.1; ratio <= 2.0 * needed_over_sigma_.back() || ratio <= 10.0; ratio *= 10.0) {
    const double x = place_px(ratio);
    painter.drawLine(QPointF(x, bottom), QPointF(x, bottom + 4.0));
    const QRectF number(x - 40.0, bottom + 4.0, 80.0, 16.0);
    painter.drawText(number.right() < width() ? number : QRectF(width() - 82.0, bottom + 4.0, 80.0, 16.0),
                     (number.right() < width() ? Qt::AlignHCenter : Qt::AlignRight) | Qt::TextDontClip,
                     tr("%1 x").arg(ratio, 0, 'g', 3));
  }
  painter.setPen(theme().faint_text);
  painter.drawText(
      QRectF(0.0, bottom + 22.0, width(), kRatioScale_px - 22.0),
      Qt::AlignLeft | Qt::AlignTop | Qt::TextWordWrap,
      tr("Each bar is the needed standard deviation over the estimated one, on a "
         "logarithmic scale. The mark is at 1, the needed accuracy. Directions mix rotation, translation "
         "and time offset; each has the name of its largest part, the weakest first."));
}

bool ObservabilityView::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip || needed_over_sigma_.empty()) return QWidget::event(event);
  const auto* const help = static_cast<QHelpEvent*>(event);
  const auto bar = static_cast<std::size_t>(std::max(0.0, help->pos().y() / rowHeight_px()));
  QToolTip::showText(help->globalPos(),
                     bar < needed_over_sigma_.size() ? tr("%1: accuracy %2 times the needed one")
                                                           .arg(nameOf(bar))
                                                           .arg(needed_over_sigma_[bar], 0, 'g', 3)
                                                     : QString(),
                     this);
  return true;
}

void ObservabilityView::contextMenuEvent(QContextMenuEvent* event) {
  auto* const menu = new QMenu(this);
  menu->setAttribute(Qt::WA_DeleteOnClose);
  menu->addAction(icon("save"), tr("Save &picture (PNG, SVG, PDF)..."), this, [this] {
    saver_->askAndSave(tr("Save the picture"), "observability", pictureForms(this));
  });
  menu->popup(event->globalPos());
}

}  // namespace evical::ui
