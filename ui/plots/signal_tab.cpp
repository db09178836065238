// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/signal_tab.h"

#include <QStackedWidget>
#include <QVBoxLayout>

#include <cmath>

namespace evical::ui {
namespace {

using Kind = PlotPanel::SeriesKind;

constexpr PlotColour kSignalColours[] = {PlotColour::X, PlotColour::Y, PlotColour::Z};
const QString kSignalNames[] = {"x", "y", "z"};
constexpr double kSignalMsPerS = 1e3;
constexpr double kNineteenOfTwenty_sigmas = 1.96;

// After a panel's own series: the level of the given noise.
void addBounds(PlotPanel& panel) {
  for (int edge = 0; edge < 2; ++edge)
    panel.addSeries(Kind::Line, {.colour = PlotColour::Text, .width_px = 1.4, .dashed = true});
}

void addAxes(PlotPanel& panel) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    panel.addSeries(Kind::Line,
                    {.name = kSignalNames[axis], .colour = kSignalColours[axis], .width_px = 1.4});
  addBounds(panel);
}

// Panels below each other share the time axis: the last one has the label.
PlotPanel* timePanel(const QString& title, const QString& unit, bool last) {
  return new PlotPanel(
      {.title = title, .x_label = last ? SignalTab::tr("time (s)") : "", .y_label = unit, .time = true});
}

}  // namespace

SignalTab::SignalTab(const QString& name, const QString& unit) : unit_(unit), below_(new QStackedWidget) {
  makeSignal(name);
  for (QWidget* const look : {makeResiduals(), makeSpectrum(), makeCorrelation()}) below_->addWidget(look);
  auto* const layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 8, 0, 0);
  layout->addWidget(signal_, 3);
  layout->addWidget(below_, 5);
}

QStringList SignalTab::looks() {
  return {tr("each axis over time"), tr("spectrum"), tr("autocorrelation")};
}

void SignalTab::lookAt(int look) {
  below_->setCurrentIndex(look);
}

// Measured lines are broad and pale, so that they are visible under the predicted ones.
void SignalTab::makeSignal(const QString& name) {
  signal_ = timePanel(name, unit_, false);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    signal_->addSeries(Kind::Line, {.name = kSignalNames[axis] + tr(" measured"),
                                    .colour = kSignalColours[axis],
                                    .width_px = 5.0,
                                    .opacity = 0.3,
                                    .in_legend = false});
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const PlotPanel::Series predicted = signal_->addSeries(
        Kind::Line,
        {.name = kSignalNames[axis] + tr(" predicted"), .colour = kSignalColours[axis], .width_px = 1.2});
    signal_->setLegendText(predicted, kSignalNames[axis]);
  }
  signal_->setNote(tr("broad: measured; thin: predicted by the trajectory"));
}

// Each axis has its own row: on top of each other only the last one would be visible.
QWidget* SignalTab::makeResiduals() {
  auto* const rows = new QWidget;
  auto* const layout = new QVBoxLayout(rows);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    PlotPanel* const row =
        timePanel(tr("Measured - predicted, %1").arg(kSignalNames[axis]), unit_, axis == 2);
    row->addSeries(Kind::Line,
                   {.name = kSignalNames[axis], .colour = kSignalColours[axis], .in_legend = false});
    addBounds(*row);
    layout->addWidget(row, axis == 2 ? 6 : 5);
    residuals_[axis] = row;
  }
  return rows;
}

QWidget* SignalTab::makeSpectrum() {
  spectrum_ = new PlotPanel({.title = tr("Spectrum"),
                             .x_label = tr("frequency (Hz)"),
                             .y_label = unit_ + "/\u221aHz",
                             .logarithmic_y = true});
  spectrum_->setObjectName("spectrum");
  addAxes(*spectrum_);
  return spectrum_;
}

QWidget* SignalTab::makeCorrelation() {
  correlation_ = new PlotPanel(
      {.title = tr("Autocorrelation"), .x_label = tr("lag (ms)"), .y_label = tr("correlation")});
  correlation_->setObjectName("autocorrelation");
  addAxes(*correlation_);
  return correlation_;
}

std::vector<PlotPanel*> SignalTab::overTime() const {
  return {signal_, residuals_[0], residuals_[1], residuals_[2]};
}

void SignalTab::setLines(const SignalLines& lines) {
  const std::vector<double> span_s = {lines.begin_s, lines.end_s};
  const double sigma = lines.density * std::sqrt(lines.rate_hz);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    signal_->setLine(axis, lines.measured[axis]);
    signal_->setLine(3 + axis, lines.predicted[axis]);
    PlotPanel& row = *residuals_[axis];
    row.setLine(0, lines.residual[axis]);
    row.setData(1, span_s, {-sigma, -sigma});
    row.setData(2, span_s, {sigma, sigma});
    row.setNote(tr("RMS %1 %3, given noise %2 %3 (dashed)")
                    .arg(lines.statistics[axis].rms, 0, 'g', 3)
                    .arg(sigma, 0, 'g', 3)
                    .arg(unit_));
  }
  showStatistics(lines);
}

void SignalTab::showStatistics(const SignalLines& lines) {
  std::vector<double> apart_ms;
  for (int lag = 0; lag <= kShownLags; ++lag)
    apart_ms.push_back(lines.rate_hz > 0.0 ? kSignalMsPerS * lag / lines.rate_hz : 0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const AxisStatistics& own = lines.statistics[axis];
    spectrum_->setData(axis, own.spectrum.frequency_hz, own.spectrum.density);
    correlation_->setData(axis, apart_ms, own.correlation);
  }
  spectrum_->setData(3, {0.0, 0.5 * lines.rate_hz}, {lines.density, lines.density});
  spectrum_->setNote(lines.statistics[0].spectrum.density.empty()
                         ? tr("too few samples for a spectrum")
                         : tr("of measured - predicted; dashed: given noise density"));
  const double bound =
      lines.samples > 0 ? kNineteenOfTwenty_sigmas / std::sqrt(static_cast<double>(lines.samples)) : 0.0;
  const std::vector<double> ends_ms = {apart_ms.front(), apart_ms.back()};
  correlation_->setData(3, ends_ms, {-bound, -bound});
  correlation_->setData(4, ends_ms, {bound, bound});
  correlation_->setNote(tr("of measured - predicted; dashed: 95 % limits of white noise"));
  for (PlotPanel* const panel : {spectrum_, correlation_}) panel->fit();
}

}  // namespace evical::ui

namespace evical::ui {
namespace {

constexpr int kSegment = 1024, kShortestSegment = 64;  // samples of a spectrum's segments

double component(const Eigen::Vector3d& v, std::size_t axis) {
  return v[static_cast<Eigen::Index>(axis)];
}

AxisStatistics statisticsOf(const std::vector<double>& residual, double rate_hz) {
  AxisStatistics statistics;
  int segment = kSegment;
  while (segment > kShortestSegment && 4 * static_cast<std::size_t>(segment) > residual.size()) segment /= 2;
  statistics.spectrum = noiseSpectrum(residual, rate_hz, segment);
  statistics.correlation = autocorrelation(residual, kShownLags);
  double sum = 0.0;
  for (const double r : residual) sum += r * r;
  if (!residual.empty()) statistics.rms = std::sqrt(sum / static_cast<double>(residual.size()));
  return statistics;
}

}  // namespace

SignalLines makeSignalLines(const SensorSignal& signal, double rate_hz, double density) {
  const std::vector<double>& time_s = signal.time_s;
  SignalLines lines;
  lines.rate_hz = rate_hz;
  lines.density = density;
  lines.samples = time_s.size();
  if (!time_s.empty()) {
    lines.begin_s = time_s.front();
    lines.end_s = time_s.back();
  }
  std::vector<double> a(time_s.size()), b(time_s.size()), difference(time_s.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t k = 0; k < time_s.size(); ++k) {
      a[k] = component(signal.measured[k], axis);
      b[k] = component(signal.predicted[k], axis);
      difference[k] = a[k] - b[k];
    }
    lines.measured[axis] = makePlotLine(time_s, a);
    lines.predicted[axis] = makePlotLine(time_s, b);
    lines.residual[axis] = makePlotLine(time_s, difference);
    lines.statistics[axis] = statisticsOf(difference, rate_hz);
  }
  return lines;
}

}  // namespace evical::ui
