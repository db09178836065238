// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of the jobs, from a selectable level on.
#pragma once

#include "ui/jobs/job_runner.h"

#include <QWidget>

#include <deque>

class QComboBox;
class QLineEdit;
class QPlainTextEdit;

namespace evical::ui {

class LogPanel : public QWidget {
  Q_OBJECT

 public:
  explicit LogPanel(QWidget* parent = nullptr);

  void add(const LogLine& line);
  void addHeading(const QString& title);  // start of a job
  QString shownText() const;

 protected:
  void changeEvent(QEvent* event) override;

 private:
  bool isShown(const LogLine& line) const;
  void append(const LogLine& line);
  void refill();

  QComboBox* level_;
  QLineEdit* search_;
  QPlainTextEdit* text_;
  std::deque<LogLine> lines_;
};

}  // namespace evical::ui
