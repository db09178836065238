#include "app/command_line.h"
#include "app/commands.h"
#include "app/output.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/printing/blink_page.h"
#include "core/printing/board_drawing.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace evical {
namespace {

struct BoardArguments {
  Board board;
  BoardType type = BoardType::AsymmetricCircles;
  std::string circles = "dark";
  std::optional<double> radius_m, tag_size_m;
  TagPrint print;
  SheetOptions sheet;
  double resolution_dpi = 300.0;
  bool blink = false;
  std::filesystem::path output;
};

// What is not said is what suits the board: Kalibr's gaps between tags, and markers with some room.
Board completeBoard(const BoardArguments& arguments) {
  Board board = arguments.board;
  board.type = arguments.type;
  board.circles = arguments.circles == "bright" ? CircleShade::Bright : CircleShade::Dark;
  board.radius_m = arguments.radius_m.value_or(board.hasCircles() ? board.radius_m : 0.0);
  constexpr double kTagOfGrid = 1.0 / 1.3, kMarkerOfSquare = 0.75;
  if (board.type == BoardType::AprilGrid)
    board.tag_size_m = arguments.tag_size_m.value_or(kTagOfGrid * board.spacing_m);
  else if (board.type == BoardType::Charuco)
    board.tag_size_m = arguments.tag_size_m.value_or(kMarkerOfSquare * board.spacing_m);
  else if (arguments.tag_size_m)
    throw badInput("--tag-size-m", "is of aprilgrid and charuco, and this board has no tags", "Leave it out");
  return board;
}

void writeBlinkPage(const Board& board, const BoardArguments& arguments) {
  if (arguments.output.extension() != ".html")
    throw badInput(arguments.output.string(), "is no .html file, as a page that blinks must be",
                   "Name the file board.html");
  writeFileWhole(arguments.output, blinkPage(board, arguments.sheet.margin_m, arguments.print));
  print(
      "{}: open it in a browser on the screen that is to flash; it asks for a length and says what the "
      "session needs. "
      "For 'evical intrinsics' of event cameras only.\n",
      arguments.output.string());
}

void drawBoard(const BoardArguments& arguments) {
  const Board board = completeBoard(arguments);
  const std::string extension = arguments.output.extension().string();
  if (arguments.blink) return writeBlinkPage(board, arguments);
  if (extension == ".pdf")
    writeFileWhole(arguments.output, boardPdf(board, arguments.sheet, arguments.print));
  else if (extension == ".svg")
    writeFileWhole(arguments.output, boardSvg(board, arguments.sheet, arguments.print));
  else if (extension == ".png")
    writeFileWhole(arguments.output,
                   boardPng(board, arguments.resolution_dpi, arguments.sheet, arguments.print));
  else
    throw badInput(
        arguments.output.string(), "is neither .pdf, .svg nor .png",
        extension == ".html"
            ? "A page that flashes the board is made with --blink; print board.pdf, board.svg or board.png"
            : "Name the file board.pdf, board.svg or board.png");
  print("{}: print at 100 %, and check the line below the board: 100 mm\n", arguments.output.string());
  if (board.hasHalfTurnAmbiguity())
    print(
        "This board looks the same when turned by 180 degrees: it does for intrinsics only, not with an "
        "IMU.\n");
}

std::map<std::string, Paper> papersByName() {
  std::map<std::string, Paper> by_name;
  for (const Paper& paper : papers()) by_name[paper.name] = paper;
  return by_name;
}

std::map<std::string, BoardType> typesByName() {
  std::map<std::string, BoardType> types;
  for (std::size_t type = 0; type < kPatternNames.size(); ++type)
    types[kPatternNames[type]] = static_cast<BoardType>(type);
  return types;
}

template <class Value>
std::vector<std::string> namesOf(const std::map<std::string, Value>& by_name) {
  std::vector<std::string> names;
  for (const auto& [name, value] : by_name) names.push_back(name);
  return names;
}

}  // namespace

void addBoardCommand(Command& app, int& exit_code) {
  const auto arguments = std::make_shared<BoardArguments>();
  Command command = app.command("board", "A printable target, true to scale");
  command
      .option("--rows", arguments->board.rows,
              "Of circles, of a checkerboard's inner corners, of tags, of a ChArUco board's squares")
      .showDefault();
  command.option("--cols", arguments->board.cols, "Circles, corners, tags or squares in a row").showDefault();
  command
      .option("--spacing-m", arguments->board.spacing_m,
              "Between two rows of circles; a square's edge; from one tag to the next. Metres")
      .showDefault();
  command.option("--radius-m", arguments->radius_m, "Of a circle, metres (0.02)");
  command.option("--tag-size-m", arguments->tag_size_m,
                 "Black edge of a tag, metres (aprilgrid: spacing / 1.3; charuco: 0.75 spacing)");
  command.option("--tag-border", arguments->print.border_bits, "Of an AprilGrid's tags, bits: Kalibr's is 2")
      .between(1, 2)
      .showDefault();
  command.option("--markers", arguments->print.markers, "ArUco dictionary of a ChArUco board, by its bits")
      .oneOf(markerNames())
      .showDefault();
  command
      .option(
          "--type", [arguments](const std::string& name) { arguments->type = typesByName().at(name); },
          "Pattern")
      .oneOf(namesOf(typesByName()))
      .defaultText(boardTypeName(arguments->type));
  command.option("--circles", arguments->circles, "Their shade").oneOf({"dark", "bright"}).showDefault();
  command.option("--margin-m", arguments->sheet.margin_m, "Around the outermost edges, metres").showDefault();
  command
      .option(
          "--paper",
          [arguments](const std::string& name) { arguments->sheet.paper = papersByName().at(name); },
          "Sheet of this size with the board in its middle; else as large as the board needs")
      .oneOf(namesOf(papersByName()));
  command.option("--dpi", arguments->resolution_dpi, "Of a .png, pixels an inch").showDefault();
  command.flag("--blink", arguments->blink,
               "A page that flashes the board on a screen, for the intrinsics of event cameras: .html");
  command.option("-o,--output", arguments->output, "The file: .pdf, .svg or .png, or .html with --blink")
      .required();
  command.action([arguments, &exit_code] {
    drawBoard(*arguments);
    exit_code = kDone;
  });
}

}  // namespace evical
