// SPDX-License-Identifier: GPL-3.0-or-later
// One sensor's signal, measured and predicted by axis, and below it one of three views of the residual: each
// axis over time, the spectrum, the autocorrelation.
#pragma once

#include "ui/plots/plot_panel.h"

#include "core/numerics/spectrum.h"
#include "core/report/residual_statistics.h"

#include <QWidget>

#include <array>
#include <memory>
#include <vector>

class QStackedWidget;

namespace evical::ui {

class PlotPanel;
struct SignalLines;

class SignalTab : public QWidget {
  Q_OBJECT

 public:
  SignalTab(const QString& name, const QString& unit);

  void setLines(const SignalLines& lines);
  void lookAt(int look);
  static QStringList looks();

  PlotPanel* signal() const { return signal_; }
  std::vector<PlotPanel*> overTime() const;  // panels with time as x

 private:
  void makeSignal(const QString& name);
  QWidget* makeResiduals();
  QWidget* makeSpectrum();
  QWidget* makeCorrelation();
  void showStatistics(const SignalLines& lines);

  QString unit_;
  PlotPanel *signal_ = nullptr, *spectrum_ = nullptr, *correlation_ = nullptr;
  std::array<PlotPanel*, 3> residuals_{};
  QStackedWidget* below_;
};

// An IMU's measured signal, its prediction by a trajectory, and the residual: prepared for drawing in any
// thread.

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
