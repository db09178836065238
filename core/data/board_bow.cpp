#include "core/data/board_bow.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace evical {
namespace {

const QuantityInfo& rowInfo() {
  return quantityInfo(kBoardQuantities, &BoardState::row_curvature_1_m);
}
const QuantityInfo& columnInfo() {
  return quantityInfo(kBoardQuantities, &BoardState::column_curvature_1_m);
}
const QuantityInfo& twistInfo() {
  return quantityInfo(kBoardQuantities, &BoardState::twist_1_m);
}

struct Height {
  const QuantityInfo* of;
  double mm;
};

Height largest(const BoardState& state, const Board& board) {
  const auto height = [&](const QuantityInfo& info, double curvature_1_m) {
    return Height{&info, 1e3 * curvature_1_m * bowHeight_m2(info, board)};
  };
  Height most{nullptr, 0.0};
  for (const Height& each :
       {height(rowInfo(), state.row_curvature_1_m), height(columnInfo(), state.column_curvature_1_m),
        height(twistInfo(), state.twist_1_m)})
    if (most.of == nullptr || std::abs(each.mm) > std::abs(most.mm)) most = each;
  return most;
}

}  // namespace

// An arc's sagitta, and x y between the middle and a corner.
double bowHeight_m2(const QuantityInfo& curvature, const Board& board) {
  const Eigen::Vector2d extent_m = board.extent_m();
  if (&curvature == &twistInfo()) return extent_m.x() * extent_m.y() / 4.0;
  const double length_m = &curvature == &rowInfo() ? extent_m.x() : extent_m.y();
  return length_m * length_m / 8.0;
}

std::string bowWords(const BoardState& state, const Board& board, const std::string& called) {
  const Height most = largest(state, board);
  if (most.of == &twistInfo())
    return fmt::format("the {} seems bent: twisted, so that its corners stand out or lie back by {:.2g} mm",
                       called, std::abs(most.mm));
  const bool rows = most.of == &rowInfo();
  return fmt::format("the {} seems bent: over the {:.2g} m of its {} the middle {} by {:.2g} mm", called,
                     rows ? board.extent_m().x() : board.extent_m().y(), rows ? "rows" : "columns",
                     most.mm > 0.0 ? "stands out" : "lies back", std::abs(most.mm));
}

double largestBow_mm(const BoardState& state, const Board& board) {
  return std::abs(largest(state, board).mm);
}

}  // namespace evical
