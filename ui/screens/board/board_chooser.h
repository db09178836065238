// SPDX-License-Identifier: GPL-3.0-or-later
// Which of the session's boards the form shows, by name; one more, one less. One alone needs no choice.
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
  // Those with which something is wrong.
  void setWrong(const std::set<std::size_t>& wrong);
  // Why there cannot be one more; empty: there can.
  void setFull(const QString& why);

 signals:
  void chosen(std::size_t index);
  void addRequested();
  void removeRequested();  // of the one that is chosen

 private:
  QTabBar* tabs_;
  QToolButton *add_, *remove_;
};

}  // namespace evical::ui
