#include "core/synthetic/board_surface.h"

#include "core/data/board_bow.h"

namespace evical {

BoardSurface::BoardSurface(const Scenario& scenario) {
  const SimulatedBow& bow = scenario.board_bow;
  bent_ = bow != SimulatedBow{};
  const double rows = bow.rows_m / bowHeight_m2(QuantityId::RowCurvature, scenario.board),
               columns = bow.columns_m / bowHeight_m2(QuantityId::ColumnCurvature, scenario.board),
               twist = bow.twist_m / bowHeight_m2(QuantityId::Twist, scenario.board);
  curvature_1_m_ << rows, twist, twist, columns;
  rounded_1_m_ = curvature_1_m_.cast<float>();
}

}  // namespace evical
