// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses the board in the form by name, adds one, removes one. A single board needs no choice.
#pragma once

#include <QStringList>
#include <QWidget>

#include <cstddef>
#include <set>

class QTabBar;
class QToolButton;

namespace evical::ui {

class BoardChooser : public QWidget {
  Q_OBJECT

 public:
  explicit BoardChooser(QWidget* parent = nullptr);

  void setBoards(const QStringList& names, std::size_t chosen);
  // Boards with a problem.
  void setWrong(const std::set<std::size_t>& wrong);
  // Reason why no board can be added; empty: one can.
  void setFull(const QString& why);

 signals:
  void chosen(std::size_t index);
  void addRequested();
  void removeRequested();  // of the chosen board

 private:
  QTabBar* tabs_;
  QToolButton *add_, *remove_;
};

}  // namespace evical::ui
