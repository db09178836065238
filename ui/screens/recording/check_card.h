// SPDX-License-Identifier: GPL-3.0-or-later
// Check of the recording before a calibration: one sentence, a light for each criterion, and advice.
#pragma once

#include "core/pipeline/rig/recording_assessment.h"

#include <QFrame>
#include <QString>
#include <QWidget>

#include <optional>

class QCheckBox;
class QGridLayout;
class QLabel;
class QProgressBar;
class QToolButton;

namespace evical::ui {

class LightMark;

class CheckCard : public QFrame {
  Q_OBJECT

 public:
  explicit CheckCard(QWidget* parent = nullptr);

  // States; one at a time is shown.
  void clear(const QString& summary = {}, const QString& advice = {});  // no check
  bool isClear() const { return idle_; }
  void setChecking(double fraction);  // 0..1
  void setWaiting();                  // for another job
  void setAssessment(const RecordingAssessment& assessment);
  void setFailed(const QString& why);
  // Offers to follow a recording that is still being written.
  void offerFollowing(bool offered);
  // While followed, an assessment concerns part of the recording: no alarm, and it stays until the next one.
  void setFollowing(bool following);
  // Problems that prevent a calibration, one per line; empty: none.
  void setMissing(const QString& text);
  // Unconfirmed board that was guessed: "11 x 4, 50 mm". Empty: confirmed.
  void setUnconfirmedBoard(const QString& board);

  QString text() const;  // all visible text, for tests and screen readers

 signals:
  void boardConfirmed();
  void followingWanted(bool following);
  void howToRecordRequested();

 private:
  QWidget* makeBoardLine();
  QWidget* makeFollowLine();
  QWidget* makeWords();
  void showAdvice(const RecordingAssessment& assessment);
  void showGood();
  void showState(const QString& summary, std::optional<Light> light);
  void showLights(const RecordingAssessment& assessment);
  void showDetails(bool shown);

  LightMark* mark_;
  QLabel *summary_, *advice_, *good_, *board_, *missing_;
  QProgressBar* progress_;
  QToolButton* more_;
  QWidget *board_line_ = nullptr, *follow_line_ = nullptr;
  QWidget *lights_, *details_ = nullptr;  // the table of checks, and the area around it
  QCheckBox* follow_;
  QGridLayout* grid_;
  bool idle_ = true;  // no check
  bool following_ = false, assessed_ = false;
};

// Light that differs by shape as well as by colour: a disc, a triangle, a square.

QString lightWord(Light light);  // "good", "fair", "poor"

class LightMark : public QWidget {
  Q_OBJECT

 public:
  explicit LightMark(QWidget* parent = nullptr);

  void setLight(Light light);
  Light light() const { return light_; }
  QSize sizeHint() const override { return {14, 14}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Light light_ = Light::Fair;
};

}  // namespace evical::ui
