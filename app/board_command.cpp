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

// Defaults that depend on the type: Kalibr's gaps between tags, and a margin around markers.
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
    throw badInput("--tag-size-m", "applies to aprilgrid and charuco only",
                   "Remove it for this type of board");
  return board;
}

void writeBlinkPage(const Board& board, const BoardArguments& arguments) {
  if (arguments.output.extension() != ".html")
    throw badInput(arguments.output.string(), "is not an .html file, which --blink needs",
                   "Name the file board.html");
  writeFileWhole(arguments.output, blinkPage(board, arguments.sheet.margin_m, arguments.print));
  print(
      "{}: open it in a browser on the screen that flashes the board, and enter the measured length: it "
      "shows the "
      "numbers for the session. "
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
    throw badInput(arguments.output.string(), "is not a .pdf, .svg or .png file",
                   extension == ".html" ? "Add --blink for a page that flashes the board, or name the file "
                                          "board.pdf, board.svg or board.png"
                                        : "Name the file board.pdf, board.svg or board.png");
  print("{}: print it at 100 %, and check that the line below the board is 100 mm long\n",
        arguments.output.string());
  if (board.hasHalfTurnAmbiguity())
    print(
        "This board looks the same when rotated by 180 degrees: it suits intrinsics only, not calibrations "
        "with an "
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
  Command command = app.command("board", "Draw a calibration target to scale, for a printer or a screen");
  command
      .option("--rows", arguments->board.rows,
              "Number of rows: circles, inner corners of a checkerboard, tags, or squares of a ChArUco board")
      .showDefault();
  command.option("--cols", arguments->board.cols, "Number of circles, corners, tags or squares in a row")
      .showDefault();
  command
      .option("--spacing-m", arguments->board.spacing_m,
              "Distance of two rows of circles, a square's edge, or distance of two tags, metres")
      .showDefault();
  command.option("--radius-m", arguments->radius_m, "Radius of a circle, metres (0.02)");
  command.option("--tag-size-m", arguments->tag_size_m,
                 "Edge of a tag's black square, metres (aprilgrid: spacing / 1.3; charuco: 0.75 spacing)");
  command.option("--first-tag", arguments->board.first_tag, "Number of an AprilGrid's first tag")
      .between(0, 586)
      .showDefault();
  command
      .option("--tag-border", arguments->print.border_bits,
              "Width of the black border of an AprilGrid's tags, bits (2 in Kalibr)")
      .between(1, 2)
      .showDefault();
  command
      .option("--markers", arguments->print.markers, "ArUco dictionary of a ChArUco board, by number of bits")
      .oneOf(markerNames())
      .showDefault();
  command
      .option(
          "--type", [arguments](const std::string& name) { arguments->type = typesByName().at(name); },
          "Pattern of the board")
      .oneOf(namesOf(typesByName()))
      .defaultText(boardTypeName(arguments->type));
  command.option("--circles", arguments->circles, "Shade of the circles")
      .oneOf({"dark", "bright"})
      .showDefault();
  command.option("--margin-m", arguments->sheet.margin_m, "White margin around the pattern, metres")
      .showDefault();
  command
      .option(
          "--paper",
          [arguments](const std::string& name) { arguments->sheet.paper = papersByName().at(name); },
          "Paper, with the board in the middle (Letter: 215.9 mm x 279.4 mm); by default the sheet has the "
          "size of the board")
      .oneOf(namesOf(papersByName()));
  command.option("--dpi", arguments->resolution_dpi, "Resolution of a .png, pixels per inch").showDefault();
  command.flag("--blink", arguments->blink,
               "Write an .html page that flashes the board on a screen, for the intrinsics of event cameras");
  command.option("-o,--output", arguments->output, "Output file: .pdf, .svg or .png, or .html with --blink")
      .required();
  command.example(
      "evical board --rows 11 --cols 4 --spacing-m 0.03 --radius-m 0.012 --paper A3 -o board.pdf");
  command.action([arguments, &exit_code] {
    drawBoard(*arguments);
    exit_code = kDone;
  });
}

}  // namespace evical
