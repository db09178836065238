// Cameras that see different boards: the boards' relative pose is estimated, too.
#include "core/data/quantity_difference.h"
#include "tests/core/optimisation/solved_rig.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace evical;

test::SimulatedRig rigOfFurtherBoards(unsigned seed) {
  test::RigOptions options = test::shortRecording(seed);
  options.further_board = true;
  return test::simulateRig(options);
}

Estimate estimateOfFurtherBoards(const test::SimulatedRig& rig, const CalibrationState& state,
                                 const UncertaintyReport& uncertainty) {
  Estimate estimate;
  estimate.reference = rig.input.imus[0].name;
  for (const CameraData& camera : rig.input.cameras) estimate.camera_names.push_back(camera.name);
  estimate.imu_names = {rig.input.imus[0].name};
  estimate.cameras = state.cameras;
  estimate.imus = state.imus;
  estimate.board_names = {rig.input.boardName(0), rig.input.boardName(1)};
  estimate.boards = {state.boardAt(0), state.boardAt(1)};
  estimate.gravity_in_world_m_s2 = state.gravity_in_world_m_s2;
  estimate.uncertainty = uncertainty;
  estimate.uncertainty.further_boards.resize(1);
  return estimate;
}

// Poses of cameras and boards, and time offsets.
bool isOfPlace(const QuantityDifference& quantity) {
  const auto has = [&](const char* part) { return quantity.name.find(part) != std::string::npos; };
  return has(".rotation.") || has(".translation.") || has(".time_offset");
}

}  // namespace

class TestFurtherBoards : public QObject {
  Q_OBJECT

 private slots:
  void errors_areWithinTheirSigmas() {
    constexpr unsigned kSeeds = 12;
    double squares = 0.0, of_board = 0.0;
    int count = 0, board_count = 0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const test::SimulatedRig rig = rigOfFurtherBoards(seed);
      const test::SolvedRig solved = solve(rig, seed, test::withoutPixelDelay());
      UncertaintyReport nothing;
      nothing.cameras.resize(2);
      nothing.imus.resize(1);
      const auto differences =
          difference(estimateOfFurtherBoards(rig, solved.solution.state, solved.estimate.report),
                     estimateOfFurtherBoards(rig, rig.truth, nothing));
      for (const QuantityDifference& quantity : differences) {
        if (!isOfPlace(quantity)) continue;
        QVERIFY2(quantity.sigma > 0.0, quantity.name.c_str());
        const double normalised2 = quantity.normalised() * quantity.normalised();
        const bool board = quantity.name.starts_with("tags.");
        (board ? of_board : squares) += normalised2;
        ++(board ? board_count : count);
      }
    }
    QCOMPARE(board_count, static_cast<int>(6 * kSeeds));
    const double cameras_rms = std::sqrt(squares / count), board_rms = std::sqrt(of_board / board_count);
    QVERIFY2(cameras_rms > 0.7 && cameras_rms < 1.4, QByteArray::number(cameras_rms));
    QVERIFY2(board_rms > 0.7 && board_rms < 1.4, QByteArray::number(board_rms));
  }

  void theWorldsBoard_hasNoPlaceOfItsOwn() {
    const test::SimulatedRig rig = rigOfFurtherBoards(1);
    const test::SolvedRig solved = solve(rig, 1, test::withoutPixelDelay());
    QCOMPARE(solved.solution.state.board.world_from_board.translation_m, Eigen::Vector3d::Zero().eval());
    const auto reported = [&](std::size_t board, QuantityId id, std::size_t axis) {
      return columnOf({QuantityOwner::Board, board, id, axis}, solved.estimate.report.columns).has_value();
    };
    QVERIFY(reported(1, QuantityId::Translation, 0) && reported(1, QuantityId::Rotation, 2));
    QVERIFY(!reported(0, QuantityId::Translation, 0));
  }

  void sizesThatContradictEachOther_areToldOf() {
    test::SimulatedRig rig = rigOfFurtherBoards(2);
    QVERIFY(solve(rig, 2, test::withoutPixelDelay()).estimate.scale_doubt.empty());
    Board& board = rig.input.further_boards[0].board;
    board.spacing_m *= 1.02;
    board.radius_m *= 1.02;
    const std::string doubt = solve(rig, 2, test::withoutPixelDelay()).estimate.scale_doubt;
    QVERIFY2(doubt.find("the boards board and tags contradict each other") == 0, doubt.c_str());
    QVERIFY2(doubt.find("smaller than specified (spacing ") != std::string::npos, doubt.c_str());
  }
};

EVICAL_TEST(TestFurtherBoards)
#include "tst_further_boards.moc"
