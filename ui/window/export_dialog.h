// SPDX-License-Identifier: GPL-3.0-or-later
// Which programs a result is exported for: a list with a check box each. Kalibr's files are always written.
#pragma once

#include <QDialog>

#include <string>
#include <vector>

class QListWidget;

namespace evical::ui {

class ExportDialog : public QDialog {
  Q_OBJECT

 public:
  ExportDialog(const std::vector<std::string>& chosen, QWidget* parent);

  std::vector<std::string> chosen() const;  // in the table's order, kalibr too

 private:
  QListWidget* list_;
};

}  // namespace evical::ui
