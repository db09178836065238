#include "app/commands.h"
#include "app/output.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/report/board_drawing.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

namespace evical {
namespace {

struct Arguments {
  CircleBoard board;
  std::string type = "asymmetric_circles", circles = "dark";
  double margin_m = 0.02;
  std::filesystem::path output;
};

void drawBoard(Arguments arguments) {
  CircleBoard& board = arguments.board;
  board.type =
      arguments.type == "symmetric_circles" ? BoardType::SymmetricCircles : BoardType::AsymmetricCircles;
  board.circles = arguments.circles == "bright" ? CircleShade::Bright : CircleShade::Dark;
  const std::string extension = arguments.output.extension().string();
  if (extension != ".pdf" && extension != ".svg")
    throw badInput(arguments.output.string(), "is neither .pdf nor .svg",
                   "Name the file board.pdf or board.svg");
  writeFileWhole(arguments.output, extension == ".pdf" ? boardPdf(board, arguments.margin_m)
                                                       : boardSvg(board, arguments.margin_m));
  print("{}: print at 100 %, and check the line below the board: 100 mm\n", arguments.output.string());
  if (board.hasHalfTurnAmbiguity())
    print(
        "This board looks the same when turned by 180 degrees: it does for intrinsics only, not with an "
        "IMU.\n");
}

}  // namespace

void addBoardCommand(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("board", "A printable target, true to scale");
  command->add_option("--rows", arguments->board.rows, "Rows of circles")->capture_default_str();
  command->add_option("--cols", arguments->board.cols, "Circles in a row")->capture_default_str();
  command->add_option("--spacing-m", arguments->board.spacing_m, "Between two rows, metres")
      ->capture_default_str();
  command->add_option("--radius-m", arguments->board.radius_m, "Of a circle, metres")->capture_default_str();
  command->add_option("--type", arguments->type, "Pattern")
      ->check(CLI::IsMember({"asymmetric_circles", "symmetric_circles"}))
      ->capture_default_str();
  command->add_option("--circles", arguments->circles, "Their shade")
      ->check(CLI::IsMember({"dark", "bright"}))
      ->capture_default_str();
  command->add_option("--margin-m", arguments->margin_m, "Around the outer circles, metres")
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "The file, .pdf or .svg")->required();
  command->callback([arguments, &exit_code] {
    drawBoard(*arguments);
    exit_code = kDone;
  });
}

}  // namespace evical
