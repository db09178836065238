// SPDX-License-Identifier: GPL-3.0-or-later
// What a ruler says of a print: a length over as many of its points as there are.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/measured_length.h"

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

  void setBoard(const Board& board);  // that is printed; what was measured of another one is forgotten
  std::optional<MeasuredLength> measured() const;  // nothing: taken for as it was to be printed

 signals:
  void changed();

 private:
  Board board_;
  QCheckBox* is_measured_;
  NumberField *length_mm_, *length_std_mm_;
  QSpinBox* circles_;
};

}  // namespace evical::ui
