// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/maintenance_charts.h"

#include "core/report/assessment_report.h"
#include "ui/plots/plot_panel.h"

#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QScrollArea>

#include <algorithm>
#include <array>
#include <limits>

namespace evical::ui {
namespace {

constexpr std::array kColours = {PlotColour::X, PlotColour::Y, PlotColour::Z};
constexpr int kColumns = 2;

QString text(const std::string& of_core) {
  return QString::fromStdString(of_core);
}

QString titleOf(const TrackedQuantity& quantity) {
  QString title = text(quantity.title);
  if (!title.isEmpty()) title[0] = title[0].toUpper();
  return title;
}

QString titleOf(const MaintenanceTrack& track) {
  return track.against.empty() ? QObject::tr("%1 over time").arg(text(track.sensor))
                               : QObject::tr("%1 against %2").arg(text(track.sensor), text(track.against));
}

void addNumber(PlotPanel& panel, const MaintenanceTrack& track, const TrackedNumber& number,
               PlotColour colour) {
  std::vector<double> low, high;
  for (std::size_t k = 0; k < number.values.size(); ++k) {
    low.push_back(number.values[k] - number.sigmas[k]);
    high.push_back(number.values[k] + number.sigmas[k]);
  }
  const auto band = panel.addSeries(PlotPanel::SeriesKind::Band, {.colour = colour, .opacity = 0.18});
  panel.setBand(band, track.times_s, low, high);
  const QString name = number.name.empty() ? QObject::tr("difference") : text(number.name);
  const auto line =
      panel.addSeries(PlotPanel::SeriesKind::Line, {.name = name, .colour = colour, .width_px = 1.4});
  panel.setData(line, track.times_s, number.values);
}

// Excludes moments with large sigmas, at the start and after changes, which would compress the scale.
void fitToMost(PlotPanel& panel, const MaintenanceTrack& track, const TrackedQuantity& quantity) {
  constexpr double kLeftOut = 0.04, kMargin = 0.06;
  std::vector<double> low, high;
  for (const TrackedNumber& number : quantity.numbers)
    for (std::size_t k = 0; k < track.times_s.size(); ++k) {
      low.push_back(number.values[k] - number.sigmas[k]);
      high.push_back(number.values[k] + number.sigmas[k]);
    }
  if (low.empty()) return;
  const auto left_out = static_cast<std::ptrdiff_t>(kLeftOut * static_cast<double>(low.size()));
  std::nth_element(low.begin(), low.begin() + left_out, low.end());
  std::nth_element(high.begin(), high.end() - 1 - left_out, high.end());
  const double bottom = low[static_cast<std::size_t>(left_out)], top = *(high.end() - 1 - left_out),
               margin = kMargin * (top - bottom);
  panel.setXRange(track.times_s.front(), track.times_s.back());
  if (top > bottom) panel.setYRange(bottom - margin, top + margin);
}

// Error bars of one sigma to either side.
struct StopBars {
  std::vector<double> middles_s, residuals, times_s, ends;

  void add(const MaintainedStop& stop) {
    constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
    const double middle_s = 0.5 * (stop.from_s + stop.to_s);
    middles_s.push_back(middle_s);
    residuals.push_back(stop.residual_m_s2);
    times_s.insert(times_s.end(), {middle_s, middle_s, middle_s});
    ends.insert(ends.end(),
                {stop.residual_m_s2 - stop.sigma_m_s2, stop.residual_m_s2 + stop.sigma_m_s2, kBreak});
  }
  void show(PlotPanel& panel, const QString& name, PlotColour colour) const {
    const auto bars = panel.addSeries(PlotPanel::SeriesKind::Outline, {.colour = colour, .width_px = 1.4});
    panel.setData(bars, times_s, ends);
    const auto points =
        panel.addSeries(PlotPanel::SeriesKind::Points, {.name = name, .colour = colour, .width_px = 6.0});
    panel.setData(points, middles_s, residuals);
  }
};

}  // namespace

MaintenanceCharts::MaintenanceCharts(QWidget* parent)
    : QWidget(parent), what_(new QComboBox(this)), grid_(new QGridLayout) {
  what_->setObjectName("maintained_over_time");
  what_->setToolTip(tr("Two IMUs, sections of the trajectory, or the stops of one IMU"));
  what_->setSizeAdjustPolicy(QComboBox::AdjustToContents);
  auto* const label = new QLabel(tr("Sho&w"), this);
  label->setBuddy(what_);
  auto* const bar = new QHBoxLayout;
  bar->addWidget(label);
  bar->addWidget(what_);
  bar->addStretch(1);
  auto* const scroll = new QScrollArea(this);
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  auto* const content = new QWidget(scroll);
  grid_->setContentsMargins(0, 0, 0, 0);
  content->setLayout(grid_);
  scroll->setWidget(content);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 6, 0, 0);
  layout->addLayout(bar);
  layout->addWidget(scroll, 1);
  connect(what_, &QComboBox::currentIndexChanged, this, &MaintenanceCharts::show);
}

void MaintenanceCharts::setMaintenance(const Maintenance& maintenance) {
  const QSignalBlocker blocker(what_);
  maintenance_ = maintenance;
  what_->clear();
  stopped_.clear();
  for (const MaintenanceTrack& track : maintenance_.tracks) what_->addItem(titleOf(track));
  for (const MaintainedImu& imu : maintenance_.imus) {
    if (imu.stops.empty()) continue;
    stopped_.push_back(&imu);
    what_->addItem(tr("Stops of %1").arg(text(imu.name)));
  }
  what_->setEnabled(what_->count() > 0);
  show(what_->currentIndex());
}

PlotPanel* MaintenanceCharts::addPanel(const QString& title, const QString& unit) {
  constexpr int kMin_px = 150;
  auto* const panel =
      new PlotPanel({.title = title, .x_label = tr("time (s)"), .y_label = unit, .time = true});
  panel->setMinimumHeight(kMin_px);
  const int place = static_cast<int>(panels_.size());
  grid_->addWidget(panel, place / kColumns, place % kColumns);
  panels_.push_back(panel);
  return panel;
}

void MaintenanceCharts::show(int choice) {
  for (PlotPanel* const panel : panels_) delete panel;
  panels_.clear();
  if (choice < 0) return;
  const auto index = static_cast<std::size_t>(choice);
  if (index < maintenance_.tracks.size())
    showTrack(maintenance_.tracks[index]);
  else
    showStops(*stopped_.at(index - maintenance_.tracks.size()));
  PlotPanel::linkX(panels_);
}

void MaintenanceCharts::showTrack(const MaintenanceTrack& track) {
  std::vector<PlotMark> marks;
  for (const MaintenanceStep& step : maintenance_.steps)
    if (isIn(step, track)) marks.push_back({step.at_s, text(step.title)});
  for (const TrackedQuantity& quantity : track.quantities) {
    PlotPanel* const panel =
        addPanel(titleOf(quantity), text(shownUnit(quantity.unit)).replace("^2", QChar(0xb2)));
    for (std::size_t k = 0; k < quantity.numbers.size(); ++k)
      addNumber(*panel, track, quantity.numbers[k], kColours[k % kColours.size()]);
    panel->setLevels({0.0});
    panel->setMarks(marks);
    fitToMost(*panel, track, quantity);
  }
}

void MaintenanceCharts::showStops(const MaintainedImu& imu) {
  StopBars used, left_out;
  for (const MaintainedStop& stop : imu.stops) (stop.used ? used : left_out).add(stop);
  PlotPanel* const panel =
      addPanel(tr("Residual of gravity's norm at stops, %1").arg(text(imu.name)), "m/s\u00b2");
  used.show(*panel, tr("used"), PlotColour::Good);
  if (!left_out.middles_s.empty()) left_out.show(*panel, tr("contradict the others"), PlotColour::Bad);
  panel->setLevels({0.0});
  panel->fit();
}

}  // namespace evical::ui
