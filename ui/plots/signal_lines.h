// SPDX-License-Identifier: GPL-3.0-or-later
// An IMU's measured signal, its prediction by a trajectory, and the residual: prepared for drawing in any
// thread.
#pragma once

#include "core/numerics/spectrum.h"
#include "core/report/signal_prediction.h"
#include "ui/plots/plot_panel.h"

#include <array>
#include <memory>
#include <vector>

namespace evical::ui {

inline constexpr int kShownLags = 100;  // samples, of autocorrelations

// Whiteness of one axis' residual.
struct AxisStatistics {
  NoiseSpectrum spectrum;
  std::vector<double> correlation;
  double rms = 0.0;
};

struct SignalLines {
  std::array<std::shared_ptr<PlotLineData>, 3> measured, predicted, residual;  // x, y, z
  std::array<AxisStatistics, 3> statistics;
  std::size_t samples = 0;
  double begin_s = 0.0, end_s = 0.0;
  double rate_hz = 0.0, density = 0.0;  // given noise density, unit per sqrt(Hz)
};

SignalLines makeSignalLines(const SensorSignal& signal, double rate_hz, double density);

}  // namespace evical::ui
