// SPDX-License-Identifier: GPL-3.0-or-later
// Table of a result's quantities, one group per sensor. Names are never elided: the table scrolls instead.
// Copies whole rows with their header (Ctrl+C), or all of them (context menu).
#pragma once

#include "ui/screens/result/result_parameters.h"

#include <QTreeWidget>

#include <map>
#include <vector>

class QMenu;

namespace evical::ui {

class QuantityTable : public QTreeWidget {
  Q_OBJECT

 public:
  enum Column { kQuantity, kValue, kSigma, kUnit, kDifference, kSigmas, kColumns };

  explicit QuantityTable(QWidget* parent = nullptr);

  void setGroups(std::vector<ParameterGroup> groups, bool compared);
  void addToContextMenu(QMenu* menu);  // after its other entries

  // Formatted by tabbedText; for a selected heading all its rows. Empty without a selection.
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
  std::map<QString, bool> folded_;  // by title, as the user chose
  QMenu* further_ = nullptr;
  int names_px_ = 0;  // width of the longest name
};

}  // namespace evical::ui
