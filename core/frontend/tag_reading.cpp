#include "core/frontend/tag_reading.h"

#include "core/geometry/marker_bits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace evical {
namespace {

constexpr int kTurns = 4;
constexpr auto kSide = static_cast<std::size_t>(kTagSide_bits);

// Crossings at the boundaries between the bits of one tag, its border included, by the direction of the
// paper.
class BitEdges {
 public:
  // `place` in bits, from the tag's first bit.
  void add(const Eigen::Vector2d& place, double tolerance, const BoardCrossing& crossing) {
    addAt(0, place.x(), place.y(), tolerance, crossing.along_x);
    addAt(1, place.y(), place.x(), tolerance, crossing.along_y);
  }

  int count() const { return count_; }

  // Crossings that bits explain, without those that contradict them. `isBright` takes row and column.
  template <typename IsBright>
  int agreementWith(const IsBright& isBright) const {
    int sum = 0;
    for (std::size_t along = 0; along < kSide; ++along) {
      for (std::size_t line = 0; line <= kSide; ++line) {
        for (const std::size_t axis : {0UL, 1UL}) {
          const auto bright = [&](std::size_t across) {
            return axis == 0 ? isBright(along, across) : isBright(across, along);
          };
          const bool before = line > 0 && bright(line - 1), after = line < kSide && bright(line);
          const auto& [plus, minus] = crossings_[axis][line][along];
          sum += before == after ? -plus - minus : (after ? plus - minus : minus - plus);
        }
      }
    }
    return sum;
  }

 private:
  void addAt(std::size_t axis, double across, double along, double tolerance, int direction) {
    const double line = std::round(across);
    if (direction < 0 || std::abs(across - line) > tolerance || line < 0.0 || line > kTagSide_bits ||
        along < 0.0 || along >= kTagSide_bits)
      return;
    ++crossings_[axis][static_cast<std::size_t>(line)][static_cast<std::size_t>(along)]
                [static_cast<std::size_t>(direction & 1)];
    ++count_;
  }

  // By axis across, boundary, place along it, and direction of the paper.
  std::array<std::array<std::array<std::array<int, 2>, kSide>, kSide + 1>, 2> crossings_ = {};
  int count_ = 0;
};

// Agreement of each square of the board with each tag in each rotation.
class TagScores {
 public:
  TagScores(const std::vector<BoardCrossing>& crossings, const Board& board, int border_bits)
      : tags_(firstTags(kTagFamilySize)), edges_(static_cast<std::size_t>(board.rows * board.cols)) {
    const double bit_m = board.tag_size_m / (kTagSide_bits + 2 * border_bits);
    for (const BoardCrossing& crossing : crossings) {
      const Eigen::Vector2d square = (crossing.at_m / board.spacing_m).array().floor();
      if (square.minCoeff() < 0.0 || square.x() >= board.cols || square.y() >= board.rows) continue;
      const Eigen::Vector2d place =
          ((crossing.at_m - board.spacing_m * square) / bit_m).array() - border_bits;
      edges_[static_cast<std::size_t>(square.y() * board.cols + square.x())].add(
          place, std::min(crossing.tolerance_m / bit_m, kNearest), crossing);
    }
    scores_.reserve(edges_.size() * tags_.size() * kTurns);
    for (const BitEdges& edges : edges_) {
      count_ += edges.count();
      for (const TagBits& tag : tags_)
        for (int turn = 0; turn < kTurns; ++turn) scores_.push_back(scoreOf(edges, tag, turn));
    }
  }

  int count() const { return count_; }
  bool isInView(int square) const {
    constexpr int kFewest = 12;
    return edges_[static_cast<std::size_t>(square)].count() >= kFewest;
  }
  // `square` row by row from the top left, `turn` clockwise. 0 for a tag that does not exist.
  int of(int square, int tag, int turn) const {
    if (tag < 0 || tag >= kTagFamilySize) return 0;
    return scores_[(static_cast<std::size_t>(square) * tags_.size() + static_cast<std::size_t>(tag)) *
                       kTurns +
                   static_cast<std::size_t>(turn)];
  }

 private:
  static constexpr double kNearest = 0.4;  // of a bit

  static int scoreOf(const BitEdges& edges, const TagBits& tag, int turn) {
    constexpr int kLast = kTagSide_bits - 1;
    return edges.agreementWith([&](std::size_t y, std::size_t x) {
      int row = static_cast<int>(y), col = static_cast<int>(x);
      for (int k = 0; k < turn; ++k) {
        const int before = row;
        row = kLast - col;
        col = before;
      }
      return tag.isBright(row, col);
    });
  }

  std::vector<TagBits> tags_;
  std::vector<BitEdges> edges_;  // by square, row by row from the top left
  std::vector<int> scores_;
  int count_ = 0;
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

// Place, row by row from the top left, of a square with Kalibr's number on a board that is turned clockwise.
int turnedSquare(const Board& board, int square, int turn) {
  int col = square % board.cols, row = board.rows - 1 - square / board.cols;
  if (turn >= 2) {
    col = board.cols - 1 - col;
    row = board.rows - 1 - row;
  }
  return turn % 2 == 0 ? row * board.cols + col : col * board.cols + board.rows - 1 - row;
}

std::vector<Numbering> numberingsOf(const Board& board, int border_bits) {
  std::vector<Numbering> numberings;
  const bool is_square = board.rows == board.cols;
  for (const TagLayout& layout : distinctLayouts(board)) {
    for (int turn = 0; turn < kTurns; turn += is_square ? 1 : 2) {
      Numbering& numbering = numberings.emplace_back();
      numbering.print.border_bits = border_bits;
      numbering.print.order = layout.order;
      numbering.print.quarter_turns = (kTurns - layout.quarter_turns) % kTurns;
      numbering.turn = (numbering.print.quarter_turns + turn) % kTurns;
      for (int k = 0; k < board.rows * board.cols; ++k) {
        numbering.squares.push_back(turnedSquare(board, squareOf(board, layout.order, k), turn));
      }
    }
  }
  return numberings;
}

// The numbers that agree best with the crossings, of those that were tried.
class BestNumbers {
 public:
  // The board's placement may be off by some rows, so that its first tag does not exist.
  void tryAll(const TagScores& scores, const Numbering& numbering) {
    for (int first = -numbering.count(); first < kTagFamilySize; ++first) {
      int value = 0;
      for (int k = 0; k < numbering.count(); ++k)
        value += scores.of(numbering.square(k), first + k, numbering.turn);
      second_value_ = std::max(second_value_, std::min(value, value_));
      if (value > value_) keep(value, scores, numbering, first);
    }
  }

  std::optional<TagReading> reading() const {
    constexpr double kMinAgreement = 0.4, kMinLead = 0.1;  // of the crossings at bits
    const bool is_clear =
        value_ > kMinAgreement * crossings_ && value_ - second_value_ > kMinLead * crossings_;
    return is_clear && best_.smallest >= 0 && best_.smallest <= best_.largest ? std::optional(best_)
                                                                              : std::nullopt;
  }

 private:
  void keep(int value, const TagScores& scores, const Numbering& numbering, int first) {
    value_ = value;
    crossings_ = scores.count();
    best_ = {numbering.print, kTagFamilySize, -1};
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
  for (const int border_bits : {2, 1}) {
    const TagScores scores(crossings, board, border_bits);
    for (const Numbering& numbering : numberingsOf(board, border_bits)) best.tryAll(scores, numbering);
  }
  return best.reading();
}

}  // namespace evical
