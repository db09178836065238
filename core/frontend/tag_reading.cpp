#include "core/frontend/tag_reading.h"

#include "core/geometry/marker_bits.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace evical {
namespace {

constexpr int kTurns = 4;

// Boundaries between the bits of a tag, its border included: lines across x, then across y, each with its
// places.
class Boundaries {
 public:
  explicit Boundaries(int side) : side_(side) {}

  int side() const { return side_; }
  std::size_t count() const { return static_cast<std::size_t>(2 * side_ * (side_ + 1)); }
  std::size_t at(int axis, int line, int along) const {
    return static_cast<std::size_t>((axis * (side_ + 1) + line) * side_ + along);
  }

 private:
  int side_;
};

// By boundary: 1 if the paper is after it, -1 if before, 0 without an edge.
std::vector<std::int8_t> edgesOf(const PatternBits& bits, const Boundaries& boundaries) {
  const int side = boundaries.side();
  std::vector<std::int8_t> edges(boundaries.count());
  for (int axis = 0; axis < 2; ++axis) {
    for (int along = 0; along < side; ++along) {
      const auto isBright = [&](int across) {
        if (across < 0 || across >= side) return false;
        const auto a = static_cast<std::size_t>(across), b = static_cast<std::size_t>(along);
        return axis == 0 ? bits[b][a] : bits[a][b];
      };
      for (int line = 0; line <= side; ++line)
        edges[boundaries.at(axis, line, along)] =
            static_cast<std::int8_t>(static_cast<int>(isBright(line)) - static_cast<int>(isBright(line - 1)));
    }
  }
  return edges;
}

// Crossings at the boundaries of one square's bits: with the paper after them minus before, and all.
struct SquareCrossings {
  std::vector<int> after, all;
  int count = 0;

  // Crossings that a tag explains, without those that contradict it.
  int agreementWith(const std::vector<std::int8_t>& edges) const {
    int sum = 0;
    for (std::size_t k = 0; k < edges.size(); ++k) sum += edges[k] != 0 ? edges[k] * after[k] : -all[k];
    return sum;
  }
};

// Tags of one family with one width of border, that may be on the board.
struct TagFamily {
  TagPrint print;
  std::vector<PatternBits> tags;
};

std::vector<TagFamily> familiesOf(const Board& board) {
  std::vector<TagFamily> families;
  if (board.type == BoardType::AprilGrid) {
    for (const int border_bits : {2, 1})
      families.push_back({{.border_bits = border_bits}, firstTags(kTagFamilySize)});
    return families;
  }
  for (const std::string& markers : markerNames())
    families.push_back({{.markers = markers},
                        firstMarkers(markers, std::min(board.rows * board.cols, markerCount(markers)))});
  return families;
}

// Agreement of each square of the board with each tag of a family in each rotation.
class TagScores {
 public:
  TagScores(const std::vector<BoardCrossing>& crossings, const Board& board, const TagFamily& family)
      : boundaries_(static_cast<int>(family.tags.front().size())),
        tags_(static_cast<int>(family.tags.size())),
        squares_(static_cast<std::size_t>(board.rows * board.cols)) {
    for (SquareCrossings& square : squares_) {
      square.after.resize(boundaries_.count());
      square.all.resize(boundaries_.count());
    }
    const int border_bits = board.type == BoardType::AprilGrid ? family.print.border_bits : 1;
    for (const BoardCrossing& crossing : crossings) add(crossing, board, border_bits);
    for (const PatternBits& tag : family.tags) {
      for (int turn = 0; turn < kTurns; ++turn) {
        const std::vector<std::int8_t> edges = edgesOf(turned(tag, turn), boundaries_);
        for (const SquareCrossings& square : squares_) scores_.push_back(square.agreementWith(edges));
      }
    }
    for (const SquareCrossings& square : squares_) count_ += square.count;
  }

  int tags() const { return tags_; }
  int count() const { return count_; }
  bool isInView(int square) const {
    constexpr int kFewest = 12;
    return squares_[static_cast<std::size_t>(square)].count >= kFewest;
  }
  // `square` row by row from the top left, `turn` clockwise. 0 for a tag that does not exist.
  int of(int square, int tag, int turn) const {
    if (tag < 0 || tag >= tags_) return 0;
    return scores_[static_cast<std::size_t>(tag * kTurns + turn) * squares_.size() +
                   static_cast<std::size_t>(square)];
  }

 private:
  void add(const BoardCrossing& crossing, const Board& board, int border_bits) {
    constexpr double kNearest = 0.4;  // of a bit
    const bool markers = board.type == BoardType::Charuco;
    const double margin_m = markers ? 0.5 * (board.spacing_m - board.tag_size_m) : 0.0,
                 bit_m = board.tag_size_m / (boundaries_.side() + 2 * border_bits);
    const Eigen::Vector2d at_m = crossing.at_m.array() + (markers ? board.spacing_m : 0.0);
    const Eigen::Vector2d square = (at_m / board.spacing_m).array().floor();
    if (square.minCoeff() < 0.0 || square.x() >= board.cols || square.y() >= board.rows) return;
    const Eigen::Vector2d place =
        (at_m - board.spacing_m * square).array() / bit_m - margin_m / bit_m - border_bits;
    SquareCrossings& crossings = squares_[static_cast<std::size_t>(square.y() * board.cols + square.x())];
    for (int axis = 0; axis < 2; ++axis) {
      const int direction = axis == 0 ? crossing.along_x : crossing.along_y;
      const auto line = static_cast<int>(std::lround(place[axis])),
                 along = static_cast<int>(std::floor(place[1 - axis]));
      if (direction < 0 || line < 0 || line > boundaries_.side() || along < 0 ||
          along >= boundaries_.side() ||
          std::abs(place[axis] - line) > std::min(crossing.tolerance_m / bit_m, kNearest))
        continue;
      const std::size_t at = boundaries_.at(axis, line, along);
      crossings.after[at] += direction % 2 == 0 ? 1 : -1;
      ++crossings.all[at];
      ++crossings.count;
    }
  }

  Boundaries boundaries_;
  int tags_, count_ = 0;
  std::vector<SquareCrossings> squares_;  // row by row from the top left
  std::vector<int> scores_;
};

// A way to number the squares of the board in its placement: by order, rotation of the tags, and that of the
// board.
struct Numbering {
  TagPrint print;
  int turn = 0;              // of the tags in the placement, clockwise
  std::vector<int> squares;  // with the first tag, the second, ...; row by row from the top left

  int count() const { return static_cast<int>(squares.size()); }
  int square(int k) const { return squares[static_cast<std::size_t>(k)]; }
};

// Place, row by row from the top left, of a square on a board that is turned clockwise.
int turnedSquare(const Board& board, BoardSquare square, int turn) {
  if (turn >= 2) square = {board.rows - 1 - square.row, board.cols - 1 - square.col};
  return turn % 2 == 0 ? square.row * board.cols + square.col
                       : square.col * board.cols + board.rows - 1 - square.row;
}

// The prints of a family, with the squares of the tags in their order.
std::vector<std::pair<TagPrint, std::vector<BoardSquare>>> printsOf(const Board& board, TagPrint print) {
  std::vector<std::pair<TagPrint, std::vector<BoardSquare>>> prints;
  if (board.type == BoardType::AprilGrid) {
    for (const TagLayout& layout : distinctLayouts(board)) {
      print.order = layout.order;
      print.quarter_turns = (kTurns - layout.quarter_turns) % kTurns;
      auto& squares = prints.emplace_back(print, std::vector<BoardSquare>()).second;
      for (int k = 0; k < board.rows * board.cols; ++k) {
        const int square = squareOf(board, layout.order, k);
        squares.push_back({board.rows - 1 - square / board.cols, square % board.cols});
      }
    }
    return prints;
  }
  for (const bool first_is_bright : {false, true}) {
    print.first_is_bright = first_is_bright;
    for (print.quarter_turns = 0; print.quarter_turns < kTurns; ++print.quarter_turns)
      prints.emplace_back(print, charucoMarkers(board, first_is_bright));
  }
  return prints;
}

std::vector<Numbering> numberingsOf(const Board& board, const TagPrint& of_family) {
  std::vector<Numbering> numberings;
  const bool is_square = board.rows == board.cols;
  for (const auto& [print, squares] : printsOf(board, of_family)) {
    for (int turn = 0; turn < kTurns; turn += is_square ? 1 : 2) {
      Numbering& numbering =
          numberings.emplace_back(Numbering{print, (print.quarter_turns + turn) % kTurns, {}});
      for (const BoardSquare& square : squares)
        numbering.squares.push_back(turnedSquare(board, square, turn));
    }
  }
  return numberings;
}

// The numbers that agree best with the crossings, of those that were tried.
class BestNumbers {
 public:
  // The board's placement may be off by some rows, so that its first tag does not exist.
  void tryAll(const TagScores& scores, const Numbering& numbering) {
    for (int first = -numbering.count(); first < scores.tags(); ++first) {
      int value = 0;
      for (int k = 0; k < numbering.count(); ++k)
        value += scores.of(numbering.square(k), first + k, numbering.turn);
      second_value_ = std::max(second_value_, std::min(value, value_));
      if (value > value_) keep(value, scores, numbering, first);
    }
  }

  std::optional<TagReading> reading() const {
    constexpr double kMinAgreement = 0.1;  // of the crossings at bits
    constexpr double kLargestSecond = 0.7;
    const bool is_clear = value_ > kMinAgreement * crossings_ && second_value_ < kLargestSecond * value_;
    return is_clear && best_.smallest >= 0 && best_.smallest <= best_.largest ? std::optional(best_)
                                                                              : std::nullopt;
  }

 private:
  void keep(int value, const TagScores& scores, const Numbering& numbering, int first) {
    value_ = value;
    crossings_ = scores.count();
    best_ = {numbering.print, scores.tags(), -1};
    for (int k = 0; k < numbering.count(); ++k) {
      if (!scores.isInView(numbering.square(k))) continue;
      best_.smallest = std::min(best_.smallest, first + k);
      best_.largest = std::max(best_.largest, first + k);
    }
  }

  TagReading best_;
  int value_ = 0, second_value_ = 0, crossings_ = 0;
};

}  // namespace

std::optional<TagReading> readTags(const std::vector<BoardCrossing>& crossings, const Board& board) {
  BestNumbers best;
  for (const TagFamily& family : familiesOf(board)) {
    const TagScores scores(crossings, board, family);
    for (const Numbering& numbering : numberingsOf(board, family.print)) best.tryAll(scores, numbering);
  }
  return best.reading();
}

}  // namespace evical
