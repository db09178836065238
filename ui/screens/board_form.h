// SPDX-License-Identifier: GPL-3.0-or-later
// The printed board: its numbers, and a drawing that follows them.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/geometry/board.h"
#include "core/geometry/measured_length.h"

#include <QWidget>

#include <optional>

class QCheckBox;
class QComboBox;
class QFormLayout;
class QLabel;
class QSpinBox;

namespace evical::ui {

class BoardDrawing;
class NumberField;

class BoardForm : public QWidget {
  Q_OBJECT

 public:
  explicit BoardForm(QWidget* parent = nullptr);

  void setBoard(const Board& board, const std::optional<MeasuredLength>& measured);
  // What a session has beside the board that the form shows; its name where there are any.
  void setFurtherBoards(const std::string& name, const std::vector<FurtherBoard>& further);
  void setProblem(const QString& text);

 signals:
  void edited(const evical::Board& board, const QString& field);
  // The length that tells the spacing; nothing where the spacing is given as it is.
  void measured(const std::optional<evical::MeasuredLength>& measured, const QString& field);

 private:
  void addMeasure(QFormLayout& form);
  void say(const QString& field);
  void sayMeasured(const QString& field);

  Board board_;
  std::optional<MeasuredLength> measured_;
  QFormLayout* form_;
  QComboBox* type_;
  QSpinBox* rows_;
  QSpinBox* cols_;
  NumberField* spacing_mm_;
  NumberField* radius_mm_;
  QCheckBox* is_measured_;
  NumberField* length_mm_;
  QSpinBox* spacings_;
  NumberField* length_std_mm_;
  NumberField* tag_mm_;
  QComboBox* circles_;
  QLabel *further_, *problem_;
  BoardDrawing* drawing_;
};

}  // namespace evical::ui
