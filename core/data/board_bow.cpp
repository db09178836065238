#include "core/data/board_bow.h"

#include <fmt/format.h>

#include <cmath>

namespace evical {
namespace {

struct Height {
  QuantityId of;
  double mm;
};

Height largest(const BoardState& state, const Board& board) {
  Height most{QuantityId::RowCurvature, 0.0};
  forEachSheetQuantity([&](const auto& row) {
    if (row.info.release != QuantityRelease::BoardBow) return;
    const double mm = 1e3 * row.value(state) * bowHeight_m2(row.info.id, board);
    if (std::abs(mm) > std::abs(most.mm)) most = {row.info.id, mm};
  });
  return most;
}

}  // namespace

// An arc's sagitta; for a twist, x y between the middle and a corner.
double bowHeight_m2(QuantityId curvature, const Board& board) {
  const Eigen::Vector2d extent_m = board.extent_m();
  if (curvature == QuantityId::Twist) return extent_m.x() * extent_m.y() / 4.0;
  const double length_m = curvature == QuantityId::RowCurvature ? extent_m.x() : extent_m.y();
  return length_m * length_m / 8.0;
}

std::string bowWords(const BoardState& state, const Board& board, const std::string& called) {
  const Height most = largest(state, board);
  if (most.of == QuantityId::Twist)
    return fmt::format("the {} seems bent: twisted, with corners that protrude or are recessed by {:.2g} mm",
                       called, std::abs(most.mm));
  const bool rows = most.of == QuantityId::RowCurvature;
  return fmt::format("the {} seems bent: over the {:.2g} m of its {}, the middle {} by {:.2g} mm", called,
                     rows ? board.extent_m().x() : board.extent_m().y(), rows ? "rows" : "columns",
                     most.mm > 0.0 ? "protrudes" : "is recessed", std::abs(most.mm));
}

double largestBow_mm(const BoardState& state, const Board& board) {
  return std::abs(largest(state, board).mm);
}

}  // namespace evical
