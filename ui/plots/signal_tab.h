// SPDX-License-Identifier: GPL-3.0-or-later
// One sensor's signal, measured and predicted by axis, and below it one of three views of the residual: each
// axis over time, the spectrum, the autocorrelation.
#pragma once

#include <QWidget>

#include <array>
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

}  // namespace evical::ui
