// SPDX-License-Identifier: GPL-3.0-or-later
// Content of a panel as files: points as a table, pictures of one chart or of several.
#include "ui/plots/plot_chart.h"
#include "ui/plots/plot_panel.h"

#include <QPaintDevice>

#include <cmath>

namespace evical::ui {
namespace {

constexpr double kPictureScale = 2.0;  // pixels of a saved picture per screen pixel

QString quoted(const QString& name) {
  return name.contains(',') || name.contains('"') ? '"' + QString(name).replace('"', "\"\"") + '"' : name;
}

QString number(double value) {
  return QString::number(value, 'g', 12);
}

// Position of a panel's chart on the page.
QRect placeOn(const QWidget& page, const QWidget& chart) {
  return {chart.mapTo(&page, QPoint()), chart.size()};
}

void paintChart(PlotChart& chart, QCPPainter& painter, const QPoint& at) {
  painter.save();
  painter.translate(at);
  chart.toPainter(&painter, chart.width(), chart.height());
  painter.restore();
}

}  // namespace

// Shown data, copied in the GUI thread; the text is made in another.
struct PlotPanel::Table {
  struct Points {
    QString name;
    std::vector<double> x, y;
  };
  QString x_label, y_label;
  std::vector<Points> series;
  PlotCells cells;
  std::vector<PlotArrow> arrows;
};

PlotPanel::Table PlotPanel::table() const {
  Table table{chart_->xAxis->label(), chart_->yAxis->label(), {}, {}, {}};
  const auto take = [&](const QString& name, QCPAbstractPlottable* plottable) {
    const QCPPlottableInterface1D* const points = plottable->interface1D();
    const int count = points->dataCount();
    Table::Points taken{name, {}, {}};
    taken.x.reserve(static_cast<std::size_t>(count));
    taken.y.reserve(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) {
      taken.x.push_back(points->dataMainKey(k));
      taken.y.push_back(points->dataMainValue(k));
    }
    table.series.push_back(std::move(taken));
  };
  for (const PlotChart::SeriesItems& items : chart_->series) {
    if (items.style.name.isEmpty()) continue;
    if (items.low) take(items.style.name + " (low)", items.low);
    take(items.low ? items.style.name + " (high)" : items.style.name, items.plottable);
  }
  if (chart_->cells()->visible()) {
    const QCPColorMapData& map = *chart_->cells()->data();
    table.cells = {chart_->cells_extent, map.keySize(), map.valueSize(), {}};
    for (int row = 0; row < map.valueSize(); ++row)
      for (int column = 0; column < map.keySize(); ++column)
        table.cells.values.push_back(const_cast<QCPColorMapData&>(map).cell(column, row));
  }
  for (const QCPItemLine* const arrow : chart_->arrows())
    table.arrows.push_back({arrow->start->coords(), arrow->end->coords()});
  return table;
}

QString PlotPanel::textOf(const Table& table) {
  QString text = QStringLiteral("series,%1,%2").arg(quoted(table.x_label), quoted(table.y_label));
  const bool further = !table.cells.values.empty() || !table.arrows.empty();
  text += further ? ",value,to x,to y\n" : "\n";
  const QString no_more = further ? ",,,\n" : "\n";
  for (const Table::Points& points : table.series)
    for (std::size_t k = 0; k < points.x.size(); ++k)
      text += quoted(points.name) + ',' + number(points.x[k]) + ',' + number(points.y[k]) + no_more;
  const PlotCells& cells = table.cells;
  for (std::size_t k = 0; k < cells.values.size(); ++k) {
    if (std::isnan(cells.values[k])) continue;
    const auto column = static_cast<int>(k) % cells.columns, row = static_cast<int>(k) / cells.columns;
    const double x = cells.extent.left() + (column + 0.5) * cells.extent.width() / cells.columns,
                 y = cells.extent.top() + (row + 0.5) * cells.extent.height() / cells.rows;
    text += QStringLiteral("cell,%1,%2,%3,,\n").arg(number(x), number(y), number(cells.values[k]));
  }
  for (const PlotArrow& arrow : table.arrows)
    text +=
        QStringLiteral("arrow,%1,%2,,%3,%4\n")
            .arg(number(arrow.from.x()), number(arrow.from.y()), number(arrow.to.x()), number(arrow.to.y()));
  return text;
}

QString PlotPanel::csv() const {
  return textOf(table());
}

QString PlotPanel::title() const {
  return chart_->title()->text();
}

std::vector<SavedForm> PlotPanel::savedForms() {
  std::vector<SavedForm> forms = pictureForms({this}, *this);
  forms.push_back(
      {tr("Table"), "csv", [this] { return [shown = table()] { return textOf(shown).toUtf8(); }; }});
  return forms;
}

std::vector<SavedForm> PlotPanel::pictureForms(const std::vector<PlotPanel*>& panels, const QWidget& page) {
  QRect area;
  for (const PlotPanel* const panel : panels) area |= placeOn(page, *panel->chart_);
  const auto paint = [panels, &page, area](QPaintDevice& device) {
    QCPPainter painter(&device);
    painter.setModes(QCPPainter::pmVectorized | QCPPainter::pmNoCaching);
    for (const PlotPanel* const panel : panels)
      paintChart(*panel->chart_, painter, placeOn(page, *panel->chart_).topLeft() - area.topLeft());
  };
  return ui::pictureForms(area.size(), kPictureScale, paint);
}

}  // namespace evical::ui
