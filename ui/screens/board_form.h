// SPDX-License-Identifier: GPL-3.0-or-later
// The printed board: its numbers, and a drawing that follows them.
#pragma once

#include "core/geometry/circle_board.h"

#include <QWidget>

class QComboBox;
class QLabel;
class QSpinBox;

namespace evical::ui {

class BoardDrawing;
class NumberField;

class BoardForm : public QWidget {
  Q_OBJECT

 public:
  explicit BoardForm(QWidget* parent = nullptr);

  void setBoard(const CircleBoard& board);
  void setProblem(const QString& text);

 signals:
  void edited(const evical::CircleBoard& board, const QString& field);

 private:
  void say(const QString& field);

  CircleBoard board_;
  QComboBox* type_;
  QSpinBox* rows_;
  QSpinBox* cols_;
  NumberField* spacing_mm_;
  NumberField* radius_mm_;
  QComboBox* circles_;
  QLabel* problem_;
  BoardDrawing* drawing_;
};

}  // namespace evical::ui
