// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/correlation_view.h"

#include "ui/theme/theme.h"

#include <QHelpEvent>
#include <QLinearGradient>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include <algorithm>
#include <cmath>
#include <vector>

namespace evical::ui {
namespace {

constexpr int kScale_px = 34;  // the colour scale and its numbers, below

QColor mixed(const QColor& a, const QColor& b, double share_of_b) {
  const auto mix = [&](int from, int to) { return static_cast<int>(from + share_of_b * (to - from)); };
  return {mix(a.red(), b.red()), mix(a.green(), b.green()), mix(a.blue(), b.blue())};
}

QColor colourOf(double correlation) {
  const QColor& end = correlation < 0.0 ? theme().axes[2] : theme().axes[0];
  return mixed(theme().panel, end, std::min(1.0, std::abs(correlation)));
}

// "left.rotation.x [rad]" gives "left.rotation.x"
QString withoutUnit(const QString& name) {
  return name.section(" [", 0, 0);
}

}  // namespace

CorrelationView::CorrelationView(QWidget* parent) : QWidget(parent) {
  setMouseTracking(true);
  setAccessibleName(tr("Correlation of the quantities"));
}

void CorrelationView::setCorrelation(const QStringList& names, const Eigen::MatrixXd& correlation) {
  names_ = names;
  correlation_ = correlation;
  hovered_.reset();
  update();
}

int CorrelationView::labelWidth_px() const {
  constexpr int kLeastForLabels_px = 420, kMost_px = 190;
  return width() < kLeastForLabels_px ? 0 : std::min(kMost_px, width() / 3);
}

double CorrelationView::cellSize_px() const {
  const auto count = static_cast<double>(std::max<Eigen::Index>(1, correlation_.rows()));
  return std::max(1.0, std::min(width() - labelWidth_px() - 8.0, height() - kScale_px - 4.0) / count);
}

QPointF CorrelationView::origin() const {
  return {labelWidth_px() + 4.0, 2.0};
}

void CorrelationView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  if (correlation_.size() == 0) {
    painter.setPen(theme().faint_text);
    painter.drawText(rect(), Qt::AlignCenter, tr("No correlations yet."));
    return;
  }
  const double cell_px = cellSize_px();
  for (Eigen::Index row = 0; row < correlation_.rows(); ++row) {
    for (Eigen::Index col = 0; col < correlation_.cols(); ++col) {
      const QPointF corner = origin() + cell_px * QPointF(static_cast<double>(col), static_cast<double>(row));
      painter.fillRect(QRectF(corner, QSizeF(cell_px, cell_px)), colourOf(correlation_(row, col)));
    }
  }
  painter.setPen(theme().grid_line);
  const double side_px = cell_px * static_cast<double>(correlation_.rows());
  painter.drawRect(QRectF(origin(), QSizeF(side_px, side_px)));
  QFont font = painter.font();
  font.setPointSizeF(std::clamp(0.62 * cell_px, 6.0, 9.0));
  painter.setFont(font);
  painter.setPen(theme().faint_text);
  for (qsizetype i = 0; labelWidth_px() > 0 && i < names_.size(); ++i) {
    const QRectF line(0.0, origin().y() + cell_px * static_cast<double>(i), labelWidth_px(), cell_px);
    const QString shown =
        painter.fontMetrics().elidedText(withoutUnit(names_[i]), Qt::ElideLeft, labelWidth_px() - 4);
    painter.drawText(line, Qt::AlignRight | Qt::AlignVCenter | Qt::TextDontClip, shown);
  }
  if (hovered_) {
    painter.setPen(QPen(theme().text, 1.5));
    const QPointF corner = origin() + cell_px * QPointF(static_cast<double>(hovered_->second),
                                                        static_cast<double>(hovered_->first));
    painter.drawRect(QRectF(corner, QSizeF(cell_px, cell_px)));
  }
  paintScale(painter);
}

void CorrelationView::paintScale(QPainter& painter) const {
  const double side_px = cellSize_px() * static_cast<double>(correlation_.rows());
  const QRectF bar(origin().x(), origin().y() + side_px + 8.0, side_px, 8.0);
  QLinearGradient gradient(bar.topLeft(), bar.topRight());
  for (const double correlation : {-1.0, -0.5, 0.0, 0.5, 1.0})
    gradient.setColorAt(0.5 * (correlation + 1.0), colourOf(correlation));
  painter.fillRect(bar, gradient);
  painter.setFont(font());
  painter.setPen(theme().faint_text);
  const QRectF text = bar.translated(0.0, 10.0).adjusted(0.0, 0.0, 0.0, 8.0);
  painter.drawText(text, Qt::AlignLeft | Qt::TextDontClip, "-1");
  painter.drawText(text, Qt::AlignHCenter | Qt::TextDontClip, "0");
  painter.drawText(text, Qt::AlignRight | Qt::TextDontClip, "+1");
}

std::optional<CorrelationView::Cell> CorrelationView::cellAt(const QPointF& position) const {
  const QPointF inside = (position - origin()) / cellSize_px();
  const auto col = static_cast<Eigen::Index>(std::floor(inside.x()));
  const auto row = static_cast<Eigen::Index>(std::floor(inside.y()));
  if (row < 0 || col < 0 || row >= correlation_.rows() || col >= correlation_.cols()) return std::nullopt;
  return Cell{row, col};
}

QString CorrelationView::textAt(const QPoint& position) const {
  const std::optional<Cell> cell = cellAt(position);
  if (!cell || cell->first >= names_.size() || cell->second >= names_.size()) return {};
  return tr("%1 and %2: %3")
      .arg(withoutUnit(names_[cell->first]), withoutUnit(names_[cell->second]))
      .arg(correlation_(cell->first, cell->second), 0, 'f', 3);
}

QStringList CorrelationView::strongestPairs(int count) const {
  std::vector<Cell> cells;
  for (Eigen::Index row = 0; row < correlation_.rows(); ++row)
    for (Eigen::Index col = row + 1; col < correlation_.cols(); ++col) cells.emplace_back(row, col);
  const auto stronger = [&](const Cell& a, const Cell& b) {
    return std::abs(correlation_(a.first, a.second)) > std::abs(correlation_(b.first, b.second));
  };
  std::sort(cells.begin(), cells.end(), stronger);
  QStringList pairs;
  for (std::size_t i = 0; i < cells.size() && static_cast<int>(i) < count; ++i) {
    const auto [row, col] = cells[i];
    pairs << tr("%1 and %2: %3")
                 .arg(withoutUnit(names_.value(row)), withoutUnit(names_.value(col)))
                 .arg(correlation_(row, col), 0, 'f', 2);
  }
  return pairs;
}

bool CorrelationView::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QWidget::event(event);
  const auto* const help = static_cast<QHelpEvent*>(event);
  QToolTip::showText(help->globalPos(), textAt(help->pos()), this);
  return true;
}

void CorrelationView::mouseMoveEvent(QMouseEvent* event) {
  const std::optional<Cell> cell = cellAt(event->position());
  if (cell == hovered_) return;
  hovered_ = cell;
  update();
}

void CorrelationView::leaveEvent(QEvent*) {
  hovered_.reset();
  update();
}

}  // namespace evical::ui
