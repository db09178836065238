// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/board/board_form.h"

#include "ui/forms/fold_button.h"
#include "ui/forms/form_words.h"
#include "ui/forms/number_field.h"
#include "ui/screens/board/board_drawing.h"
#include "ui/screens/wrapped_label.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QScrollArea>
#include <QScrollBar>
#include <QSignalBlocker>
#include <QSpinBox>
#include <QStandardItemModel>
#include <QToolButton>
#include <QVBoxLayout>

namespace evical::ui {
namespace {

constexpr double kMmPerM = 1e3;

QSpinBox* countBox(int least, const QString& tip, QWidget* parent) {
  constexpr int kMax = 100;
  auto* const box = new QSpinBox(parent);
  box->setRange(least, kMax);
  box->setToolTip(tip);
  box->setFocusPolicy(Qt::StrongFocus);
  return box;
}

// Has the width of its fields; scrolls if the height is too small.
class FieldsArea final : public QScrollArea {
 public:
  FieldsArea(QFormLayout* form, QWidget* parent) : QScrollArea(parent) {
    auto* const fields = new QWidget;
    fields->setLayout(form);
    setWidget(fields);
    setWidgetResizable(true);
    setFrameShape(QFrame::NoFrame);
    setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    setSizePolicy(QSizePolicy::Fixed, QSizePolicy::Expanding);
    viewport()->setAutoFillBackground(false);
    fields->setAutoFillBackground(false);
  }
  QSize sizeHint() const override { return {width_px(), QScrollArea::sizeHint().height()}; }
  QSize minimumSizeHint() const override { return {width_px(), QScrollArea::minimumSizeHint().height()}; }

 private:
  int width_px() const {
    return widget()->minimumSizeHint().width() + verticalScrollBar()->sizeHint().width();
  }
};

// Initial value: the nominal length of the board.
MeasuredLength overWholeBoard(const Board& board) {
  MeasuredLength length;
  length.spacings = maxSpacings(board);
  length.length_m = length.spacings * board.spacing_m;
  return length;
}

// Usual sizes for a new type of board, if it has none.
void setSizes(Board& board) {
  constexpr double kRadius = 0.4, kTag = 0.75;  // of the spacing
  if (!board.hasCircles()) board.radius_m = 0.0;
  if (board.hasCircles() && board.radius_m == 0.0) board.radius_m = kRadius * board.spacing_m;
  if (!board.hasTags()) board.tag_size_m = 0.0;
  if (board.hasTags() && board.tag_size_m == 0.0) board.tag_size_m = kTag * board.spacing_m;
}

}  // namespace

BoardForm::BoardForm(QWidget* parent)
    : QWidget(parent),
      form_(new QFormLayout),
      name_(new QLineEdit(this)),
      type_(new QComboBox(this)),
      rows_(countBox(
          1,
          tr("Staggered lines of circles (odd, so that the orientation is unique); inner corners of a "
             "checkerboard, tags, or squares of a ChArUco board"),
          this)),
      cols_(countBox(1, tr("Number of circles, corners, tags or squares in a line"), this)),
      spacing_mm_(new NumberField(0.1, 10'000.0, this)),
      radius_mm_(new NumberField(0.01, 10'000.0, this)),
      more_(foldButton("board_more", tr("More"),
                       tr("For a length that was measured, and for a board that flashes"), this)),
      is_measured_(new QCheckBox(tr("Measured over several spacings"), this)),
      blinks_(new QCheckBox(tr("The board flashes (screen or lamps)"), this)),
      length_mm_(new NumberField(0.1, 100'000.0, this)),
      spacings_(countBox(
          1,
          tr("Spacings between the first and the last circle: one fewer than circles; in a line of a "
             "staggered board two from circle to circle"),
          this)),
      length_std_mm_(new NumberField(0.0, 1'000.0, this)),
      tag_mm_(new NumberField(0.1, 10'000.0, this)),
      circles_(new QComboBox(this)),
      first_tag_(countBox(0, tr("Number of the tag at the bottom left; the others follow"), this)),
      seen_by_(new FormLabel({}, "", this)),
      name_problem_(new FormLabel({}, "problem", this)),
      problem_(wrappedLabel({}, "problem", this)),
      drawing_(new BoardDrawing(this)) {
  type_->addItems({tr("Asymmetric (staggered)"), tr("Symmetric"), tr("Checkerboard"), tr("AprilGrid"),
                   tr("ChArUco"), tr("Points of a table")});
  circles_->addItems({tr("Dark on bright"), tr("Bright on dark")});
  type_->setToolTip(
      tr("Event and frame cameras see all types. Of circles, the asymmetric board is the most precise for "
         "event cameras"));
  spacing_mm_->setToolTip(tr(
      "Asymmetric: distance between two staggered lines, half the distance of neighbours in a "
      "line. Symmetric: distance of neighbours. Checkerboard: a square's edge. Tags: from one to the next"));
  tag_mm_->setToolTip(tr("Edge of a tag's black square"));
  radius_mm_->setToolTip(tr("Radius of a circle, as printed"));
  circles_->setToolTip(tr("Brightness of the circles relative to the background"));
  addName();
  form_->addRow(tr("Type"), type_);
  form_->addRow(tr("Rows"), rows_);
  form_->addRow(tr("Columns"), cols_);
  form_->addRow(tr("Spacing [mm]"), spacing_mm_);
  form_->addRow(tr("Radius [mm]"), radius_mm_);
  form_->addRow(tr("Tag [mm]"), tag_mm_);
  form_->addRow(tr("Circles"), circles_);
  addMore();
  form_->setContentsMargins(0, 0, 4, 0);
  // A problem takes its place from the drawing: fields must not move under the mouse.
  problem_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  auto* const beside = new QWidget(this);
  auto* const column = new QVBoxLayout(beside);
  column->setContentsMargins(0, 0, 0, 0);
  column->addWidget(drawing_, 1);
  column->addWidget(problem_);
  auto* const row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(new FieldsArea(form_, this));
  row->addWidget(beside, 1);

  connect(type_, &QComboBox::activated, this, [this] { say("type"); });
  connect(circles_, &QComboBox::activated, this, [this] { say("circles"); });
  connect(rows_, &QSpinBox::valueChanged, this, [this] { say("rows"); });
  connect(cols_, &QSpinBox::valueChanged, this, [this] { say("cols"); });
  connect(spacing_mm_, &NumberField::valueEdited, this, [this] { say("spacing_m"); });
  connect(radius_mm_, &NumberField::valueEdited, this, [this] { say("radius_m"); });
  connect(first_tag_, &QSpinBox::valueChanged, this, [this] { say("first_tag"); });
  connect(tag_mm_, &NumberField::valueEdited, this, [this] { say("tag_size_m"); });
  setBoard({}, {});
  setName({}, {});
  setProblem({});
}

void BoardForm::addName() {
  name_->setObjectName("board_name");
  seen_by_->setObjectName("seen_by");
  name_problem_->setObjectName("name_problem");
  name_->setToolTip(tr("Name of the board in the session and in the cameras' forms"));
  seen_by_->setToolTip(tr("Cameras that see this board, as set in the cameras' forms"));
  form_->addRow(tr("Name"), name_);
  form_->addRow(name_problem_);
  form_->addRow(tr("Seen by"), seen_by_);
  connect(name_, &QLineEdit::editingFinished, this, [this] {
    const QString typed = name_->text().trimmed();
    setNameProblem({});
    if (typed != named_) emit renamed(typed);
  });
}

void BoardForm::setName(const QString& name, const QString& seen_by) {
  named_ = name;
  name_->setText(name);
  seen_by_->setText(seen_by);
  setNameProblem({});
  form_->setRowVisible(name_, !name.isEmpty());
  form_->setRowVisible(seen_by_, !name.isEmpty());
}

// The typed text stays, so that it can be corrected.
void BoardForm::setNameProblem(const QString& text) {
  name_problem_->setText(text);
  form_->setRowVisible(name_problem_, !text.isEmpty());
}

void BoardForm::addMore() {
  form_->addRow(more_);
  form_->setAlignment(more_, Qt::AlignLeft);
  connect(more_, &QToolButton::toggled, this, &BoardForm::showRows);
  addMeasure();
  blinks_->setObjectName("blinks");
  blinks_->setToolTip(
      tr("For the intrinsics of one event camera at rest. Any type of board is suitable if it "
         "flashes."));
  form_->addRow(tr("First tag"), first_tag_);
  form_->addRow(blinks_);
  connect(blinks_, &QCheckBox::clicked, this, &BoardForm::blinkingChosen);
}

void BoardForm::addMeasure() {
  is_measured_->setToolTip(tr("A length over the whole board is about ten times as accurate as one spacing"));
  length_mm_->setToolTip(tr("Between the centres of two circles in one line, as far apart as possible"));
  length_std_mm_->setToolTip(tr("Standard deviation of the measured length; 0: exact"));
  form_->addRow(is_measured_);
  form_->addRow(tr("Length [mm]"), length_mm_);
  form_->addRow(tr("Number of spacings"), spacings_);
  form_->addRow(tr("Sigma [mm]"), length_std_mm_);
  connect(is_measured_, &QCheckBox::clicked, this, [this] { showMeasured("measured"); });
  connect(length_mm_, &NumberField::valueEdited, this, [this] { showMeasured("measured.length_m"); });
  connect(spacings_, &QSpinBox::valueChanged, this, [this] { showMeasured("measured.spacings"); });
  connect(length_std_mm_, &NumberField::valueEdited, this, [this] { showMeasured("measured.std_m"); });
}

void BoardForm::setBoard(const Board& board, const std::optional<MeasuredLength>& measured) {
  board_ = board;
  measured_ = measured;
  const QSignalBlocker quiet_rows(rows_), quiet_cols(cols_), quiet_spacings(spacings_), quiet_tag(first_tag_);
  is_measured_->setChecked(measured.has_value());
  const MeasuredLength length = measured.value_or(overWholeBoard(board));
  length_mm_->setValue(kMmPerM * length.length_m);
  spacings_->setValue(length.spacings);
  length_std_mm_->setValue(kMmPerM * length.std_m);
  spacing_mm_->setEnabled(!measured);
  showType();
  rows_->setValue(board.rows);
  cols_->setValue(board.cols);
  spacing_mm_->setValue(kMmPerM * board.spacing_m);
  radius_mm_->setValue(kMmPerM * board.radius_m);
  tag_mm_->setValue(kMmPerM * board.tag_size_m);
  first_tag_->setMaximum(std::max(586, board.first_tag));
  first_tag_->setValue(board.first_tag);
  circles_->setCurrentIndex(static_cast<int>(board.circles));
  showRows();
  drawing_->setBoard(board);
}

// Tables of points come from a session's file: shown, replaceable by another type, but not selectable.
void BoardForm::showType() {
  const int index = static_cast<int>(board_.type);
  const int points = static_cast<int>(BoardType::Points);
  qobject_cast<QStandardItemModel*>(type_->model())->item(points)->setEnabled(index == points);
  type_->setCurrentIndex(index);
}

void BoardForm::setBlinking(bool offered, bool blinking) {
  blinking_offered_ = offered;
  blinks_->setChecked(blinking);
  showRows();
}

void BoardForm::foldMore() {
  more_->setChecked(false);
}

// Rows that do not apply to the board are hidden.
void BoardForm::showRows() {
  const bool used = measured_.has_value() || blinks_->isChecked();
  if (used && !more_->isChecked()) return more_->setChecked(true);  // calls this function
  const bool more = more_->isChecked();
  more_->setEnabled(!used);
  for (QWidget* const field : {static_cast<QWidget*>(length_mm_), static_cast<QWidget*>(spacings_),
                               static_cast<QWidget*>(length_std_mm_)})
    form_->setRowVisible(field, measured_.has_value());
  for (QWidget* const field :
       {static_cast<QWidget*>(rows_), static_cast<QWidget*>(cols_), static_cast<QWidget*>(spacing_mm_)})
    form_->setRowVisible(field, board_.hasPattern());
  form_->setRowVisible(more_, board_.hasPattern() && !numbers_only_);
  form_->setRowVisible(is_measured_, board_.hasPattern() && !numbers_only_ && more);
  form_->setRowVisible(blinks_, blinking_offered_ && more);
  form_->setRowVisible(radius_mm_, board_.hasCircles());
  form_->setRowVisible(circles_, board_.hasCircles());
  form_->setRowVisible(tag_mm_, board_.hasTags());
  form_->setRowVisible(first_tag_, board_.type == BoardType::AprilGrid && (more || board_.first_tag != 0));
}

void BoardForm::say(const QString& field) {
  const auto type = static_cast<BoardType>(type_->currentIndex());
  if (type == BoardType::Points) return;
  Board board = board_.hasPattern() ? board_ : Board();
  board.type = type;
  if (type != board_.type) setSizes(board);
  if (!board_.hasPattern()) return emit edited(board, field);
  board.rows = rows_->value();
  board.cols = cols_->value();
  if (field == "spacing_m") board.spacing_m = spacing_mm_->value() / kMmPerM;
  if (field == "radius_m") board.radius_m = radius_mm_->value() / kMmPerM;
  if (field == "tag_size_m") board.tag_size_m = tag_mm_->value() / kMmPerM;
  board.first_tag = board.type == BoardType::AprilGrid ? first_tag_->value() : 0;
  board.circles = static_cast<CircleShade>(circles_->currentIndex());
  if (board == board_) return;
  emit edited(board, field);
}

void BoardForm::showMeasured(const QString& field) {
  std::optional<MeasuredLength> changed;
  if (is_measured_->isChecked()) {
    changed = measured_.value_or(overWholeBoard(board_));
    if (field == "measured.length_m") changed->length_m = length_mm_->value() / kMmPerM;
    if (field == "measured.std_m") changed->std_m = length_std_mm_->value() / kMmPerM;
    changed->spacings = spacings_->value();
  }
  if (changed == measured_) return;
  emit measured(changed, field);
}

void BoardForm::showNumbersOnly() {
  numbers_only_ = true;
  showRows();
  drawing_->parentWidget()->hide();
  // All rows are visible: the parent scrolls.
  if (auto* const fields = findChild<QScrollArea*>())
    fields->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
}

void BoardForm::setProblem(const QString& text) {
  problem_->setText(text);
  problem_->setVisible(!text.isEmpty());
}

}  // namespace evical::ui
