// SPDX-License-Identifier: GPL-3.0-or-later
// Animations of the motions in front of the board; stills with arrows if the desktop's animations are
// disabled.
#pragma once

#include <QDialog>

class QLabel;
class QListWidget;
class QToolButton;

namespace evical::ui {

class MotionPicture;

enum class Motion { Moving, Reduced };
Motion motionOfDesktop();  // setting of the desktop

class HowToRecordDialog : public QDialog {
  Q_OBJECT

 public:
  HowToRecordDialog(Motion motion, QWidget* parent);

  void showMotion(const QString& name);  // a name of shownMotions()

 private:
  void choose(int row);
  QToolButton* makeStep(int by, const QString& text, const QString& icon_name);
  void setPlaying(bool playing);

  QListWidget* list_;
  MotionPicture* picture_;
  QLabel* words_;
  QToolButton *play_, *previous_, *next_;
};

}  // namespace evical::ui
