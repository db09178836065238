// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/plot_panel.h"

#include "ui/plots/chart_saving.h"
#include "ui/plots/plot_chart.h"
#include "ui/theme/theme.h"

#include <QContextMenuEvent>
#include <QKeyEvent>
#include <QMenu>
#include <QPainter>
#include <QVBoxLayout>

#include <numeric>

namespace evical::ui {
namespace {

constexpr double kPan = 0.15, kZoom = 0.8;  // share of the range per key press

QVector<double> toQVector(const std::vector<double>& values) {
  return QVector<double>(values.begin(), values.end());
}

}  // namespace

std::shared_ptr<PlotLineData> makePlotLine(const std::vector<double>& x, const std::vector<double>& y) {
  QVector<QCPGraphData> points;
  points.reserve(static_cast<qsizetype>(x.size()));
  for (std::size_t k = 0; k < x.size(); ++k) points.append({x[k], y[k]});
  auto line = std::make_shared<PlotLineData>();
  line->points.reset(new QCPGraphDataContainer);
  line->points->set(points, true);
  return line;
}

PlotPanel::PlotPanel(const PlotAxes& axes, QWidget* parent)
    : QWidget(parent), chart_(new PlotChart(axes, this)), saver_(new FileSaver(this)) {
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(5, 5, 5, 5);
  layout->addWidget(chart_);
  setFocusPolicy(Qt::StrongFocus);
  setAccessibleName(axes.title.isEmpty() ? tr("Chart of %1").arg(axes.y_label) : axes.title);
  setMinimumSize(180, 110);
  setToolTip(
      tr("Wheel: zoom (Ctrl: y only). Drag: pan. Shift and drag: zoom into a box. Double click or F: fit.\n"
         "Click on the legend: show or hide. Right button: save picture or points."));
  connect(chart_, &PlotChart::clicked, this, &PlotPanel::clicked);
  connect(chart_, &PlotChart::thresholdDragged, this, &PlotPanel::thresholdDragged);
  chart_->restyle(font());
}

PlotPanel::Series PlotPanel::addSeries(SeriesKind kind, const SeriesStyle& style) {
  const Series series = chart_->addSeries(kind, style);
  chart_->restyle(font());
  return series;
}

void PlotPanel::setData(Series series, const std::vector<double>& x, const std::vector<double>& y) {
  const PlotChart::SeriesItems& items = chart_->series[series];
  switch (items.kind) {
    case SeriesKind::Line:
      static_cast<QCPGraph*>(items.plottable)->setData(toQVector(x), toQVector(y), true);
      break;
    case SeriesKind::Points:
      static_cast<QCPGraph*>(items.plottable)->setData(toQVector(x), toQVector(y), false);
      break;
    case SeriesKind::Bars:
      static_cast<QCPBars*>(items.plottable)->setData(toQVector(x), toQVector(y), true);
      break;
    case SeriesKind::Outline: {
      QVector<double> order(static_cast<int>(x.size()));
      std::iota(order.begin(), order.end(), 0.0);
      static_cast<QCPCurve*>(items.plottable)->setData(order, toQVector(x), toQVector(y), true);
      break;
    }
    case SeriesKind::Band:
      Q_ASSERT_X(false, "PlotPanel::setData", "bands are set by setBand");
      break;
  }
  chart_->replot(QCustomPlot::rpQueuedReplot);
}

void PlotPanel::setLine(Series series, const std::shared_ptr<PlotLineData>& line) {
  static_cast<QCPGraph*>(chart_->series[series].plottable)->setData(line->points);
  chart_->replot(QCustomPlot::rpQueuedReplot);
}

void PlotPanel::setBand(Series series, const std::vector<double>& x, const std::vector<double>& low,
                        const std::vector<double>& high) {
  const PlotChart::SeriesItems& items = chart_->series[series];
  items.low->setData(toQVector(x), toQVector(low), true);
  static_cast<QCPGraph*>(items.plottable)->setData(toQVector(x), toQVector(high), true);
  chart_->replot(QCustomPlot::rpQueuedReplot);
}

void PlotPanel::setBarWidth(Series series, double width) {
  static_cast<QCPBars*>(chart_->series[series].plottable)->setWidth(width);
}

void PlotPanel::setCells(const PlotCells& cells, PlotColour colour) {
  QCPColorMapData* const map = chart_->cells()->data();
  const double half_x = 0.5 * cells.extent.width() / cells.columns,
               half_y = 0.5 * cells.extent.height() / cells.rows;
  map->setSize(cells.columns, cells.rows);  // its range is that of the cells' centres
  map->setRange({cells.extent.left() + half_x, cells.extent.right() - half_x},
                {cells.extent.top() + half_y, cells.extent.bottom() - half_y});
  for (int row = 0; row < cells.rows; ++row) {
    for (int column = 0; column < cells.columns; ++column)
      map->setCell(column, row, cells.values[static_cast<std::size_t>(row * cells.columns + column)]);
  }
  double largest = 0.0;  // QCustomPlot's own search fails with NaN
  for (const double value : cells.values) {
    if (value > largest) largest = value;
  }
  chart_->cells()->setDataRange({0.0, largest});
  chart_->cells()->setVisible(true);
  chart_->cells_extent = cells.extent;
  chart_->cell_colour = colour;
  chart_->restyle(font());
}

void PlotPanel::setArrows(std::span<const PlotArrow> arrows, PlotColour colour) {
  for (QCPItemLine* old : chart_->arrows()) chart_->removeItem(old);
  chart_->arrows().clear();
  for (const PlotArrow& arrow : arrows) {
    auto* const line = new QCPItemLine(chart_);
    line->start->setCoords(arrow.from);
    line->end->setCoords(arrow.to);
    line->setSelectable(false);
    chart_->arrows().push_back(line);
  }
  chart_->arrow_colour = colour;
  chart_->restyle(font());
}

void PlotPanel::setMarks(std::span<const PlotMark> marks) {
  chart_->setMarks(marks);
  chart_->replot(QCustomPlot::rpQueuedReplot);
}

void PlotPanel::setLevels(const std::vector<double>& y) {
  chart_->setLevels(y);
  chart_->replot(QCustomPlot::rpQueuedReplot);
}

std::vector<double> PlotPanel::levels() const {
  return chart_->levels();
}

void PlotPanel::clear() {
  for (Series k = 0; k < chart_->series.size(); ++k) {
    if (chart_->series[k].kind == SeriesKind::Band)
      setBand(k, {}, {}, {});
    else
      setData(k, {}, {});
  }
  chart_->cells()->setVisible(false);
  setArrows({}, chart_->arrow_colour);
  setMarks({});
  setLevels({});
  setNote({});
}

void PlotPanel::setTitle(const QString& title) {
  chart_->title()->setText(title);
  chart_->replot(QCustomPlot::rpQueuedReplot);
}

void PlotPanel::setLegendText(Series series, const QString& text) {
  chart_->series[series].plottable->setName(text);
  chart_->replot(QCustomPlot::rpQueuedReplot);
}

void PlotPanel::setYLabel(const QString& label) {
  chart_->yAxis->setLabel(label);
  chart_->replot(QCustomPlot::rpQueuedReplot);
}

void PlotPanel::setNote(const QString& note) {
  chart_->note()->setText(note);
  chart_->replot(QCustomPlot::rpQueuedReplot);
}

void PlotPanel::fit() {
  chart_->fit();
}

void PlotPanel::fitWithin(double x_low, double x_high) {
  chart_->fit(QCPRange(x_low, x_high));
}

void PlotPanel::setXRange(double low, double high) {
  chart_->xAxis->setRange(low, high);
  chart_->replot(QCustomPlot::rpQueuedReplot);
}

void PlotPanel::setYRange(double low, double high) {
  chart_->yAxis->setRange(low, high);
  chart_->replot(QCustomPlot::rpQueuedReplot);
}

std::pair<double, double> PlotPanel::xRange() const {
  return {chart_->xAxis->range().lower, chart_->xAxis->range().upper};
}

std::pair<double, double> PlotPanel::yRange() const {
  return {chart_->yAxis->range().lower, chart_->yAxis->range().upper};
}

void PlotPanel::linkX(const std::vector<PlotPanel*>& panels) {
  for (PlotPanel* from : panels) {
    for (PlotPanel* to : panels) {
      if (from == to) continue;
      connect(from->chart_->xAxis, qOverload<const QCPRange&>(&QCPAxis::rangeChanged), to,
              [to](const QCPRange& range) {
                if (to->chart_->xAxis->range() != range) to->setXRange(range.lower, range.upper);
              });
    }
  }
}

void PlotPanel::setCursorLine(std::optional<double> x) {
  chart_->setCursorLine(x);
}

void PlotPanel::setThreshold(std::optional<double> y) {
  chart_->setThreshold(y);
}

std::optional<double> PlotPanel::threshold() const {
  return chart_->threshold();
}

QPointF PlotPanel::pixelAt(double x, double y) const {
  return chart_->mapToParent(
      QPointF(chart_->xAxis->coordToPixel(x), chart_->yAxis->coordToPixel(y)).toPoint());
}

void PlotPanel::redraw() {
  chart_->replot(QCustomPlot::rpImmediateRefresh);
}

void PlotPanel::contextMenuEvent(QContextMenuEvent* event) {
  auto* const menu = new QMenu(this);
  menu->setAttribute(Qt::WA_DeleteOnClose);
  menu->addAction(tr("&Fit to data"), this, &PlotPanel::fit);
  menu->addSeparator();
  addSaveActions(*menu, *this, *saver_);
  menu->popup(event->globalPos());
}

void PlotPanel::keyPressEvent(QKeyEvent* event) {
  switch (event->key()) {
    case Qt::Key_Left:
      return chart_->panX(-kPan);
    case Qt::Key_Right:
      return chart_->panX(kPan);
    case Qt::Key_Plus:
    case Qt::Key_Equal:
      return chart_->zoomX(kZoom);
    case Qt::Key_Minus:
      return chart_->zoomX(1.0 / kZoom);
    case Qt::Key_F:
    case Qt::Key_Home:
      return fit();
    default:
      QWidget::keyPressEvent(event);
  }
}

void PlotPanel::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange ||
      event->type() == QEvent::ApplicationFontChange)
    chart_->restyle(font());
}

void PlotPanel::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setBrush(theme().panel);
  painter.setPen(hasFocus() ? theme().accent : theme().grid_line);
  painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 6, 6);
}

}  // namespace evical::ui
