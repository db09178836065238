// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the recording is good enough, before anybody calibrates: one sentence, a light for each thing that was looked
// at, and what to do better.
#pragma once

#include "core/pipeline/rig/recording_assessment.h"

#include <QFrame>

#include <optional>

class QCheckBox;
class QGridLayout;
class QLabel;
class QProgressBar;
class QScrollArea;
class QToolButton;

namespace evical::ui {

class LightMark;

class CheckCard : public QFrame {
  Q_OBJECT

 public:
  explicit CheckCard(QWidget* parent = nullptr);

  // One of them is shown at a time.
  void clear();                       // nothing is known, and nothing is looked at
  void setChecking(double fraction);  // 0..1
  void setWaiting();                  // for other work
  void setAssessment(const RecordingAssessment& assessment);
  void setFailed(const QString& why);
  // The recording is still being written: offers to follow it. Off: nothing of that.
  void offerFollowing(bool offered);
  // It is followed: what is said is of a part of it, which is no reason for alarm, and stays until more is known.
  void setFollowing(bool following);
  // The board is a guess that nobody has looked at: "11 x 4, 50 mm". Empty: somebody has.
  void setUnconfirmedBoard(const QString& board);

  QString text() const;  // all that is shown, for tests and screen readers

 signals:
  void boardConfirmed();
  void followingWanted(bool following);
  void howToRecordRequested();
  void detailsShown(bool shown);  // they need the room of what is below

 private:
  QWidget* makeBoardLine();
  QWidget* makeFollowLine();
  void showAdvice(const RecordingAssessment& assessment);
  void showState(const QString& summary, std::optional<Light> light);
  void showLights(const RecordingAssessment& assessment);
  void showDetails(bool shown);

  LightMark* mark_;
  QLabel *summary_, *advice_, *board_;
  QProgressBar* progress_;
  QToolButton* more_;
  QScrollArea* details_;
  QWidget *board_line_, *follow_line_;
  QCheckBox* follow_;
  QGridLayout* grid_;
  bool idle_ = true;  // nothing is known of the recording
  bool following_ = false, assessed_ = false;
};

}  // namespace evical::ui
