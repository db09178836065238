// SPDX-License-Identifier: GPL-3.0-or-later
// The session's boards: a form for the chosen one, and the cameras that see it.
#pragma once

#include "core/pipeline/session/session.h"

#include <QStringList>
#include <QWidget>

#include <cstddef>
#include <set>
#include <utility>
#include <vector>

class QTabBar;
class QToolButton;

namespace evical::ui {

class BoardChooser;
class BoardForm;

class BoardsForm : public QWidget {
  Q_OBJECT

 public:
  explicit BoardsForm(QWidget* parent = nullptr);

  void setSession(const Session& session);
  // By field: "board", "boards.tags", "boards.tags.rows".
  static bool isOfBoards(const QString& field) { return field.startsWith("board"); }
  void setProblems(const std::vector<std::pair<QString, QString>>& field_and_text);
  // Widget for the heading's line.
  QWidget* chooser() const;

 signals:
  void sessionEdited(const evical::Session& session, const QString& what, const QString& merge_key);

 private:
  void showChosen();
  void setBlinking(bool blinking);
  void choose(std::size_t index);
  void add();
  void remove();
  void rename(const QString& name);
  QString what(const QString& of_one, const QString& of_several) const;
  QString seenBy() const;
  QString mergeKey(const QString& field) const;

  Session session_;
  std::size_t chosen_ = 0;
  BoardChooser* chooser_;
  BoardForm* form_;
};

// Chooses the board in the form by name, adds one, removes one. A single board needs no choice.
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
