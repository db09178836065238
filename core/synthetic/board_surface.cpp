#include "core/synthetic/board_surface.h"

#include "core/data/board_bow.h"
#include "core/data/quantity.h"

namespace evical {
namespace {

double curvatureOf(double BoardState::*of, double height_m, const Board& board) {
  return height_m / bowHeight_m2(quantityInfo(kBoardQuantities, of), board);
}

}  // namespace

BoardSurface::BoardSurface(const Scenario& scenario) {
  const SimulatedBow& bow = scenario.board_bow;
  bent_ = bow != SimulatedBow{};
  const double rows = curvatureOf(&BoardState::row_curvature_1_m, bow.rows_m, scenario.board),
               columns = curvatureOf(&BoardState::column_curvature_1_m, bow.columns_m, scenario.board),
               twist = curvatureOf(&BoardState::twist_1_m, bow.twist_m, scenario.board);
  curvature_1_m_ << rows, twist, twist, columns;
  rounded_1_m_ = curvature_1_m_.cast<float>();
}

}  // namespace evical
