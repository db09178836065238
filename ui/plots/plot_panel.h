// SPDX-License-Identifier: GPL-3.0-or-later
// One chart in the program's colours and font: lines, points, bars, bands, cells and arrows, with title and
// legend above. Wheel zooms (Ctrl: y only; time charts: x only), drag pans, Shift and drag zooms into a box,
// double click or F fits, arrow keys pan, + and - zoom, a click on the legend hides a series, the context
// menu saves. Drawing a long line takes time by its pixels: only the first, lowest, highest and last sample
// of each pixel column are drawn.
#pragma once

#include "ui/jobs/file_saver.h"

#include <QPointF>
#include <QRectF>
#include <QString>
#include <QWidget>

#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace evical::ui {

enum class PlotColour { X, Y, Z, Accent, Good, Warning, Bad, Text, Faint };

struct SeriesStyle {
  QString name = {};  // in legend, readout and CSV; empty: only drawn
  PlotColour colour = PlotColour::Accent;
  double width_px = 1.0;  // width of lines, diameter of points
  double opacity = 1.0;
  bool dashed = false;
  bool in_legend = true;
};

struct PlotAxes {
  QString title = {}, x_label = {}, y_label = {};
  bool time = false;  // x is time: the wheel does not change y
  bool logarithmic_y = false;
  bool downward_y = false;   // as in images
  bool equal_scale = false;  // x and y have the same scale
  bool whole_x = false;      // x is an integer: no ticks in between
};

struct PlotMark {
  double x = 0.0;
  QString label;
};

struct PlotArrow {
  QPointF from, to;
};

// Values from 0 up, row by row, the first row at the smallest y; NaN is empty.
struct PlotCells {
  QRectF extent;
  int columns = 0, rows = 0;
  std::vector<double> values;
};

// Points of a long line, prepared in any thread.
struct PlotLineData;
std::shared_ptr<PlotLineData> makePlotLine(const std::vector<double>& x, const std::vector<double>& y);

class PlotChart;

class PlotPanel : public QWidget {
  Q_OBJECT

 public:
  explicit PlotPanel(const PlotAxes& axes, QWidget* parent = nullptr);

  enum class SeriesKind { Line, Points, Bars, Band, Outline };
  using Series = std::size_t;
  Series addSeries(SeriesKind kind, const SeriesStyle& style);
  // x ascending, except for outlines and points. NaN interrupts lines.
  void setData(Series series, const std::vector<double>& x, const std::vector<double>& y);
  void setLine(Series series, const std::shared_ptr<PlotLineData>& line);  // takes no time
  void setBand(Series series, const std::vector<double>& x, const std::vector<double>& low,
               const std::vector<double>& high);
  void setBarWidth(Series series, double width);
  void setCells(const PlotCells& cells, PlotColour colour);
  void setArrows(std::span<const PlotArrow> arrows, PlotColour colour);
  void setMarks(std::span<const PlotMark> marks);  // vertical lines with a label
  // Horizontal lines for comparison; they may be outside the shown range.
  void setLevels(const std::vector<double>& y);
  std::vector<double> levels() const;
  void clear();  // data, cells, arrows, marks and levels; series stay
  void setTitle(const QString& title);
  void setLegendText(Series series, const QString& text);  // the name is unchanged elsewhere
  void setYLabel(const QString& label);
  void setNote(const QString& note);  // next to the title, faint; for summarising numbers

  void fit();
  void fitWithin(double x_low, double x_high);  // y from the data in between
  void setXRange(double low, double high);
  std::pair<double, double> xRange() const;
  std::pair<double, double> yRange() const;
  void setYRange(double low, double high);
  static void linkX(const std::vector<PlotPanel*>& panels);

  void setCursorLine(std::optional<double> x);
  void setThreshold(std::optional<double> y);  // a horizontal line that can be dragged
  std::optional<double> threshold() const;

  QPointF pixelAt(double x, double y) const;  // in this widget
  // Files: pictures, and the points as a table. A picture of several panels has their layout on `page`.
  std::vector<SavedForm> savedForms();
  static std::vector<SavedForm> pictureForms(const std::vector<PlotPanel*>& panels, const QWidget& page);
  QString csv() const;  // series, x, y: one line per point; cells and arrows if any
  QString title() const;
  void redraw();  // immediately; changes are otherwise drawn soon

 signals:
  void clicked(double x, double y);  // not after a drag
  void thresholdDragged(double y);

 protected:
  void changeEvent(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;

 private:
  struct Table;
  Table table() const;
  static QString textOf(const Table& table);

  PlotChart* chart_;
  FileSaver* saver_;
};

}  // namespace evical::ui
