// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/signal_lines.h"

#include <cmath>

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
