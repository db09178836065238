// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/board/print_board_dialog.h"

#include "ui/screens/board/board_form.h"
#include "ui/screens/board/measured_form.h"

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/geometry/marker_bits.h"
#include "core/printing/blink_page.h"
#include "ui/forms/fold_button.h"
#include "ui/forms/number_field.h"
#include "ui/screens/format_number.h"
#include "ui/screens/wrapped_label.h"
#include "ui/theme/theme.h"

#include <QComboBox>
#include <QDesktopServices>
#include <QDialogButtonBox>
#include <QDir>
#include <QFileDialog>
#include <QFileInfo>
#include <QFormLayout>
#include <QGroupBox>
#include <QLabel>
#include <QLocale>
#include <QMarginsF>
#include <QMenu>
#include <QPageLayout>
#include <QPageSize>
#include <QPainter>
#include <QPrintDialog>
#include <QPrinter>
#include <QPushButton>
#include <QScrollArea>
#include <QSettings>
#include <QSpinBox>
#include <QToolButton>
#include <QUrl>
#include <QVBoxLayout>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace evical::ui {
namespace {

constexpr double kSheetMmPerM = 1e3, kMmPerInch = 25.4;
const char* const kBoardFolderKey = "board_folder";

// Without the error's place: keys of files do not appear in the window.
QString textOf(const CalibrationError& error) {
  QString text = QObject::tr("The board %1. %2.")
                     .arg(QString::fromStdString(error.problem()), QString::fromStdString(error.advice()));
  return text;
}

// Index in papers(): smallest that the board fits, and into which the usual paper fits too, since a printer
// with A4 lacks Letter. If there is none, their number, which is the size of the board.
int proposedPaper(const Board& board) {
  const Paper& usual = usualPaper();
  const auto proposed = std::find_if(papers().begin(), papers().end(), [&](const Paper& paper) {
    SheetOptions sheet;
    sheet.paper = paper;
    return paper.short_mm >= usual.short_mm && paper.long_mm >= usual.long_mm && fitsSheet(board, sheet);
  });
  return static_cast<int>(proposed - papers().begin());
}

// The labels that are shown get one width, so that the fields of all forms start at the same place.
void alignLabels(std::initializer_list<QFormLayout*> forms) {
  std::vector<QWidget*> labels;
  for (QFormLayout* const form : forms)
    for (int row = 0; row < form->rowCount(); ++row)
      if (const QLayoutItem* const label = form->itemAt(row, QFormLayout::LabelRole);
          label != nullptr && !label->widget()->isHidden())
        labels.push_back(label->widget());
  int widest_px = 0;
  for (const QWidget* const label : labels) widest_px = std::max(widest_px, label->sizeHint().width());
  for (QWidget* const label : labels) label->setMinimumWidth(widest_px);
}

QPushButton* sheetButton(const QString& icon_name, const QString& text, const QString& tip, QWidget* parent) {
  auto* const made = new QPushButton(icon(icon_name), text, parent);
  made->setToolTip(tip);
  made->setAutoDefault(false);  // Enter ends an edit
  return made;
}

}  // namespace

const Paper& usualPaper() {
  const bool us = QLocale().measurementSystem() == QLocale::ImperialUSSystem;
  return *std::find_if(papers().begin(), papers().end(),
                       [&](const Paper& paper) { return paper.name == (us ? "Letter" : "A4"); });
}

void writeBoardFile(const BoardFile& file) {
  const QString ending = QFileInfo(file.path).suffix().toLower();
  const std::string content = ending == "html"  ? blinkPage(file.board, file.options.margin_m, file.print)
                              : ending == "svg" ? boardSvg(file.board, file.options, file.print)
                              : ending == "png"
                                  ? boardPng(file.board, file.resolution_dpi, file.options, file.print)
                                  : boardPdf(file.board, file.options, file.print);
  writeFileWhole(file.path.toStdString(), content);
}

PrintBoardDialog::PrintBoardDialog(const Board& board, QWidget* parent)
    : QDialog(parent),
      board_(board),
      form_(new BoardForm(this)),
      paper_form_(new QFormLayout),
      paper_(new QComboBox(this)),
      markers_(new QComboBox(this)),
      border_bits_(new QComboBox(this)),
      margin_mm_(new NumberField(0.0, 500.0, this)),
      resolution_dpi_(new QSpinBox(this)),
      preview_(new SheetPreview(this)),
      message_(wrappedLabel({}, "hint", this)),
      half_turn_(
          wrappedLabel(tr("This board looks the same upside down: it suits only the intrinsics of a camera, "
                          "not a calibration with an IMU. Choose an odd number of rows."),
                       "problem", this)),
      taken_(wrappedLabel({}, "", this)),
      measured_(new MeasuredForm(this)),
      after_printing_(
          foldButton("after_printing", tr("3. After printing: measure the board and use it"),
                     tr("Shows the fields for the measured length; opens after printing or saving"), this)) {
  setWindowTitle(tr("Print a board"));
  setObjectName("print_board");
  makeButtons();
  auto* const columns = new QHBoxLayout;
  columns->setSpacing(14);
  columns->addWidget(makeFields());
  columns->addLayout(makeOutputs(), 1);
  auto* const close = new QDialogButtonBox(QDialogButtonBox::Close, this);
  connect(close, &QDialogButtonBox::rejected, this, &QDialog::reject);
  auto* const layout = new QVBoxLayout(this);
  layout->addLayout(columns, 1);
  layout->addWidget(close);
  connect(form_, &BoardForm::edited, this, &PrintBoardDialog::setBoard);
  measured_->setBoard(board_);
  showBoard();
}

QWidget* PrintBoardDialog::makeFields() {
  constexpr int kWidth_px = 330;
  auto* const fields = new QWidget(this);
  fields->setFixedWidth(kWidth_px);
  auto* const column = new QVBoxLayout(fields);
  column->setContentsMargins(0, 0, 6, 0);
  form_->showNumbersOnly();
  form_->findChild<QScrollArea*>()->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  auto* const board = new QGroupBox(tr("1. The board"), fields);
  (new QVBoxLayout(board))->addWidget(form_);
  column->addWidget(board);
  column->addWidget(makePaper());
  column->addStretch(1);
  return fields;
}

QWidget* PrintBoardDialog::makePaper() {
  auto* const group = new QGroupBox(tr("2. The paper"), this);
  (new QVBoxLayout(group))->addLayout(paper_form_);
  paper_form_->setContentsMargins(0, 0, 4, 0);  // those of the board's form
  paper_->setObjectName("paper");
  for (const Paper& paper : papers()) paper_->addItem(QString::fromStdString(paper.name));
  paper_->addItem(tr("Size of the board"));
  paper_->setCurrentIndex(proposedPaper(board_));
  paper_->setToolTip(tr("The board is centred on the sheet, in portrait or landscape format"));
  margin_mm_->setValue(kSheetMmPerM * SheetOptions{}.margin_m);
  margin_mm_->setToolTip(tr("Minimum white margin around the board"));
  border_bits_->addItems({tr("1 bit"), tr("2 bits, as in Kalibr")});
  border_bits_->setCurrentIndex(TagPrint{}.border_bits - 1);
  border_bits_->setToolTip(tr("Width of the tags' black border"));
  for (const std::string& name : markerNames()) markers_->addItem(QString::fromStdString(name));
  markers_->setCurrentText(QString::fromUtf8(kUsualMarkers));
  markers_->setToolTip(tr("ArUco dictionary of the markers, by number of bits"));
  constexpr int kMin_dpi = 50, kMax_dpi = 1200, kUsual_dpi = 300;
  resolution_dpi_->setRange(kMin_dpi, kMax_dpi);
  resolution_dpi_->setValue(kUsual_dpi);
  resolution_dpi_->setToolTip(tr("Pixels per inch of a PNG; PDF and SVG are exact"));
  resolution_dpi_->setFocusPolicy(Qt::StrongFocus);
  const std::initializer_list<std::pair<QString, QWidget*>> rows = {{tr("Paper"), paper_},
                                                                    {tr("Margin [mm]"), margin_mm_},
                                                                    {tr("Tags' border"), border_bits_},
                                                                    {tr("Markers"), markers_},
                                                                    {tr("PNG [dpi]"), resolution_dpi_}};
  for (const auto& [text, field] : rows) {
    field->setAccessibleName(text);
    paper_form_->addRow(text, field);
  }
  for (QComboBox* const box : {paper_, border_bits_, markers_})
    connect(box, &QComboBox::currentIndexChanged, this, &PrintBoardDialog::showBoard);
  connect(margin_mm_, &NumberField::valueEdited, this, &PrintBoardDialog::showBoard);
  return group;
}

// Preview, buttons below it, and the step after them.
QLayout* PrintBoardDialog::makeOutputs() {
  auto* const column = new QVBoxLayout;
  column->addWidget(preview_, 1);
  column->addWidget(half_turn_);
  auto* const messages = new QHBoxLayout;
  messages->addWidget(message_, 1);
  messages->addWidget(shrink_, 0, Qt::AlignTop);
  column->addLayout(messages);
  auto* const outputs = new QHBoxLayout;
  for (QPushButton* const each : {print_, save_, blink_, open_}) outputs->addWidget(each);
  outputs->addStretch();
  column->addLayout(outputs);
  column->addWidget(wrappedLabel(
      tr("The page that blinks is for a screen. It gives the intrinsics of an event camera at rest."), "hint",
      this));
  column->addWidget(after_printing_, 0, Qt::AlignLeft);
  column->addWidget(makeMeasure());
  return column;
}

QWidget* PrintBoardDialog::makeMeasure() {
  constexpr int kForm_px = 280;
  auto* const group = new QWidget(this);
  auto* const layout = new QVBoxLayout(group);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(wrappedLabel(
      tr("The line below the board must be 100 mm long. Glue the print to a flat plate, "
         "and measure it. A relative error of the board's size causes the same relative error of "
         "translations."),
      "hint", group));
  auto* const column = new QVBoxLayout;
  column->addWidget(take_, 0, Qt::AlignLeft);
  column->addWidget(taken_);
  column->addStretch(1);
  auto* const row = new QHBoxLayout;
  row->setSpacing(14);
  measured_->setFixedWidth(kForm_px);
  row->addWidget(measured_);
  row->addLayout(column, 1);
  layout->addLayout(row);
  group->hide();
  connect(after_printing_, &QToolButton::toggled, group, &QWidget::setVisible);
  connect(measured_, &MeasuredForm::changed, taken_, &QLabel::clear);
  return group;
}

void PrintBoardDialog::makeButtons() {
  print_ = sheetButton("board", tr("&Print..."), tr("Send to a printer, at 100 %"), this);
  save_ = sheetButton("save", tr("&Save..."), tr("Save to a PDF, SVG or PNG file, to scale"), this);
  auto* const formats = new QMenu(save_);
  for (const char* const ending : {"pdf", "svg", "png"})
    formats->addAction(QString(ending).toUpper() + "...", this, [this, ending] { chooseFile(ending); });
  save_->setMenu(formats);
  blink_ =
      sheetButton("screen", tr("Page that &blinks..."),
                  tr("Web page that flashes the board on a screen, for the intrinsics of an event camera at "
                     "rest"),
                  this);
  open_ = sheetButton("open", tr("&Open"), tr("Opens the written file"), this);
  take_ =
      sheetButton("done", tr("&Use this board"),
                  tr("Use this board, with the measured length, in the session; without a session, in the "
                     "next recording that is opened"),
                  this);
  shrink_ = sheetButton("board", tr("Use a smaller spacing"),
                        tr("Change all sizes in proportion, so that the board fits the paper"), this);
  connect(shrink_, &QPushButton::clicked, this, [this] {
    if (fitting_) setBoard(Board(*fitting_));
  });
  shrink_->setObjectName("shrink_board");
  save_->setObjectName("save_board");
  take_->setObjectName("take_board");
  open_->setObjectName("open_board");
  save_->setProperty("primary", true);
  save_->setIcon(icon("save", QPalette::HighlightedText));
  open_->hide();
  connect(print_, &QPushButton::clicked, this, &PrintBoardDialog::print);
  connect(blink_, &QPushButton::clicked, this, [this] { chooseFile("html"); });
  connect(open_, &QPushButton::clicked, this, [this] {
    if (!QDesktopServices::openUrl(QUrl::fromLocalFile(written_file_)))
      say(tr("No program on this computer opens %1").arg(written_file_), true);
  });
  connect(take_, &QPushButton::clicked, this, [this] { emit boardTaken(board_, measured_->measured()); });
}

SheetOptions PrintBoardDialog::sheetOptions() const {
  SheetOptions options;
  options.margin_m = margin_mm_->value() / kSheetMmPerM;
  if (const auto index = static_cast<std::size_t>(paper_->currentIndex()); index < papers().size())
    options.paper = papers()[index];
  return options;
}

TagPrint PrintBoardDialog::tagPrint() const {
  return {border_bits_->currentIndex() + 1, markers_->currentText().toStdString()};
}

void PrintBoardDialog::setBoard(const Board& board) {
  board_ = board;
  measured_->setBoard(board_);
  showBoard();
}

void PrintBoardDialog::showBoard() {
  form_->setBoard(board_, {});
  paper_form_->setRowVisible(border_bits_, board_.type == BoardType::AprilGrid);
  paper_form_->setRowVisible(markers_, board_.type == BoardType::Charuco);
  alignLabels({form_->findChild<QFormLayout*>(), paper_form_});
  auto* const numbers = form_->findChild<QScrollArea*>();
  numbers->setFixedHeight(numbers->widget()->sizeHint().height());  // all rows are visible
  taken_->clear();
  fitting_.reset();
  try {
    sheet_ = layOut(board_, sheetOptions(), tagPrint());
    say(tr("Sheet of %1 mm x %2 mm. Print it at 100 %.")
            .arg(sheet_->width_mm, 0, 'f', 0)
            .arg(sheet_->height_mm, 0, 'f', 0),
        false);
  } catch (const CalibrationError& error) {
    sheet_.reset();
    say(textOf(error), true);
    fitting_ = boardThatFits(board_, sheetOptions(), tagPrint());
  }
  shrink_->setVisible(fitting_.has_value());
  if (fitting_)
    shrink_->setText(
        tr("&Use a spacing of %1 mm").arg(fromCore(shortNumber(kSheetMmPerM * fitting_->spacing_m))));
  half_turn_->setVisible(sheet_ && board_.hasHalfTurnAmbiguity());
  preview_->setSheet(sheet_);
  open_->hide();
  for (QPushButton* const output : {print_, save_, blink_, take_}) output->setEnabled(sheet_.has_value());
}

void PrintBoardDialog::chooseFile(const QString& ending) {
  const QString folder = QSettings().value(kBoardFolderKey, QDir::homePath()).toString();
  const QString file =
      QFileDialog::getSaveFileName(this, tr("Save the board"), QDir(folder).filePath("board." + ending),
                                   QString("%1 (*.%2)").arg(ending.toUpper(), ending));
  if (!file.isEmpty()) saveTo(file);
}

void PrintBoardDialog::saveTo(const QString& file) {
  const QString ending = QFileInfo(file).suffix().toLower();
  if (!QStringList{"pdf", "svg", "png", "html"}.contains(ending))
    return say(tr("%1 was not written. Choose a name that ends with .pdf, .svg or .png")
                   .arg(QFileInfo(file).fileName()),
               true);
  say(tr("Writing %1...").arg(QFileInfo(file).fileName()), false);
  QSettings().setValue(kBoardFolderKey, QFileInfo(file).path());
  emit fileRequested(
      {file, board_, sheetOptions(), tagPrint(), static_cast<double>(resolution_dpi_->value())});
}

void PrintBoardDialog::setWritten(const QString& file) {
  written_file_ = file;
  say(file.endsWith(".html", Qt::CaseInsensitive)
          ? tr("%1 is written. Open it on the screen that is to flash, and enter the measured length: the "
               "page "
               "shows the "
               "board's numbers.")
                .arg(file)
          : tr("%1 is written. Print it at 100 %, and check the line below the board: 100 mm.").arg(file),
      false);
  open_->show();
  after_printing_->setChecked(true);
}

void PrintBoardDialog::setTaken(bool in_session) {
  taken_->setText(!in_session             ? tr("The board will be used for the next recording that you open.")
                  : measured_->measured() ? tr("The session uses this board, with its measured length.")
                                          : tr("The session uses this board, with its nominal size."));
}

void PrintBoardDialog::setNotWritten(const QString& why) {
  say(why, true);
}

void PrintBoardDialog::print() {
  QPrinter printer(QPrinter::HighResolution);
  const bool lying = sheet_->width_mm > sheet_->height_mm;
  const QSizeF upright_mm(std::min(sheet_->width_mm, sheet_->height_mm),
                          std::max(sheet_->width_mm, sheet_->height_mm));
  printer.setFullPage(true);  // to scale, regardless of the printer's margins
  printer.setPageLayout({QPageSize(upright_mm, QPageSize::Millimeter),
                         lying ? QPageLayout::Landscape : QPageLayout::Portrait, QMarginsF()});
  QPrintDialog dialog(&printer, this);
  if (dialog.exec() != QDialog::Accepted) return;
  QPainter painter(&printer);
  const double dots_per_mm = printer.resolution() / kMmPerInch;
  painter.scale(dots_per_mm, dots_per_mm);
  paintSheet(painter, *sheet_);
  const bool sent = painter.end();
  say(sent ? tr("Sent to the printer. Check the line below the board: 100 mm.")
           : tr("The printer did not accept the sheet. Save a PDF and print it."),
      !sent);
  if (sent) after_printing_->setChecked(true);
}

void PrintBoardDialog::say(const QString& text, bool problem) {
  message_->setText(text);
  message_->setProperty("role", problem ? "problem" : "hint");
  message_->setStyleSheet(problem ? QString("color: %1").arg(theme().bad.name()) : QString());
}

}  // namespace evical::ui

namespace evical::ui {
namespace {

void paintBox(QPainter& painter, const SheetBox& box) {
  painter.fillRect(QRectF(box.x_mm, box.y_mm, box.width_mm, box.height_mm),
                   box.bright ? Qt::white : Qt::black);
}

}  // namespace

void paintSheet(QPainter& painter, const BoardSheet& sheet) {
  painter.fillRect(QRectF(0.0, 0.0, sheet.width_mm, sheet.height_mm), Qt::white);
  for (const SheetBox& box : sheet.boxes) paintBox(painter, box);
  painter.setPen(Qt::NoPen);
  painter.setBrush(sheet.bright_circles ? Qt::white : Qt::black);
  for (const Eigen::Vector2d& centre_mm : sheet.centres_mm)
    painter.drawEllipse(QPointF(centre_mm.x(), centre_mm.y()), sheet.radius_mm, sheet.radius_mm);
  paintBox(painter, sheet.ruler);
  // Fonts have integer pixel sizes, so a large font is scaled down.
  constexpr int kLetter_px = 100;
  QFont font("Helvetica");
  font.setPixelSize(kLetter_px);
  painter.save();
  painter.translate(sheet.caption_x_mm, sheet.caption_y_mm);
  painter.scale(sheet.text_size_mm / kLetter_px, sheet.text_size_mm / kLetter_px);
  painter.setFont(font);
  painter.setPen(Qt::black);
  painter.drawText(QPointF(0.0, 0.0), QString::fromStdString(sheet.caption));
  painter.restore();
}

SheetPreview::SheetPreview(QWidget* parent) : QWidget(parent) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  setAccessibleName(tr("Preview of the sheet"));
}

void SheetPreview::setSheet(std::optional<BoardSheet> sheet) {
  sheet_ = std::move(sheet);
  setToolTip(sheet_ ? tr("Sheet of %1 mm x %2 mm, as printed")
                          .arg(sheet_->width_mm, 0, 'f', 0)
                          .arg(sheet_->height_mm, 0, 'f', 0)
                    : tr("No preview: the board cannot be printed"));
  setAccessibleDescription(sheet_ ? QString::fromStdString(sheet_->caption) : toolTip());
  update();
}

void SheetPreview::paintEvent(QPaintEvent*) {
  if (!sheet_) return;
  constexpr double kMargin_px = 10.0;
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double px_per_mm = std::min((width() - 2.0 * kMargin_px) / sheet_->width_mm,
                                    (height() - 2.0 * kMargin_px) / sheet_->height_mm);
  painter.translate(0.5 * (width() - px_per_mm * sheet_->width_mm),
                    0.5 * (height() - px_per_mm * sheet_->height_mm));
  painter.scale(px_per_mm, px_per_mm);
  paintSheet(painter, *sheet_);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(theme().grid_line, 1.0 / px_per_mm));
  painter.drawRect(QRectF(0.0, 0.0, sheet_->width_mm, sheet_->height_mm));
}

}  // namespace evical::ui
