// SPDX-License-Identifier: GPL-3.0-or-later
// Chart inside a PlotPanel: QCustomPlot with the program's colours, mouse and overlay. For plot_panel.cpp
// only.
#pragma once

#include "ui/plots/plot_panel.h"

#include <qcustomplot.h>

#include <optional>
#include <vector>

namespace evical::ui {

QColor colourOf(PlotColour colour);

struct PlotLineData {
  QSharedPointer<QCPGraphDataContainer> points;
};

class PlotChart : public QCustomPlot {
  Q_OBJECT

 public:
  PlotChart(const PlotAxes& axes, QWidget* parent);

  struct SeriesItems {
    PlotPanel::SeriesKind kind;
    SeriesStyle style;
    QCPAbstractPlottable* plottable;
    QCPGraph* low;  // a band's lower edge
  };
  std::vector<SeriesItems> series;
  QRectF cells_extent;  // QCustomPlot has only that of the cells' centres
  PlotColour cell_colour = PlotColour::Accent, arrow_colour = PlotColour::Text;

  const PlotAxes& axes() const { return axes_; }
  QCPTextElement* title() { return title_; }
  QCPTextElement* note() { return note_; }
  QCPColorMap* cells() { return cells_; }
  std::vector<QCPItemLine*>& arrows() { return arrows_; }

  std::size_t addSeries(PlotPanel::SeriesKind kind, const SeriesStyle& style);
  void setMarks(std::span<const PlotMark> marks);
  void setLevels(const std::vector<double>& y);
  std::vector<double> levels() const;
  void setCursorLine(std::optional<double> x);
  void setThreshold(std::optional<double> y);
  std::optional<double> threshold() const;
  void restyle(const QFont& font);
  void fit(const QCPRange& x_within = QCPRange());  // empty: all data
  void keepScale();                                 // equal scale of x and y, if requested
  void zoomX(double factor);
  void panX(double share);

 signals:
  void clicked(double x, double y);
  void thresholdDragged(double y);

 protected:
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void leaveEvent(QEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  struct Mark {
    QCPItemStraightLine* line;
    QCPItemText* label;
  };
  QCPItemStraightLine* addLine(bool vertical);
  void addHeading();
  void addOverlay();
  void styleAxes(const QFont& font);
  void styleSeries(const SeriesItems& items);
  void styleOverlay(const QFont& font);
  bool overThreshold(const QPointF& pixel) const;
  void showReadout(const QPointF& pixel);
  void hideReadout();
  QString readoutAt(double x, double y) const;
  void toggle(QCPAbstractLegendItem* item);

  PlotAxes axes_;
  QCPTextElement* title_ = nullptr;
  QCPTextElement* note_ = nullptr;
  QCPColorMap* cells_ = nullptr;
  std::vector<QCPItemLine*> arrows_;
  std::vector<Mark> marks_;
  std::vector<QCPItemStraightLine*> levels_;
  QCPItemStraightLine* cursor_ = nullptr;
  QCPItemStraightLine* hover_ = nullptr;
  QCPItemStraightLine* threshold_ = nullptr;
  QCPItemText* readout_ = nullptr;
  // For charts with equal scales: the requested range, and the one adjusted by keepScale().
  QCPRange wanted_x_, wanted_y_, kept_x_, kept_y_;
  QSize kept_pixels_;
  QPointF pressed_at_;
  bool dragging_threshold_ = false;
};

}  // namespace evical::ui
