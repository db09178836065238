// SPDX-License-Identifier: GPL-3.0-or-later
// A table whose rows are copied whole, with their header, as spreadsheets take them (Ctrl+C, or the context menu).
#pragma once

#include <QTreeWidget>

namespace evical::ui {

class CopyTable : public QTreeWidget {
  Q_OBJECT

 public:
  explicit CopyTable(QWidget* parent = nullptr);

  QString selectedText() const;  // empty where nothing is
  QString allText() const;

  // To what headers and cells need; the first column also has what the others leave.
  void fitColumns();

  // Columns [first, end) of the row and of those below it to the right, as numbers are read.
  static void alignNumbers(QTreeWidgetItem& item, int first, int end);

 protected:
  void contextMenuEvent(QContextMenuEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  QString rowsText(bool only_selected) const;
  void copySelected();
  void widenFirst();

  int first_px_ = 0;  // that its cells need
};

}  // namespace evical::ui
