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

// In a line of a staggered board there are two from circle to circle.
int spacingsBetween(const Board& board) {
  return board.type == BoardType::AsymmetricCircles ? 2 : 1;
}

int mostInLine(const Board& board) {
  if (board.type == BoardType::AprilGrid) return std::max(board.rows, board.cols);
  return mostSpacings(board) / spacingsBetween(board) + 1;
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
  is_measured_->setToolTip(tr("Printers stretch: the length over a whole line tells by how much"));
  length_mm_->setToolTip(
      tr("From the centre of the first circle to that of the last in one line; of tags, between the same "
         "corners of two"));
  length_std_mm_->setToolTip(tr("How well ruler and eye tell the length, one sigma; 0: exactly"));
  circles_->setToolTip(tr("From the first to the last that were measured, both counted"));
  circles_->setFocusPolicy(Qt::StrongFocus);
  auto* const form = new QFormLayout(this);
  form->setContentsMargins(0, 0, 0, 0);
  form->addRow(is_measured_);
  form->addRow(tr("Length [mm]"), length_mm_);
  form->addRow(tr("Over so many circles"), circles_);
  form->addRow(tr("Its sigma [mm]"), length_std_mm_);
  for (QWidget* const field : {static_cast<QWidget*>(length_mm_), static_cast<QWidget*>(circles_),
                               static_cast<QWidget*>(length_std_mm_)}) {
    field->setAccessibleName(qobject_cast<QLabel*>(form->labelForField(field))->text());
    field->setEnabled(false);
    connect(is_measured_, &QCheckBox::toggled, field, &QWidget::setEnabled);
  }
  connect(is_measured_, &QCheckBox::toggled, this, &MeasuredForm::changed);
  connect(length_mm_, &NumberField::valueEdited, this, &MeasuredForm::changed);
  connect(length_std_mm_, &NumberField::valueEdited, this, &MeasuredForm::changed);
  // As long as it was to be, over as many as are chosen.
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
