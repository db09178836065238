// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/result/correlation_view.h"

#include "core/report/shown_quantity.h"
#include "ui/jobs/file_saver.h"
#include "ui/theme/theme.h"

#include <QContextMenuEvent>
#include <QHelpEvent>
#include <QLinearGradient>
#include <QMenu>
#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace evical::ui {
namespace {

constexpr int kColourScale_px = 34;  // colour scale and its numbers, at the bottom

QColor colourOf(double correlation) {
  const QColor& end = correlation < 0.0 ? theme().axes[2] : theme().axes[0];
  return mixed(theme().panel, end, std::min(1.0, std::abs(correlation)));
}

}  // namespace

CorrelationView::CorrelationView(QWidget* parent) : QWidget(parent), saver_(new FileSaver(this)) {
  setMouseTracking(true);
  setAccessibleName(tr("Correlation of the quantities"));
}

void CorrelationView::setResult(const NamedResult& result) {
  correlation_ = result.result->uncertainty.correlation;
  names_.clear();
  for (const std::string& name : columnNames(result)) names_ << QString::fromStdString(name);
  words_.clear();
  groups_.clear();
  for (const QuantityAddress& column : result.result->uncertainty.columns) {
    QuantityWords words = quantityWords(column, result);
    words_ << QString::fromStdString(quantitySentence(words));
    words.part.clear();
    const QString label = QString::fromStdString(quantitySentence(words));
    if (groups_.empty() || groups_.back().label != label) groups_.push_back({label, words_.size() - 1, 0});
    ++groups_.back().count;
  }
  hovered_.reset();
  pinned_.reset();
  measureLabels();
  setAccessibleDescription(strongestPairs(3).join("; "));
  update();
}

QStringList CorrelationView::axisLabels() const {
  QStringList labels;
  for (const Group& group : groups_) labels << group.label;
  return labels;
}

QFont CorrelationView::labelFont() const {
  constexpr double kPoints = 7.5;
  QFont small = font();
  small.setPointSizeF(kPoints);
  return small;
}

// Kept, since each painted cell needs it: measuring texts takes longer than painting them.
void CorrelationView::measureLabels() {
  const QFontMetricsF metrics(labelFont());
  longest_label_px_ = 0.0;
  for (const Group& group : groups_)
    longest_label_px_ = std::max(longest_label_px_, metrics.horizontalAdvance(group.label) + 8.0);
}

double CorrelationView::cellSize_px() const {
  const auto count = static_cast<double>(std::max<Eigen::Index>(1, correlation_.rows()));
  return std::max(1.0,
                  std::min(width() - origin().x() - 4.0, height() - origin().y() - kColourScale_px) / count);
}

// Names are left of the rows and, vertical, above the columns.
QPointF CorrelationView::origin() const {
  constexpr double kSideShare = 0.36, kTopShare = 0.3;
  return {std::min(longest_label_px_, kSideShare * width()),
          std::min(longest_label_px_, kTopShare * height())};
}

QPoint CorrelationView::cellMiddle(Eigen::Index row, Eigen::Index col) const {
  const QPointF inside(static_cast<double>(col) + 0.5, static_cast<double>(row) + 0.5);
  return (origin() + cellSize_px() * inside).toPoint();
}

void CorrelationView::paintEvent(QPaintEvent* event) {
  QPainter painter(this);
  if (correlation_.size() == 0) {
    painter.setPen(theme().faint_text);
    painter.drawText(rect(), Qt::AlignCenter, tr("No correlations yet."));
    return;
  }
  paintCells(painter, event->rect());
  paintLabels(painter);
  paintScale(painter);
  if (pinned_) paintPinned(painter);
}

QRectF CorrelationView::square(const Cell& cell) const {
  const double cell_px = cellSize_px();
  return {origin() + cell_px * QPointF(static_cast<double>(cell.second), static_cast<double>(cell.first)),
          QSizeF(cell_px, cell_px)};
}

void CorrelationView::paintCells(QPainter& painter, const QRectF& dirty) const {
  const double cell_px = cellSize_px();
  const QPointF corner = origin();
  const auto from = [&](double at_px) {
    const auto most = static_cast<double>(correlation_.rows());
    return static_cast<Eigen::Index>(std::clamp(std::floor(at_px / cell_px), 0.0, most));
  };
  const Eigen::Index row_end = std::min(correlation_.rows(), from(dirty.bottom() - corner.y()) + 1);
  const Eigen::Index col_end = std::min(correlation_.cols(), from(dirty.right() - corner.x()) + 1);
  for (Eigen::Index row = from(dirty.top() - corner.y()); row < row_end; ++row)
    for (Eigen::Index col = from(dirty.left() - corner.x()); col < col_end; ++col) {
      const QPointF at(static_cast<double>(col), static_cast<double>(row));
      painter.fillRect(QRectF(corner + cell_px * at, QSizeF(cell_px, cell_px)),
                       colourOf(correlation_(row, col)));
    }
  painter.setPen(theme().grid_line);
  const double side_px = cell_px * static_cast<double>(correlation_.rows());
  painter.drawRect(QRectF(corner, QSizeF(side_px, side_px)));
  for (const Group& group : groups_) {
    const double at_px = cell_px * static_cast<double>(group.begin);
    painter.drawLine(corner + QPointF(0.0, at_px), corner + QPointF(side_px, at_px));
    painter.drawLine(corner + QPointF(at_px, 0.0), corner + QPointF(at_px, side_px));
  }
  painter.setPen(QPen(theme().text, 1.5));
  for (const std::optional<Cell>& cell : {hovered_, pinned_})
    if (cell) painter.drawRect(square(*cell));
}

// Text of the pinned cell in a box below it; above it if there is no space.
void CorrelationView::paintPinned(QPainter& painter) const {
  constexpr int kMargin_px = 6;
  const QPoint at = cellMiddle(pinned_->first, pinned_->second);
  const int gap_px = static_cast<int>(cellSize_px()) + kMargin_px;
  const QRect most(0, 0, width() - 2 * kMargin_px, height());
  QRect box = painter.fontMetrics()
                  .boundingRect(most, Qt::AlignCenter | Qt::TextWordWrap, pinnedText())
                  .adjusted(-kMargin_px, -kMargin_px, kMargin_px, kMargin_px);
  box.moveTo(std::clamp(at.x() - box.width() / 2, 0, std::max(0, width() - box.width())), at.y() + gap_px);
  if (box.bottom() >= height()) box.moveBottom(at.y() - gap_px);
  painter.setPen(theme().text);
  painter.setBrush(theme().panel);
  painter.drawRect(box.adjusted(0, 0, -1, -1));
  painter.drawText(box, Qt::AlignCenter | Qt::TextWordWrap, pinnedText());
}

// Names are thinned out if the lines are too narrow; tool tips have them all.
void CorrelationView::paintLabels(QPainter& painter) const {
  painter.setFont(labelFont());
  painter.setPen(theme().text);
  const double line_px = painter.fontMetrics().height();
  double free_from_px = 0.0;
  for (const Group& group : groups_) {
    const double middle_px =
        cellSize_px() * (static_cast<double>(group.begin) + 0.5 * static_cast<double>(group.count));
    if (middle_px - 0.5 * line_px < free_from_px - 1.5) continue;
    free_from_px = middle_px + 0.5 * line_px;
    const auto draw = [&](double room_px) {
      const QRectF line(-room_px, -0.5 * line_px, room_px - 4.0, line_px);
      painter.drawText(
          line, Qt::AlignRight | Qt::AlignVCenter | Qt::TextDontClip,
          painter.fontMetrics().elidedText(group.label, Qt::ElideRight, static_cast<int>(room_px) - 4));
    };
    painter.save();
    painter.translate(origin().x(), origin().y() + middle_px);
    draw(origin().x());
    painter.restore();
    painter.save();
    painter.translate(origin().x() + middle_px, origin().y());
    painter.rotate(90.0);
    draw(origin().y());
    painter.restore();
  }
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
  return textOf(cellAt(position));
}

QString CorrelationView::pinnedText() const {
  return textOf(pinned_);
}

QString CorrelationView::textOf(const std::optional<Cell>& cell) const {
  if (!cell || cell->first >= names_.size() || cell->second >= names_.size()) return {};
  return tr("%1 and %2: %3")
      .arg(words_[cell->first], words_[cell->second])
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
                 .arg(words_.value(row), words_.value(col))
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
  hover(cellAt(event->position()));
}

// Repaints only the two cells: the whole matrix takes longer than the mouse from cell to cell.
void CorrelationView::hover(const std::optional<Cell>& cell) {
  if (cell == hovered_) return;
  constexpr int kOutline_px = 2;
  const std::optional<Cell> before = std::exchange(hovered_, cell);
  for (const std::optional<Cell>& changed : {before, cell})
    if (changed)
      update(square(*changed).toAlignedRect().adjusted(-kOutline_px, -kOutline_px, kOutline_px, kOutline_px));
}

void CorrelationView::mousePressEvent(QMouseEvent* event) {
  if (event->button() != Qt::LeftButton) return QWidget::mousePressEvent(event);
  const std::optional<Cell> cell = cellAt(event->position());
  pinned_ = cell == pinned_ ? std::nullopt : cell;
  update();
}

void CorrelationView::leaveEvent(QEvent*) {
  hover(std::nullopt);
}

void CorrelationView::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) measureLabels();
}

QString CorrelationView::csv() const {
  QString text = "name";
  for (const QString& name : names_) text += "," + name;
  text += "\n";
  for (Eigen::Index row = 0; row < correlation_.rows(); ++row) {
    text += names_.value(row);
    for (Eigen::Index col = 0; col < correlation_.cols(); ++col)
      text += "," + QString::number(correlation_(row, col), 'g', 9);
    text += "\n";
  }
  return text;
}

void CorrelationView::save(bool table) {
  if (!table) return saver_->askAndSave(tr("Save the picture"), "correlation", pictureForms(this));
  const auto prepare = [this] { return [text = csv()] { return text.toUtf8(); }; };
  saver_->askAndSave(tr("Save the data"), "correlation", {{tr("Table"), "csv", prepare}});
}

void CorrelationView::contextMenuEvent(QContextMenuEvent* event) {
  auto* const menu = new QMenu(this);
  menu->setAttribute(Qt::WA_DeleteOnClose);
  menu->addAction(icon("save"), tr("Save &picture (PNG, SVG, PDF)..."), this, [this] { save(false); });
  menu->addAction(tr("Save &data (CSV)..."), this, [this] { save(true); });
  menu->popup(event->globalPos());
}

}  // namespace evical::ui
