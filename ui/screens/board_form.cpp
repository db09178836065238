// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/board_form.h"

#include "ui/forms/number_field.h"
#include "ui/screens/board_drawing.h"

#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QSpinBox>

namespace evical::ui {
namespace {

constexpr double kMmPerM = 1e3;

QSpinBox* countBox(const QString& tip, QWidget* parent) {
  auto* const box = new QSpinBox(parent);
  box->setRange(2, 100);
  box->setToolTip(tip);
  box->setFocusPolicy(Qt::StrongFocus);
  return box;
}

}  // namespace

BoardForm::BoardForm(QWidget* parent)
    : QWidget(parent),
      type_(new QComboBox(this)),
      rows_(countBox(tr("Staggered lines of circles; odd, so that the board has an up and a down"), this)),
      cols_(countBox(tr("Circles in one line"), this)),
      spacing_mm_(new NumberField(0.1, 10'000.0, this)),
      radius_mm_(new NumberField(0.01, 10'000.0, this)),
      circles_(new QComboBox(this)),
      problem_(new QLabel(this)),
      drawing_(new BoardDrawing(this)) {
  type_->addItems({tr("Asymmetric (staggered)"), tr("Symmetric")});
  circles_->addItems({tr("Dark on bright"), tr("Bright on dark")});
  type_->setToolTip(tr("Whether every other line is shifted by half a step"));
  spacing_mm_->setToolTip(
      tr("Asymmetric: between two staggered lines, half of what lies between neighbours in a "
         "line. Symmetric: between neighbours"));
  radius_mm_->setToolTip(tr("Of a circle, as printed"));
  circles_->setToolTip(tr("Which way the printed circles differ from their background"));
  problem_->setProperty("role", "problem");
  problem_->setWordWrap(true);
  auto* const spacing_hint = new QLabel(tr("Between two rows. Measure over as many as there are, and divide; "
                                           "how well is board_spacing_sigma in Parameters."),
                                        this);
  spacing_hint->setProperty("role", "hint");
  spacing_hint->setWordWrap(true);
  auto* const form = new QFormLayout;
  form->addRow(tr("Type"), type_);
  form->addRow(tr("Rows"), rows_);
  form->addRow(tr("Columns"), cols_);
  form->addRow(tr("Spacing [mm]"), spacing_mm_);
  form->addRow(spacing_hint);
  form->addRow(tr("Radius [mm]"), radius_mm_);
  form->addRow(tr("Circles"), circles_);
  form->addRow(problem_);
  auto* const layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addLayout(form);
  layout->addWidget(drawing_, 1);

  connect(type_, &QComboBox::activated, this, [this] { say("type"); });
  connect(circles_, &QComboBox::activated, this, [this] { say("circles"); });
  connect(rows_, &QSpinBox::valueChanged, this, [this] { say("rows"); });
  connect(cols_, &QSpinBox::valueChanged, this, [this] { say("cols"); });
  connect(spacing_mm_, &NumberField::valueEdited, this, [this] { say("spacing_m"); });
  connect(radius_mm_, &NumberField::valueEdited, this, [this] { say("radius_m"); });
  setBoard({});
  setProblem({});
}

void BoardForm::setBoard(const CircleBoard& board) {
  board_ = board;
  const QSignalBlocker quiet_rows(rows_), quiet_cols(cols_);
  type_->setCurrentIndex(static_cast<int>(board.type));
  rows_->setValue(board.rows);
  cols_->setValue(board.cols);
  spacing_mm_->setValue(kMmPerM * board.spacing_m);
  radius_mm_->setValue(kMmPerM * board.radius_m);
  circles_->setCurrentIndex(static_cast<int>(board.circles));
  drawing_->setBoard(board);
}

void BoardForm::say(const QString& field) {
  CircleBoard board = board_;
  board.type = static_cast<BoardType>(type_->currentIndex());
  board.rows = rows_->value();
  board.cols = cols_->value();
  if (field == "spacing_m") board.spacing_m = spacing_mm_->value() / kMmPerM;
  if (field == "radius_m") board.radius_m = radius_mm_->value() / kMmPerM;
  board.circles = static_cast<CircleShade>(circles_->currentIndex());
  if (board == board_) return;
  emit edited(board, "board." + field);
}

void BoardForm::setProblem(const QString& text) {
  problem_->setText(text);
  problem_->setVisible(!text.isEmpty());
}

}  // namespace evical::ui
