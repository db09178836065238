// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/document/printed_board.h"

#include "core/base/error.h"
#include "core/pipeline/session/session_boards.h"

#include <QSettings>

#include <algorithm>

namespace evical::ui {
namespace {

const char* const kGroup = "printed_board";

}  // namespace

void rememberPrintedBoard(const PrintedBoard& printed) {
  QSettings settings;
  settings.remove(kGroup);
  settings.beginGroup(kGroup);
  settings.setValue("type", boardTypeName(printed.board.type));
  settings.setValue("rows", printed.board.rows);
  settings.setValue("cols", printed.board.cols);
  settings.setValue("spacing_m", printed.board.spacing_m);
  settings.setValue("radius_m", printed.board.radius_m);
  settings.setValue("tag_size_m", printed.board.tag_size_m);
  settings.setValue("first_tag", printed.board.first_tag);
  settings.setValue("bright", printed.board.circles == CircleShade::Bright);
  if (!printed.measured) return;
  settings.setValue("measured/spacings", printed.measured->spacings);
  settings.setValue("measured/length_m", printed.measured->length_m);
  settings.setValue("measured/std_m", printed.measured->std_m);
}

std::optional<PrintedBoard> lastPrintedBoard() {
  QSettings settings;
  settings.beginGroup(kGroup);
  const std::string type = settings.value("type").toString().toStdString();
  const auto known = std::find(kPatternNames.begin(), kPatternNames.end(), type);
  if (known == kPatternNames.end()) return std::nullopt;
  PrintedBoard printed;
  printed.board.type = static_cast<BoardType>(known - kPatternNames.begin());
  printed.board.rows = settings.value("rows").toInt();
  printed.board.cols = settings.value("cols").toInt();
  printed.board.spacing_m = settings.value("spacing_m").toDouble();
  printed.board.radius_m = settings.value("radius_m").toDouble();
  printed.board.tag_size_m = settings.value("tag_size_m").toDouble();
  printed.board.first_tag = settings.value("first_tag").toInt();
  printed.board.circles = settings.value("bright").toBool() ? CircleShade::Bright : CircleShade::Dark;
  if (settings.contains("measured/spacings"))
    printed.measured = MeasuredLength{settings.value("measured/spacings").toInt(),
                                      settings.value("measured/length_m").toDouble(),
                                      settings.value("measured/std_m").toDouble()};
  try {
    validate(printed.board);
    if (printed.measured) validate(*printed.measured, printed.board);
  } catch (const CalibrationError&) {
    return std::nullopt;  // the settings were changed outside of the program
  }
  return printed;
}

void setPrintedBoard(const PrintedBoard& printed, Session& session) {
  setBoardAt(0, printed.board, session);
  setMeasuredAt(0, printed.measured, session);
}

}  // namespace evical::ui
