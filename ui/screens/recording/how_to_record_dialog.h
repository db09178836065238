// SPDX-License-Identifier: GPL-3.0-or-later
// How to move before the board, in moving pictures; as stills with arrows where people have turned animations off.
#pragma once

#include <QDialog>

class QLabel;
class QListWidget;
class QToolButton;

namespace evical::ui {

class MotionPicture;

enum class Motion { Moving, Reduced };
Motion motionOfDesktop();  // as the desktop is set

class HowToRecordDialog : public QDialog {
  Q_OBJECT

 public:
  HowToRecordDialog(Motion motion, QWidget* parent);

  void showMotion(const QString& name);  // as shownMotions() has it

 private:
  void choose(int row);
  void setPlaying(bool playing);

  QListWidget* list_;
  MotionPicture* picture_;
  QLabel* words_;
  QToolButton* play_;
};

}  // namespace evical::ui
