// SPDX-License-Identifier: GPL-3.0-or-later
// Measurement of a print by ruler: the length over as many points as possible.
#pragma once

#include "core/geometry/board.h"

#include <QWidget>

#include <optional>

class QCheckBox;
class QSpinBox;

namespace evical::ui {

class NumberField;

class MeasuredForm : public QWidget {
  Q_OBJECT

 public:
  explicit MeasuredForm(QWidget* parent = nullptr);

  void setBoard(const Board& board);               // printed board; resets the measurement
  std::optional<MeasuredLength> measured() const;  // none: nominal size

 signals:
  void changed();

 private:
  Board board_;
  QCheckBox* is_measured_;
  NumberField *length_mm_, *length_std_mm_;
  QSpinBox* circles_;
};

}  // namespace evical::ui
