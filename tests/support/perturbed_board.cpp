#include "tests/support/perturbing.h"

#include <cmath>
#include <utility>

namespace evical::test {
namespace {

// Moves every circle to its image if the board's points deviate from their nominal positions by
// `displacement(point)`.
template <class Displacement>
void deformBoard(Recorded& recorded, Displacement&& displacement) {
  moveCircles(recorded, [&](const RigidTransform& camera_from_world, const Eigen::Vector3d& point_m,
                            const BoardView&) {
    return std::pair<Eigen::Vector3d, Eigen::Vector3d>(
        camera_from_world * point_m, camera_from_world * (point_m + displacement(point_m)).eval());
  });
}

void spacing(Recorded& recorded, double percent) {
  recorded.session.board.spacing_m *= 1.0 + 0.01 * percent;
  recorded.session.board.radius_m *= 1.0 + 0.01 * percent;
}

void spacingAlone(Recorded& recorded, double percent) {
  recorded.session.board.spacing_m *= 1.0 + 0.01 * percent;
}

void stretch(Recorded& recorded, double percent) {
  deformBoard(recorded, [&](const Eigen::Vector3d& point_m) {
    return Eigen::Vector3d(0.0, 0.01 * percent * point_m.y(), 0.0);
  });
}

// The board's middle is bowed by this, like paper that is detached in the middle: a parabola along the
// columns.
void bow(Recorded& recorded, double height_mm) {
  const Board& board = recorded.scenario.board;
  const double length_m = board.point_m(board.rows - 1, 0).y();
  deformBoard(recorded, [&](const Eigen::Vector3d& point_m) {
    const double u = 2.0 * point_m.y() / length_m - 1.0;
    return Eigen::Vector3d(0.0, 0.0, -1e-3 * height_mm * (1.0 - u * u));
  });
}

void rows(Recorded& recorded, double more) {
  recorded.session.board.rows += static_cast<int>(more);
}
void cols(Recorded& recorded, double more) {
  recorded.session.board.cols += static_cast<int>(more);
}

void gravityNorm(Recorded& recorded, double norm_m_s2) {
  recorded.scenario.gravity_in_world_m_s2 *= norm_m_s2 / recorded.scenario.gravity_in_world_m_s2.norm();
  simulateImuAnew(recorded);
}

}  // namespace

std::vector<Perturbation> boardPerturbations() {
  return {{"board spacing", "%", {0.5, 1, 2, -1, -2.5}, {"spacing", "board's scale"}, spacing},
          {"board spacing alone", "%", {900, 100, -50, -90}, {"spacing_m"}, spacingAlone},
          {"board stretch", "%", {0.25, 0.5, 1}, {"stretch", "board's shape", "ratio"}, stretch},
          {"board bow", "mm", {0.5, 1, 2}, {"bow", "bent", "flat", "board's shape"}, bow},
          {"board rows", "", {2, -2}, {"rows"}, rows, PerturbedStage::FrontEnd},
          {"board cols", "", {1, -1}, {"cols"}, cols, PerturbedStage::FrontEnd},
          {"gravity", "m/s^2", {9.78, 9.83, 9.9}, {"gravity"}, gravityNorm}};
}

}  // namespace evical::test
