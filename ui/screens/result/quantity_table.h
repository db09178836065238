// SPDX-License-Identifier: GPL-3.0-or-later
// A result's quantities, a group a sensor. The names are always whole: where all columns find no room, it scrolls.
// Rows are copied whole, with their header (Ctrl+C), or all of them (context menu).
#pragma once

#include "ui/screens/result/result_parameters.h"

#include <QTreeWidget>

#include <vector>

class QMenu;

namespace evical::ui {

class QuantityTable : public QTreeWidget {
  Q_OBJECT

 public:
  enum Column { kQuantity, kValue, kSigma, kUnit, kDifference, kSigmas, kColumns };

  explicit QuantityTable(QWidget* parent = nullptr);

  void setGroups(std::vector<ParameterGroup> groups, bool compared);
  void addToContextMenu(QMenu* menu);  // behind its own entries

  // As tabbedText; of a heading that is selected all rows. Empty where nothing is.
  QString selectedText() const;
  QString allText() const;

 protected:
  void contextMenuEvent(QContextMenuEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;

 private:
  void fitColumns();
  void widenNames();
  void copySelected();

  std::vector<ParameterGroup> groups_;
  QMenu* further_ = nullptr;
  int names_px_ = 0;  // that all of them need
};

}  // namespace evical::ui
