// SPDX-License-Identifier: GPL-3.0-or-later
// Where a result goes and which programs it is exported for, a line about each. Kalibr's files are always written.
#pragma once

#include "core/pipeline/session/session.h"

#include <QDialog>

#include <string>
#include <vector>

class QCheckBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QTreeWidget;

namespace evical::ui {

struct ExportRequest {
  QString folder;
  std::vector<std::string> targets;  // in the table's order, kalibr too
  bool check = false;                // read the files back, and hold them against the result
};

// Beside the recording, or at home where nobody may write there: <recording>_calibration, with a number where that is
// there already.
QString newExportFolder(const QString& recording);
QString newResultFolder(const QString& recording, const QString& kind);  // <recording>_<kind>

// With the targets that the session asks for; where it asks for none, those of the last export.
ExportRequest proposedExport(const Session& session);
void rememberExport(const ExportRequest& request);

class ExportDialog : public QDialog {
  Q_OBJECT

 public:
  ExportDialog(const ExportRequest& proposal, QWidget* parent);

  ExportRequest request() const;

 private:
  enum class Selection { All, Odometry, None };

  void fillTargets(const std::vector<std::string>& chosen);
  QWidget* makeFolderRow();
  QWidget* makeSelectionRow();
  void select(Selection selection);
  void chooseFolder();
  void judgeFolder();

  QLineEdit* folder_;
  QLabel* hint_;
  QTreeWidget* targets_;
  QCheckBox* check_;
  QPushButton* ok_ = nullptr;
};

}  // namespace evical::ui
