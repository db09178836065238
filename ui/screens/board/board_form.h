// SPDX-License-Identifier: GPL-3.0-or-later
// Form of one printed board with a drawing; with several boards also its name and cameras.
#pragma once

#include "core/geometry/board.h"

#include <QWidget>

#include <optional>

class QCheckBox;
class QComboBox;
class QFormLayout;
class QLabel;
class QLineEdit;
class QSpinBox;
class QToolButton;

namespace evical::ui {

class BoardDrawing;
class NumberField;

class BoardForm : public QWidget {
  Q_OBJECT

 public:
  explicit BoardForm(QWidget* parent = nullptr);

  void setBoard(const Board& board, const std::optional<MeasuredLength>& measured);
  void setBlinking(bool offered, bool blinking);
  void foldMore();  // rows that few boards need, except if they are used
  // For a board that is not yet printed: without a measured length and without the drawing.
  void showNumbersOnly();
  // Empty: the only board, which needs no name.
  void setName(const QString& name, const QString& seen_by);
  void setNameProblem(const QString& text);
  void setProblem(const QString& text);

 signals:
  void renamed(const QString& name);  // to the typed text
  void edited(const evical::Board& board, const QString& field);
  void blinkingChosen(bool blinking);
  // Measured length that determines the spacing; none if the spacing is given directly.
  void measured(const std::optional<evical::MeasuredLength>& measured, const QString& field);

 private:
  void addName();
  void addMore();
  void addMeasure();
  void showType();
  void showRows();
  void say(const QString& field);
  void showMeasured(const QString& field);

  Board board_;
  bool numbers_only_ = false, blinking_offered_ = false;
  std::optional<MeasuredLength> measured_;
  QFormLayout* form_;
  QString named_;
  QLineEdit* name_;
  QComboBox* type_;
  QSpinBox* rows_;
  QSpinBox* cols_;
  NumberField* spacing_mm_;
  NumberField* radius_mm_;
  QToolButton* more_;
  QCheckBox *is_measured_, *blinks_;
  NumberField* length_mm_;
  QSpinBox* spacings_;
  NumberField* length_std_mm_;
  NumberField* tag_mm_;
  QComboBox* circles_;
  QSpinBox* first_tag_;
  QLabel *seen_by_, *name_problem_, *problem_;
  BoardDrawing* drawing_;
};

}  // namespace evical::ui
