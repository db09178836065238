// SPDX-License-Identifier: GPL-3.0-or-later
// Table that copies whole rows with their header, in a form for spreadsheets (Ctrl+C, or the context menu).
#pragma once

#include <QTreeWidget>

namespace evical::ui {

class CopyTable : public QTreeWidget {
  Q_OBJECT

 public:
  explicit CopyTable(QWidget* parent = nullptr);

  QString selectedText() const;  // empty without a selection
  QString allText() const;

  // Fits headers and cells; the first column also gets the remaining width.
  void fitColumns();

  // Right-aligns columns [first, end) of the row and of its children, as is usual for numbers.
  static void alignNumbers(QTreeWidgetItem& item, int first, int end);

 protected:
  void contextMenuEvent(QContextMenuEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  virtual bool copies(int column) const { return !isColumnHidden(column); }
  void widenFirst();

 private:
  QString rowsText(bool only_selected) const;
  void copySelected();

  int first_px_ = 0;  // width of its cells
};

}  // namespace evical::ui
