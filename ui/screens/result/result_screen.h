// SPDX-License-Identifier: GPL-3.0-or-later
// Result: numbers, their uncertainty, and the evidence for them; compared with another run or the truth.
#pragma once

#include "core/report/result_yaml.h"

#include <QWidget>

#include <optional>
#include <utility>
#include <vector>

class QComboBox;

class QLabel;
class QListWidget;
class QPushButton;

class QMenu;
class QStackedWidget;

namespace evical::ui {

class CorrelationView;
class ObservabilityView;
class PosePanel;
class QuantityTable;
class RepairButton;

class ResultScreen : public QWidget {
  Q_OBJECT

 public:
  explicit ResultScreen(QWidget* parent = nullptr);

  void setResult(std::optional<NamedResult> result);
  // Sets both after a run.
  void setRuns(std::optional<NamedResult> previous, std::optional<NamedResult> result);
  void setPrevious(std::optional<NamedResult> previous);
  void setReference(std::optional<NamedResult> reference, const QString& title);
  // Other runs of the session for the comparison: title and folder.
  void setKeptRuns(const std::vector<std::pair<QString, QString>>& runs);
  void setCalibrating(bool calibrating);  // during the first run
  void setOutdated(bool outdated);        // the session has changed since this result
  QMenu* copyMenu() const;                // copies poses; also part of the window's menus

 signals:
  void exportRequested();
  void reportRequested();
  void referenceRequested();
  void keptRunRequested(const QString& folder);  // for the comparison
  void calibrateRequested();
  void repairRequested(const evical::Repair& repair);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  enum class Against { Nothing, Previous, Reference };

  QWidget* makeEmpty();
  QWidget* makeContent();
  QWidget* makeHeader();
  QWidget* makeSides();
  void showVerdict();
  void showParameters();
  void showDetails();
  void offerComparisons();
  const NamedResult* compared() const;

  std::optional<NamedResult> result_, previous_, reference_;
  QString reference_title_;
  std::vector<std::pair<QString, QString>> kept_runs_;
  QStackedWidget* stack_;
  QLabel* none_yet_;
  QPushButton* calibrate_;
  QLabel *icon_, *verdict_, *reason_, *fit_, *outdated_, *comparison_, *observed_, *pairs_;
  RepairButton* repair_;
  QComboBox* against_;
  QuantityTable* parameters_;
  PosePanel* pose_;
  ObservabilityView* observability_;
  CorrelationView* correlation_;
  QListWidget* notes_;
};

}  // namespace evical::ui
