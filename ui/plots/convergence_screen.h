// SPDX-License-Identifier: GPL-3.0-or-later
// Convergence of the optimiser: cost, gradient, step and each camera's parameters by iteration, with the
// borders of stages, the parameters that each stage frees, the needed accuracy and, after the run, the band
// of plus and minus one sigma.
#pragma once

#include "core/data/calibration_result.h"
#include "core/pipeline/rig/calibration_pipeline.h"

#include <QString>
#include <QWidget>

#include <memory>
#include <optional>
#include <vector>

class QComboBox;
class QLabel;
class QStackedLayout;
class QTimer;

namespace evical::ui {

class PlotPanel;

// Accuracy that the verdict requires.
struct NeededAccuracy {
  double rotation_deg = 0.0, translation_mm = 0.0, time_offset_ms = 0.0;
};

class ConvergenceScreen : public QWidget {
  Q_OBJECT

 public:
  explicit ConvergenceScreen(QWidget* parent = nullptr);

  void setRun(std::shared_ptr<const CalibrationRun> run);  // null: like clear()
  void setNeeded(const std::optional<NeededAccuracy>& needed);
  void appendIteration(const IterationRecord& record);  // during a run; drawn soon
  void clear();

 private:
  enum class Relative { ToFinal, ToFirst };
  enum class Shown { All, LastStage };
  enum Panel { Cost, Gradient, Step, Rotation, Translation, TimeOffset, kPanels };
  struct ParameterPanel {
    std::vector<std::size_t> lines, points, bands;
  };

  QWidget* makeBar();
  QWidget* makeContent();
  void addParameterSeries(Panel panel, const QStringList& names);
  void showStages();
  void listCameras();
  void drawSoon();
  void draw();
  void drawProgress();
  void drawParameters();
  void drawBands(std::size_t camera);
  void drawNeeds();
  void fitAll();
  std::vector<double> differences(Panel panel, int axis, std::size_t camera) const;
  double sigma(Panel panel, int axis, std::size_t camera) const;

  std::shared_ptr<const CalibrationRun> run_;
  std::vector<IterationRecord> iterations_;
  std::optional<NeededAccuracy> needed_;
  std::vector<PlotPanel*> panels_;
  ParameterPanel series_[kPanels];
  QStackedLayout* stack_ = nullptr;
  QComboBox *camera_ = nullptr, *relative_ = nullptr, *shown_ = nullptr;
  QLabel *camera_label_ = nullptr, *summary_ = nullptr, *stages_ = nullptr;
  QTimer* redraw_ = nullptr;
};

// Stages of the optimisation as text.
struct StageWords {
  QString name;  // "Stage 2: + 1 quantity"
  QString help;  // "Stage 2: + gyroscope scale and misalignment"
};
std::vector<StageWords> stageWords(const std::vector<IterationRecord>& iterations);

QString stagesHelp();  // reason for the jump of the cost between stages
QString neededHelp();  // lines and bands in the charts of parameters

}  // namespace evical::ui
