// Printable target, true to scale, as SVG, PDF, or PNG with its resolution: circles, squares or tags, a
// margin around them, and a ruler of 100 mm below them to check the print.
#pragma once

#include "core/geometry/board.h"
#include "core/geometry/printed_pattern.h"

#include <optional>
#include <string>
#include <vector>

namespace evical {

struct Paper {
  std::string name;
  double short_mm = 0.0, long_mm = 0.0;
};
const std::vector<Paper>& papers();  // A4, Letter, and A3 to A0: smallest first

struct SheetOptions {
  double margin_m = 0.02;           // smallest distance between pattern and sheet edges
  std::optional<Paper> paper = {};  // portrait or landscape, as the board fits; absent: fits the board
};

// False if the functions below refuse the board.
bool fitsSheet(const Board& board, const SheetOptions& options);

// The board with all sizes in proportion, as large as the paper permits, its spacing in whole tenths of a
// millimetre. Nothing without a paper, if the board is invalid, or
// if the paper has no space.
std::optional<Board> boardThatFits(const Board& board, const SheetOptions& options, const TagPrint& print);

// Throw CalibrationError (BadInput) if the board is invalid, or too large for the paper or a PDF page (5 m).
std::string boardSvg(const Board& board, const SheetOptions& options = {}, const TagPrint& print = {});
std::string boardPdf(const Board& board, const SheetOptions& options = {}, const TagPrint& print = {});
// Greyscale image: the grey value of a pixel on an edge is its covered share.
std::string boardPng(const Board& board, double resolution_dpi, const SheetOptions& options = {},
                     const TagPrint& print = {});

// The board alone, without ruler and caption: SVG elements in millimetres, for pages with other content. The
// background must be white.
struct BoardPicture {
  double width_mm = 0.0, height_mm = 0.0;
  std::string elements;
};
BoardPicture boardPicture(const Board& board, double margin_m, const TagPrint& print = {});

}  // namespace evical
