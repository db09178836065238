// SPDX-License-Identifier: GPL-3.0-or-later
// Dialog that prints a board: numbers, paper, preview; output to a file, a printer, or a blinking page; then
// the measured size of the print, for the session.
#pragma once

#include "core/geometry/board.h"
#include "core/printing/board_sheet.h"

#include <QDialog>
#include <QWidget>

#include <optional>

class QComboBox;
class QDialogButtonBox;
class QFormLayout;
class QLabel;
class QPushButton;
class QSpinBox;
class QToolButton;

namespace evical::ui {

class BoardForm;
class MeasuredForm;
class NumberField;
class SheetPreview;

// Letter or A4, by the desktop's country.
const Paper& usualPaper();

// Output file: .pdf, .svg, .png, or .html (blinking).
struct BoardFile {
  QString path;
  Board board;
  SheetOptions options;
  TagPrint print;
  double resolution_dpi = 300.0;  // of a .png
};
// Takes long for a large .png. Throws CalibrationError.
void writeBoardFile(const BoardFile& file);

class PrintBoardDialog : public QDialog {
  Q_OBJECT

 public:
  PrintBoardDialog(const Board& board, QWidget* parent);

  const Board& board() const { return board_; }
  SheetOptions sheetOptions() const;
  TagPrint tagPrint() const;

  void saveTo(const QString& file);  // format by the file's extension
  void setWritten(const QString& file);
  void setNotWritten(const QString& why);
  void setTaken(bool in_session);  // after boardTaken(); else for the next recording

 signals:
  void fileRequested(const evical::ui::BoardFile& file);
  // The session uses this board from now on, with its measured length.
  void boardTaken(const evical::Board& board, const std::optional<evical::MeasuredLength>& measured);

 private:
  QWidget* makeFields();
  QWidget* makePaper();
  QLayout* makeOutputs();
  QWidget* makeMeasure();
  void makeButtons();
  void chooseFile(const QString& ending);
  void print();
  void setBoard(const Board& board);
  void showBoard();
  void say(const QString& text, bool problem);

  Board board_;
  std::optional<BoardSheet> sheet_;
  std::optional<Board> fitting_;  // offered if board_ is too large for the paper
  BoardForm* form_;
  QFormLayout* paper_form_;
  QComboBox *paper_, *markers_, *border_bits_;
  NumberField* margin_mm_;
  QSpinBox* resolution_dpi_;
  SheetPreview* preview_;
  QLabel *message_, *half_turn_, *taken_;
  MeasuredForm* measured_;
  QToolButton* after_printing_;  // shows the last step
  QPushButton *save_, *blink_, *print_, *open_, *take_, *shrink_;
  QString written_file_;
};

}  // namespace evical::ui

// Printed sheet with the layout of core, on the screen and on a printer.

class QPainter;

namespace evical::ui {

// In millimetres of the sheet, in the painter's current transform.
void paintSheet(QPainter& painter, const BoardSheet& sheet);

class SheetPreview : public QWidget {
  Q_OBJECT

 public:
  explicit SheetPreview(QWidget* parent = nullptr);

  void setSheet(std::optional<BoardSheet> sheet);  // none: empty preview
  QSize sizeHint() const override { return {420, 420}; }
  QSize minimumSizeHint() const override { return {220, 160}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::optional<BoardSheet> sheet_;
};

}  // namespace evical::ui
