// SPDX-License-Identifier: GPL-3.0-or-later
// Page that compares chosen files: a form and a button, and the result below them; a hint until there is a
// result.
#pragma once

#include "core/data/assessment.h"

#include <QWidget>

#include <utility>
#include <vector>

class QGridLayout;
class QListWidget;
class QPushButton;
class QStackedWidget;
class QTabWidget;
class QVBoxLayout;

namespace evical::ui {

class VerdictLine;
class WorkBar;

class AssessmentScreen : public QWidget {
  Q_OBJECT

 public:
  WorkBar& work() { return *work_; }

 signals:
  void startRequested();
  void cancelRequested();
  void saveRequested();

 protected:
  // Objects are named after `name`: start_<name>, <name>_verdict, <name>_notes, <name>_tabs.
  struct Words {
    QString name, icon_name, heading, start, tip, hint;
  };
  AssessmentScreen(Words words, QWidget* parent);

  QVBoxLayout& form() { return *form_; }  // above the button
  QGridLayout& grid() { return *grid_; }  // of the rows of paths; part of the form
  VerdictLine& verdict() { return *verdict_; }
  QListWidget* notes() { return notes_; }  // part of the content
  void addSaveButton(const QString& tip);
  void addResultButton(QPushButton* button);  // shown once there is a result
  QTabWidget* makeTabs();
  // Below the verdict. Called last, so that the form precedes the button in the order of keys.
  void setContent(QWidget* content);

  // `more`: further notes.
  // `verdict` replaces the usual words, which are about a change.
  void showAssessment(const Assessment& assessment, const QStringList& more, const QString& verdict = {});
  void changeEvent(QEvent* event) override;

 private:
  void fillNotes();

  Words words_;
  QVBoxLayout* form_;
  QGridLayout* grid_;
  WorkBar* work_ = nullptr;
  QStackedWidget* stack_;
  VerdictLine* verdict_;
  QListWidget* notes_;
  std::vector<QPushButton*> result_buttons_;
  std::vector<std::pair<const char*, QString>> lines_;  // of the notes, with their icons
};

}  // namespace evical::ui
