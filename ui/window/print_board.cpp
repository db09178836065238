// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/window/print_board.h"

#include "core/base/error.h"
#include "ui/document/printed_board.h"
#include "ui/jobs/latest_job.h"
#include "ui/screens/board/print_board_dialog.h"
#include "ui/screens/recording/how_to_record_dialog.h"
#include "ui/window/workbench.h"

#include <functional>

namespace evical::ui {
namespace {

constexpr int kWidth_px = 960, kHeight_px = 650;  // fits the smallest display

template <class Dialog>
Dialog* opened(QWidget* window) {
  auto* const dialog = window->findChild<Dialog*>();
  if (dialog == nullptr) return nullptr;
  dialog->raise();
  dialog->activateWindow();
  return dialog;
}

// Usual board with the largest spacing, in whole millimetres, that fits the usual paper.
Board boardForUsualPaper() {
  Board board;
  const double radius = board.radius_m / board.spacing_m;
  SheetOptions sheet;
  sheet.paper = usualPaper();
  for (int spacing_mm = 50; !fitsSheet(board, sheet); --spacing_mm) {
    board.spacing_m = 1e-3 * spacing_mm;
    board.radius_m = radius * board.spacing_m;
  }
  return board;
}

// Board of the session, else the last printed one.
Board boardToPrint(const Workbench& workbench) {
  if (workbench.document.hasSession()) return workbench.document.session().board;
  if (const auto last = lastPrintedBoard()) return last->board;
  return boardForUsualPaper();
}

void take(const PrintedBoard& printed, Workbench& workbench) {
  rememberPrintedBoard(printed);
  CalibrationDocument& document = workbench.document;
  if (!document.hasSession()) return;
  Session changed = document.session();
  setPrintedBoard(printed, changed);
  document.edit(changed, QObject::tr("Use the printed board"));
  document.confirmBoard();
}

// Writes in a separate thread, which ends with the dialog.
void writeFor(PrintBoardDialog* dialog) {
  auto* const writing = new LatestJob(OutdatedWork::Delivered, dialog);
  QObject::connect(dialog, &PrintBoardDialog::fileRequested, writing,
                   [dialog, writing](const BoardFile& file) {
                     writing->start([dialog, file](const std::stop_token&) -> std::function<void()> {
                       writeBoardFile(file);
                       return [dialog, path = file.path] { dialog->setWritten(path); };
                     });
                   });
  QObject::connect(writing, &LatestJob::failed, dialog, &PrintBoardDialog::setNotWritten);
}

}  // namespace

void showPrintBoard(QWidget* window, Workbench& workbench) {
  if (opened<PrintBoardDialog>(window) != nullptr) return;
  auto* const dialog = new PrintBoardDialog(boardToPrint(workbench), window);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  writeFor(dialog);
  QObject::connect(dialog, &PrintBoardDialog::boardTaken, dialog,
                   [&workbench, dialog](const Board& board, const std::optional<MeasuredLength>& measured) {
                     take({board, measured}, workbench);
                     dialog->setTaken(workbench.document.hasSession());
                   });
  dialog->resize(kWidth_px, kHeight_px);
  dialog->show();
}

void showHowToRecord(QWidget* window, const QString& motion) {
  auto* dialog = opened<HowToRecordDialog>(window);
  if (dialog == nullptr) {
    dialog = new HowToRecordDialog(motionOfDesktop(), window);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->resize(kWidth_px, kHeight_px - 130);
    dialog->show();
  }
  if (!motion.isEmpty()) dialog->showMotion(motion);
}

}  // namespace evical::ui
