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

// Text in the middle of a page that has no result yet.

class QString;
class QWidget;

namespace evical::ui {

QWidget* emptyHint(const QString& text, QWidget* parent);

}  // namespace evical::ui

// Verdict of a page: a mark by colour and shape, the verdict, and its reason.

class QLabel;

namespace evical::ui {

enum class VerdictTone { Good, Doubtful, Bad };

class VerdictLine : public QWidget {
  Q_OBJECT

 public:
  // Object names of the labels: <name>_verdict and <name>_reason.
  explicit VerdictLine(const QString& name, QWidget* parent = nullptr);

  void addLine(QWidget* line);  // below
  void setVerdict(VerdictTone tone, const QString& title, const QString& reason);

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void paintMark();

  VerdictTone tone_ = VerdictTone::Doubtful;
  QLabel *mark_, *title_, *reason_;
  QVBoxLayout* lines_;
};

}  // namespace evical::ui
