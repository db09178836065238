// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/plot_chart.h"

#include "ui/theme/theme.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace evical::ui {
namespace {

constexpr double kSmallFont = 0.9;  // of tick labels, legend and readout, relative to the widget's

QFont scaled(const QFont& font, double factor) {
  QFont smaller = font;
  if (font.pointSizeF() > 0.0)
    smaller.setPointSizeF(font.pointSizeF() * factor);
  else
    smaller.setPixelSize(static_cast<int>(std::lround(font.pixelSize() * factor)));
  return smaller;
}

QColor faded(QColor colour, double opacity) {
  colour.setAlphaF(static_cast<float>(opacity));
  return colour;
}

constexpr double kMargin = 0.06, kLabelMargin = 0.26;  // of the range; larger above, for labels of marks

QCPRange withMargin(const QCPRange& range, bool logarithmic, double above = kMargin) {
  if (logarithmic) {
    const double ratio = range.upper / range.lower;
    return ratio > 1.0
               ? QCPRange(range.lower / std::pow(ratio, kMargin), range.upper * std::pow(ratio, above))
               : QCPRange(range.lower / 2.0, range.upper * 2.0);
  }
  if (range.size() <= 0.0) {
    const double margin = std::max(1e-6, 0.1 * std::abs(range.upper));
    return {range.lower - margin, range.upper + margin};
  }
  return {range.lower - kMargin * range.size(), range.upper + above * range.size()};
}

// Draws thousands of small squares in one call of the painter, without outlines.
class PointGraph : public QCPGraph {
 public:
  using QCPGraph::QCPGraph;

 protected:
  void drawScatterPlot(QCPPainter* painter, const QVector<QPointF>& points,
                       const QCPScatterStyle& style) const override {
    if (style.shape() != QCPScatterStyle::ssSquare) return QCPGraph::drawScatterPlot(painter, points, style);
    applyScattersAntialiasingHint(painter);
    painter->setPen(
        Qt::NoPen);  // a style without a pen uses the graph's, and outlines are the most expensive
    painter->setBrush(style.brush());
    const QPointF corner(0.5 * style.size(), 0.5 * style.size());
    QVector<QRectF> squares;
    squares.reserve(points.size());
    for (const QPointF& point : points)
      squares.push_back(QRectF(point - corner, QSizeF(style.size(), style.size())));
    painter->drawRects(squares);
  }
};

// Hidden if there is no space next to title and legend.
class NoteElement : public QCPTextElement {
 public:
  using QCPTextElement::QCPTextElement;

 protected:
  QSize minimumOuterSizeHint() const override { return {0, QCPTextElement::minimumOuterSizeHint().height()}; }
  void draw(QCPPainter* painter) override {
    painter->setFont(mainFont());
    painter->setPen(mainTextColor());
    painter->drawText(mRect, mTextFlags,
                      painter->fontMetrics().elidedText(text(), Qt::ElideRight, mRect.width()));
  }
};

}  // namespace

QColor colourOf(PlotColour colour) {
  const Theme& t = theme();
  switch (colour) {
    case PlotColour::X:
      return t.axes[0];
    case PlotColour::Y:
      return t.axes[1];
    case PlotColour::Z:
      return t.axes[2];
    case PlotColour::Accent:
      return t.accent;
    case PlotColour::Good:
      return t.good;
    case PlotColour::Warning:
      return t.warning;
    case PlotColour::Bad:
      return t.bad;
    case PlotColour::Text:
      return t.text;
    case PlotColour::Faint:
      return t.faint_text;
  }
  return t.text;
}

PlotChart::PlotChart(const PlotAxes& axes, QWidget* parent) : QCustomPlot(parent), axes_(axes) {
  xAxis->setLabel(axes.x_label);
  yAxis->setLabel(axes.y_label);
  yAxis->setRangeReversed(axes.downward_y);
  if (axes.logarithmic_y) {
    yAxis->setScaleType(QCPAxis::stLogarithmic);
    yAxis->setTicker(QSharedPointer<QCPAxisTickerLog>(new QCPAxisTickerLog));
    connect(yAxis, qOverload<const QCPRange&>(&QCPAxis::rangeChanged), this, [this](const QCPRange& range) {
      constexpr double kSeveralDecades = 20.0;  // below, ticks are not powers of ten
      const bool powers = range.upper > kSeveralDecades * range.lower;
      yAxis->setNumberFormat(powers ? "eb" : "gb");
      yAxis->setNumberPrecision(powers ? 0 : 4);
    });
  }
  if (axes.whole_x) {
    const QSharedPointer<QCPAxisTickerFixed> ticker(new QCPAxisTickerFixed);
    ticker->setScaleStrategy(QCPAxisTickerFixed::ssMultiples);
    xAxis->setTicker(ticker);
  }
  setInteractions(QCP::iRangeDrag | QCP::iRangeZoom);
  axisRect()->setRangeDrag(Qt::Horizontal | Qt::Vertical);
  constexpr int kLeftMargin_px = 62;                    // aligns charts of time below each other
  constexpr int kMinWidth_px = 50, kMinHeight_px = 16;  // charts in rows are low
  axisRect()->setMinimumSize(kMinWidth_px, kMinHeight_px);
  if (axes.time) axisRect()->setMinimumMargins({kLeftMargin_px, 15, 15, 15});
  setNoAntialiasingOnDrag(true);
  setMouseTracking(true);
  setAutoAddPlottableToLegend(false);
  cells_ = new QCPColorMap(xAxis, yAxis);
  cells_->setInterpolate(false);
  cells_->setTightBoundary(false);
  cells_->setVisible(false);
  addHeading();
  addOverlay();
  connect(this, &QCustomPlot::legendClick, this,
          [this](QCPLegend*, QCPAbstractLegendItem* item) { toggle(item); });
  connect(this, &QCustomPlot::afterLayout, this, [this] { keepScale(); });
}

// Limits the labels to those that fit above each other.
void PlotChart::resizeEvent(QResizeEvent* event) {
  constexpr int kAround_px = 56, kLabel_px = 20, kMax = 5;
  yAxis->ticker()->setTickCount(std::clamp((height() - kAround_px) / kLabel_px, 1, kMax));
  QCustomPlot::resizeEvent(event);
}

void PlotChart::addHeading() {
  auto* const heading = new QCPLayoutGrid;
  plotLayout()->insertRow(0);
  plotLayout()->addElement(0, 0, heading);
  plotLayout()->setRowStretchFactor(0, 0.001);
  plotLayout()->setRowSpacing(2);
  title_ = new QCPTextElement(this, axes_.title);
  note_ = new NoteElement(this);
  title_->setTextFlags(Qt::AlignLeft | Qt::AlignVCenter);
  note_->setTextFlags(Qt::AlignLeft | Qt::AlignVCenter);
  axisRect()->insetLayout()->take(legend);
  legend->setFillOrder(QCPLegend::foColumnsFirst);
  legend->setVisible(true);
  legend->setBorderPen(Qt::NoPen);
  legend->setBrush(Qt::NoBrush);
  legend->setIconSize(10, 10);
  legend->setIconTextPadding(4);
  legend->setColumnSpacing(8);
  legend->setMargins({0, 4, 4, 0});
  title_->setMargins({6, 2, 0, 0});
  note_->setMargins({4, 2, 0, 0});
  heading->addElement(0, 0, title_);
  heading->addElement(0, 1, note_);
  heading->addElement(0, 2, legend);
  heading->setColumnStretchFactors({0.001, 1.0, 0.001});
}

QCPItemStraightLine* PlotChart::addLine(bool vertical) {
  auto* const line = new QCPItemStraightLine(this);
  if (vertical) {
    line->point1->setTypeY(QCPItemPosition::ptAxisRectRatio);
    line->point2->setTypeY(QCPItemPosition::ptAxisRectRatio);
  } else {
    line->point1->setTypeX(QCPItemPosition::ptAxisRectRatio);
    line->point2->setTypeX(QCPItemPosition::ptAxisRectRatio);
  }
  line->setSelectable(false);
  return line;
}

void PlotChart::addOverlay() {
  const QString before = currentLayer()->name();
  setCurrentLayer("overlay");
  cursor_ = addLine(true);
  hover_ = addLine(true);
  threshold_ = addLine(false);
  readout_ = new QCPItemText(this);
  readout_->position->setType(QCPItemPosition::ptAbsolute);
  readout_->setPadding({7, 4, 7, 4});
  readout_->setTextAlignment(Qt::AlignLeft);
  readout_->setSelectable(false);
  for (QCPAbstractItem* item :
       {static_cast<QCPAbstractItem*>(cursor_), static_cast<QCPAbstractItem*>(hover_),
        static_cast<QCPAbstractItem*>(threshold_), static_cast<QCPAbstractItem*>(readout_)})
    item->setVisible(false);
  setCurrentLayer(before);
}

std::size_t PlotChart::addSeries(PlotPanel::SeriesKind kind, const SeriesStyle& style) {
  SeriesItems items{kind, style, nullptr, nullptr};
  switch (kind) {
    case PlotPanel::SeriesKind::Band:
      items.low = addGraph();
      items.plottable = addGraph();
      break;
    case PlotPanel::SeriesKind::Line:
      items.plottable = addGraph();
      break;
    case PlotPanel::SeriesKind::Points:
      items.plottable = new PointGraph(xAxis, yAxis);
      break;
    case PlotPanel::SeriesKind::Bars:
      items.plottable = new QCPBars(xAxis, yAxis);
      break;
    case PlotPanel::SeriesKind::Outline:
      items.plottable = new QCPCurve(xAxis, yAxis);
      break;
  }
  items.plottable->setName(style.name);
  if (style.in_legend && !style.name.isEmpty()) items.plottable->addToLegend();
  styleSeries(items);
  series.push_back(items);
  return series.size() - 1;
}

void PlotChart::setMarks(std::span<const PlotMark> marks) {
  for (const Mark& mark : marks_) {
    removeItem(mark.line);
    removeItem(mark.label);
  }
  marks_.clear();
  for (const PlotMark& wanted : marks) {
    Mark mark{addLine(true), new QCPItemText(this)};
    mark.line->setLayer("grid");
    mark.line->point1->setCoords(wanted.x, 0.0);
    mark.line->point2->setCoords(wanted.x, 1.0);
    mark.label->setText(wanted.label);
    mark.label->position->setTypeY(QCPItemPosition::ptAxisRectRatio);
    mark.label->position->setCoords(wanted.x, 0.0);
    mark.label->setPositionAlignment(Qt::AlignLeft | Qt::AlignTop);
    mark.label->setPadding({4, 3, 0, 0});
    mark.label->setSelectable(false);
    marks_.push_back(mark);
  }
  styleOverlay(font());
}

void PlotChart::setLevels(const std::vector<double>& y) {
  for (QCPItemStraightLine* const level : levels_) removeItem(level);
  levels_.clear();
  for (const double at : y) {
    QCPItemStraightLine* const level = addLine(false);
    level->setLayer("grid");
    level->point1->setCoords(0.0, at);
    level->point2->setCoords(1.0, at);
    levels_.push_back(level);
  }
  styleOverlay(font());
}

std::vector<double> PlotChart::levels() const {
  std::vector<double> y;
  for (const QCPItemStraightLine* const level : levels_) y.push_back(level->point1->coords().y());
  return y;
}

void PlotChart::setCursorLine(std::optional<double> x) {
  cursor_->setVisible(x.has_value());
  if (x) {
    cursor_->point1->setCoords(*x, 0.0);
    cursor_->point2->setCoords(*x, 1.0);
  }
  layer("overlay")->replot();
}

void PlotChart::setThreshold(std::optional<double> y) {
  threshold_->setVisible(y.has_value());
  if (y) {
    threshold_->point1->setCoords(0.0, *y);
    threshold_->point2->setCoords(1.0, *y);
  }
  layer("overlay")->replot();
}

std::optional<double> PlotChart::threshold() const {
  return threshold_->visible() ? std::optional(threshold_->point1->coords().y()) : std::nullopt;
}

void PlotChart::fit(const QCPRange& x_within) {
  const bool all = x_within.size() <= 0.0;
  bool found = false;
  const QCP::SignDomain positive = axes_.logarithmic_y ? QCP::sdPositive : QCP::sdBoth;
  QCPRange x, y;
  for (int k = 0; k < plottableCount(); ++k) {
    if (!plottable(k)->visible()) continue;
    bool found_x = false, found_y = false;
    QCPRange this_x = plottable(k)->getKeyRange(found_x),
             this_y = plottable(k)->getValueRange(found_y, positive, x_within);
    if (!found_x || !found_y) continue;
    if (plottable(k) == cells_) {
      this_x = {cells_extent.left(), cells_extent.right()};
      this_y = {cells_extent.top(), cells_extent.bottom()};
    }
    x = found ? x.expanded(this_x) : this_x;
    y = found ? y.expanded(this_y) : this_y;
    found = true;
  }
  if (threshold_->visible() && found) y.expand(threshold_->point1->coords().y());
  if (!found) return;
  const bool edges = axes_.equal_scale && cells_->visible();
  const bool exact = axes_.time || edges || !all;
  if (!all) x = x_within;
  xAxis->setRange(exact ? x : withMargin(x, false));
  yAxis->setRange(edges ? y : withMargin(y, axes_.logarithmic_y, marks_.empty() ? kMargin : kLabelMargin));
  keepScale();
  replot(rpQueuedReplot);
}

void PlotChart::keepScale() {
  const QSize pixels = axisRect()->size();
  if (!axes_.equal_scale || pixels.isEmpty()) return;
  const bool as_left = xAxis->range() == kept_x_ && yAxis->range() == kept_y_;
  if (as_left && pixels == kept_pixels_) return;
  // Starts from the requested range, not from the last layout's: otherwise each resize would enlarge it.
  if (!as_left) std::tie(wanted_x_, wanted_y_) = std::pair{xAxis->range(), yAxis->range()};
  xAxis->setRange(wanted_x_);
  yAxis->setRange(wanted_y_);
  const double x_scale = xAxis->range().size() / pixels.width(),
               y_scale = yAxis->range().size() / pixels.height();
  if (x_scale > y_scale)
    yAxis->setScaleRatio(xAxis, 1.0);
  else
    xAxis->setScaleRatio(yAxis, 1.0);
  std::tie(kept_x_, kept_y_, kept_pixels_) = std::tuple{xAxis->range(), yAxis->range(), pixels};
  axisRect()->update(QCPLayoutElement::upPreparation);  // the layout has chosen its ticks already
}

void PlotChart::restyle(const QFont& font) {
  setBackground(QBrush(theme().panel));
  styleAxes(font);
  title_->setFont([&] {
    QFont bold = font;
    bold.setWeight(QFont::DemiBold);
    return bold;
  }());
  title_->setTextColor(theme().text);
  note_->setFont(scaled(font, kSmallFont));
  note_->setTextColor(theme().faint_text);
  legend->setFont(scaled(font, kSmallFont));
  legend->setTextColor(theme().text);
  for (int k = 0; k < legend->itemCount(); ++k) legend->item(k)->setFont(scaled(font, kSmallFont));
  for (const SeriesItems& items : series) styleSeries(items);
  QCPColorGradient gradient;
  gradient.setColorStops(
      {{0.0, faded(colourOf(cell_colour), 0.06)}, {1.0, faded(colourOf(cell_colour), 0.75)}});
  gradient.setNanHandling(QCPColorGradient::nhTransparent);
  cells_->setGradient(gradient);
  styleOverlay(font);
  replot(rpQueuedReplot);
}

void PlotChart::styleAxes(const QFont& font) {
  const Theme& t = theme();
  for (QCPAxis* axis : {xAxis, yAxis}) {
    axis->setLabelFont(scaled(font, kSmallFont));
    axis->setTickLabelFont(scaled(font, kSmallFont));
    axis->setLabelColor(t.faint_text);
    axis->setTickLabelColor(t.faint_text);
    axis->setBasePen(QPen(t.grid_line));
    axis->setTickPen(QPen(t.grid_line));
    axis->setSubTickPen(Qt::NoPen);
    axis->setTickLength(0, 3);
    axis->setLabelPadding(3);
    axis->grid()->setPen(QPen(t.grid_line, 0, Qt::SolidLine));
    axis->grid()->setZeroLinePen(axes_.logarithmic_y ? Qt::NoPen
                                                     : QPen(t.grid_line.darker(t.dark ? 70 : 115), 1.0));
    axis->grid()->setSubGridVisible(false);
  }
}

void PlotChart::styleSeries(const SeriesItems& items) {
  const SeriesStyle& style = items.style;
  const QColor colour = faded(colourOf(style.colour), style.opacity);
  QPen pen(colour, style.width_px, style.dashed ? Qt::DashLine : Qt::SolidLine);
  items.plottable->setAntialiased(style.width_px != 1.0 || items.kind == PlotPanel::SeriesKind::Outline);
  switch (items.kind) {
    case PlotPanel::SeriesKind::Line:
    case PlotPanel::SeriesKind::Outline:
      items.plottable->setPen(pen);
      break;
    case PlotPanel::SeriesKind::Points: {
      auto* const graph = static_cast<QCPGraph*>(items.plottable);
      graph->setLineStyle(QCPGraph::lsNone);
      const bool small = style.width_px <= 3.5;  // a square is much faster than a disc
      graph->setPen(pen);
      graph->setAntialiasedScatters(!small);
      graph->setScatterStyle(
          small ? QCPScatterStyle(QCPScatterStyle::ssSquare, QPen(Qt::NoPen), QBrush(colour), style.width_px)
                : QCPScatterStyle(QCPScatterStyle::ssDisc, colour, style.width_px));
      break;
    }
    case PlotPanel::SeriesKind::Bars:
      items.plottable->setPen(Qt::NoPen);
      items.plottable->setBrush(colour);
      break;
    case PlotPanel::SeriesKind::Band:
      items.low->setPen(Qt::NoPen);
      items.plottable->setPen(Qt::NoPen);
      items.plottable->setBrush(colour);
      static_cast<QCPGraph*>(items.plottable)->setChannelFillGraph(items.low);
      break;
  }
}

void PlotChart::styleOverlay(const QFont& font) {
  const Theme& t = theme();
  cursor_->setPen(QPen(t.accent, 1.5));
  hover_->setPen(QPen(faded(t.faint_text, 0.6), 1.0, Qt::DotLine));
  threshold_->setPen(QPen(t.bad, 2.0));
  readout_->setFont(scaled(font, kSmallFont));
  readout_->setColor(t.text);
  readout_->setBrush(faded(t.window, 0.92));
  readout_->setPen(QPen(t.grid_line));
  for (QCPItemStraightLine* const level : levels_) level->setPen(QPen(t.warning, 1.6, Qt::DashDotLine));
  for (const Mark& mark : marks_) {
    mark.line->setPen(QPen(t.faint_text, 1.0, Qt::DashLine));
    mark.label->setFont(scaled(font, kSmallFont));
    mark.label->setColor(t.faint_text);
  }
  for (QCPItemLine* arrow : arrows_) {
    arrow->setPen(QPen(colourOf(arrow_colour), 1.2));
    arrow->setHead(QCPLineEnding(QCPLineEnding::esSpikeArrow, 4, 5));
  }
}

}  // namespace evical::ui
