// SPDX-License-Identifier: GPL-3.0-or-later
// List of a session's runs: opens, compares, renames and deletes them.
#pragma once

#include "core/pipeline/runs/saved_run.h"

#include <QString>
#include <QWidget>

#include <filesystem>
#include <vector>

class QLabel;
class QPushButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace evical::ui {

// Title of a run: its name, or its date.
QString titleOf(const RunSummary& run);

class RunsPanel : public QWidget {
  Q_OBJECT

 public:
  explicit RunsPanel(QWidget* parent = nullptr);

  // Oldest first; `shown`: the folder of the run on the pages, empty if it is not stored.
  void setRuns(std::vector<RunSummary> runs, const std::filesystem::path& shown);
  void setPlace(const QString& place);  // the runs' folder, shown below the list
  void setBusy(bool busy);              // a running job blocks opening

 signals:
  void openRequested(const QString& folder);
  // Shows the first run, compared with the second. An empty first one: the run already shown.
  void comparisonRequested(const QString& folder, const QString& with_folder);
  void renameRequested(const QString& folder, const QString& name);
  void deletionRequested(const QStringList& folders);

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void fill();
  void offer();
  QStringList chosen() const;  // folders, in the list's order
  void openChosen();
  void compareChosen();
  void renameChosen();
  void deleteChosen();

  std::vector<RunSummary> runs_;
  std::filesystem::path shown_;
  bool busy_ = false;
  QTreeWidget* list_;
  QPushButton *open_, *compare_, *rename_, *delete_;
  QLabel* place_;
};

}  // namespace evical::ui
