// SPDX-License-Identifier: GPL-3.0-or-later
// Dialog for the folder of a result and the programs to export to, one line each: the common ones, and the
// others below "More". Kalibr's files are always written.
#pragma once

#include "core/pipeline/session/session.h"

#include <QDialog>

#include <functional>
#include <string>
#include <vector>

class QCheckBox;
class QLabel;
class QLineEdit;
class QPushButton;
class QTreeWidget;
class QTreeWidgetItem;

namespace evical {

struct ExportTarget;
}

namespace evical::ui {

struct ExportRequest {
  QString folder;
  std::vector<std::string> targets;  // in the table's order, kalibr too
  bool check = false;                // read the files back, and compare them with the result
};

// <recording>_calibration next to the recording, or in the home folder if that is not writable; numbered if
// it exists.
QString newExportFolder(const QString& recording);
QString newResultFolder(const QString& recording, const QString& kind);  // <recording>_<kind>

// With the targets of the session; if it has none, those of the last export.
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
  int fitColumns();  // width of all columns
  QWidget* makeFolderRow();
  QWidget* makeSelectionRow();
  void select(Selection selection);
  void checkTargets(const std::function<bool(const ExportTarget&)>& wanted);
  void chooseFolder();
  void judgeFolder();

  QLineEdit* folder_;
  QLabel* hint_;
  QTreeWidget* targets_;
  std::vector<QTreeWidgetItem*> items_;  // in the order of exportTargets()
  QCheckBox* check_;
  QPushButton* ok_ = nullptr;
};

}  // namespace evical::ui
