// SPDX-License-Identifier: GPL-3.0-or-later
// Change of each quantity since an old result, with its numbers below it, and the changes during the logs.
#pragma once

#include "core/data/assessment.h"

#include <QTreeWidget>

#include <vector>

// Table that copies whole rows with their header, in a form for spreadsheets (Ctrl+C, or the context menu).

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

class FindingTable : public CopyTable {
  Q_OBJECT

 public:
  enum Column {
    kQuantity,
    kVerdict,
    kSource,
    kChange,
    kBefore,
    kNow,  // the columns up to here are visible at 1280 px
    kTest,
    kEdge,
    kDetectable,
    kColumns
  };

  explicit FindingTable(QWidget* parent = nullptr);

  void setFindings(std::vector<Finding> findings);

 protected:
  void changeEvent(QEvent* event) override;
  bool copies(int column) const override;

 private:
  void fill();
  void showNumberColumns();

  std::vector<Finding> findings_;
};

class StepTable : public CopyTable {
  Q_OBJECT

 public:
  enum Column { kWhat, kAt, kNoticed, kBy, kAlternatives, kColumns };

  explicit StepTable(QWidget* parent = nullptr);

  void setSteps(const std::vector<MaintenanceStep>& steps);
};

// "0.5 ± 0.1 deg"
QString changeText(const Finding& finding);

}  // namespace evical::ui
