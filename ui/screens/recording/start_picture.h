// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of two of the three steps on the start page: a sheet with a board, and the events of a moving
// board. The step between them is a MotionPicture.
#pragma once

#include <QWidget>

namespace evical::ui {

class StartPicture : public QWidget {
 public:
  enum class Shows { Sheet, Events };
  StartPicture(Shows shows, QWidget* parent) : QWidget(parent), shows_(shows) {}
  QSize sizeHint() const override { return {300, 300}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Shows shows_;
};

}  // namespace evical::ui
