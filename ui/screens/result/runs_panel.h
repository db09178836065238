// SPDX-License-Identifier: GPL-3.0-or-later
// The runs of a session as a list: opened, compared, named and deleted.
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

// What a person calls a run: its name, or when it was made.
QString titleOf(const RunSummary& run);

class RunsPanel : public QWidget {
  Q_OBJECT

 public:
  explicit RunsPanel(QWidget* parent = nullptr);

  // The oldest first; `shown`: the folder of the one that the pages show, empty where that is not kept.
  void setRuns(std::vector<RunSummary> runs, const std::filesystem::path& shown);
  void setPlace(const QString& place);  // where they are kept, said below the list
  void setBusy(bool busy);              // while something runs no other run is opened

 signals:
  void openRequested(const QString& folder);
  // Two runs: the first is to be shown, beside the second. An empty first one: the one that is shown already.
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
