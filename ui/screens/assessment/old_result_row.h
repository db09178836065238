// SPDX-License-Identifier: GPL-3.0-or-later
// Row for an old result in a form: a folder, a file, or one of the session's runs.
#pragma once

#include "ui/screens/assessment/path_row.h"

#include <utility>
#include <vector>

namespace evical::ui {

class OldResultRow : public PathRow {
  Q_OBJECT

 public:
  OldResultRow(const QString& object_name, QGridLayout& grid, QWidget* parent);

  // By title and folder; listed after the entries for files, and shown by their titles.
  void setKeptRuns(const std::vector<std::pair<QString, QString>>& runs);

 signals:
  void folderRequested();
  void fileRequested();

 private:
  QMenu* menu_;
};

}  // namespace evical::ui
