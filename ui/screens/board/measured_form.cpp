// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/board/measured_form.h"

#include "ui/forms/number_field.h"

#include <QCheckBox>
#include <QFormLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSpinBox>

#include <algorithm>

namespace evical::ui {
namespace {

constexpr double kMeasuredMmPerM = 1e3;

// Neighbours in a line of a staggered board are two spacings apart.
int spacingsBetween(const Board& board) {
  return board.type == BoardType::AsymmetricCircles ? 2 : 1;
}

int mostInLine(const Board& board) {
  if (board.type == BoardType::AprilGrid) return std::max(board.rows, board.cols);
  return maxSpacings(board) / spacingsBetween(board) + 1;
}

}  // namespace

MeasuredForm::MeasuredForm(QWidget* parent)
    : QWidget(parent),
      is_measured_(new QCheckBox(tr("Measured with a ruler"), this)),
      length_mm_(new NumberField(0.1, 100'000.0, this)),
      length_std_mm_(new NumberField(0.0, 1'000.0, this)),
      circles_(new QSpinBox(this)) {
  is_measured_->setObjectName("is_measured");
  length_mm_->setObjectName("measured_length");
  circles_->setObjectName("measured_circles");
  is_measured_->setToolTip(tr("Printers change the scale: the length of a whole line determines the factor"));
  length_mm_->setToolTip(
      tr("Between the centres of the first and the last circle in one line; for tags, between the same "
         "corners of two"));
  length_std_mm_->setToolTip(tr("Standard deviation of the measured length; 0: exact"));
  circles_->setToolTip(tr("Number of circles, corners or tags in the measured line, including both ends"));
  circles_->setFocusPolicy(Qt::StrongFocus);
  auto* const form = new QFormLayout(this);
  form->setContentsMargins(0, 0, 0, 0);
  form->addRow(is_measured_);
  form->addRow(tr("Length [mm]"), length_mm_);
  form->addRow(tr("Number of points"), circles_);
  form->addRow(tr("Sigma [mm]"), length_std_mm_);
  for (QWidget* const field : {static_cast<QWidget*>(length_mm_), static_cast<QWidget*>(circles_),
                               static_cast<QWidget*>(length_std_mm_)}) {
    field->setAccessibleName(qobject_cast<QLabel*>(form->labelForField(field))->text());
    field->setEnabled(false);
    connect(is_measured_, &QCheckBox::toggled, field, &QWidget::setEnabled);
  }
  connect(is_measured_, &QCheckBox::toggled, this, &MeasuredForm::changed);
  connect(length_mm_, &NumberField::valueEdited, this, &MeasuredForm::changed);
  connect(length_std_mm_, &NumberField::valueEdited, this, &MeasuredForm::changed);
  // Nominal length over the chosen number of circles.
  connect(circles_, &QSpinBox::valueChanged, this, [this](int count) {
    length_mm_->setValue(kMeasuredMmPerM * board_.spacing_m * spacingsBetween(board_) * (count - 1));
    emit changed();
  });
  setBoard({});
}

void MeasuredForm::setBoard(const Board& board) {
  constexpr double kRuler_mm = 0.5;
  board_ = board;
  const QSignalBlocker quiet(circles_);
  is_measured_->setChecked(false);
  circles_->setRange(2, std::max(2, mostInLine(board)));
  circles_->setValue(circles_->maximum());
  length_mm_->setValue(kMeasuredMmPerM * board.spacing_m * spacingsBetween(board) * (circles_->value() - 1));
  length_std_mm_->setValue(kRuler_mm);
}

std::optional<MeasuredLength> MeasuredForm::measured() const {
  if (!is_measured_->isChecked()) return std::nullopt;
  MeasuredLength length;
  length.spacings = spacingsBetween(board_) * (circles_->value() - 1);
  length.length_m = length_mm_->value() / kMeasuredMmPerM;
  length.std_m = length_std_mm_->value() / kMeasuredMmPerM;
  return length;
}

}  // namespace evical::ui
