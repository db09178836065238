// Boards that differ slightly from the session, and gravity that is not 9.81 m/s^2: errors and sigmas against
// the truth, and the resulting messages.
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using Eigen::Vector3d;

struct BoardSizeRun {
  test::SimulatedRig rig;
  BatchSolution solution;
  UncertaintyEstimate estimate;

  Vector3d translationError_m() const {
    return solution.state.cameras[0].reference_from_camera.translation_m -
           rig.truth.cameras[0].reference_from_camera.translation_m;
  }
  // In sigmas, along the axis with the largest value.
  double translationError_sigmas() const {
    return translationError_m()
        .cwiseQuotient(estimate.report.cameras[0].translation_std_m)
        .cwiseAbs()
        .maxCoeff();
  }
};

BoardSizeRun calibrateForBoardSize(const test::RigOptions& simulation,
                                   const OptimisationOptions& options = {}) {
  BoardSizeRun run;
  run.rig = test::simulateRig(simulation);
  CalibrationState start = test::disturbed(run.rig.truth, simulation.seed);
  start.gravity_in_world_m_s2 *= run.rig.input.gravity_norm_m_s2 / start.gravity_in_world_m_s2.norm();
  run.solution = optimiseBatch(run.rig.input, start, options, RunContext{});
  run.estimate = estimateUncertainty(run.rig.input, run.solution, options, RunContext{});
  return run;
}

test::RigOptions boardOf(double scale, double stretch) {
  test::RigOptions simulation = test::shortRecording();
  simulation.duration_s = 6.0;
  simulation.board = {scale, stretch};
  return simulation;
}

// By this over its columns.
test::RigOptions bentBoard(double height_m) {
  test::RigOptions simulation = boardOf(1.0, 0.0);
  constexpr double kLength_m = 0.5;
  simulation.board.column_curvature_1_m = 8.0 * height_m / (kLength_m * kLength_m);
  return simulation;
}

class TestBoardSize : public QObject {
  Q_OBJECT

 private slots:
  void stretchedBoard_isFound() {
    const BoardSizeRun run = calibrateForBoardSize(boardOf(1.0, 0.005));
    const double sigma = run.estimate.report.board.stretch_std;
    QVERIFY2(sigma > 0.0 && sigma < 2e-4, qPrintable(QString::number(sigma)));
    QVERIFY2(std::abs(run.solution.state.board.stretch - 0.005) < 4.0 * sigma,
             qPrintable(QString::number(run.solution.state.board.stretch)));
    QVERIFY2(run.translationError_sigmas() < 4.0, qPrintable(QString::number(run.translationError_sigmas())));
    QVERIFY2(run.estimate.scale_doubt.empty(), run.estimate.scale_doubt.c_str());

    OptimisationOptions held;
    held.free_board_size = false;
    held.camera_intrinsics = CameraIntrinsicsChoice::Fixed;  // otherwise lens and bow would absorb part of it
    held.board_bow = false;
    const BoardSizeRun blind = calibrateForBoardSize(boardOf(1.0, 0.005), held);
    // Compared with the free one's sigma, not with its error, which is a matter of chance.
    const double sigma_m = run.estimate.report.cameras[0].translation_std_m.norm();
    QVERIFY2(
        run.translationError_m().norm() < 2.0 * sigma_m && blind.translationError_m().norm() > 2.5 * sigma_m,
        qPrintable(QString("%1 and %2 mm, sigma %3 mm")
                       .arg(1e3 * run.translationError_m().norm())
                       .arg(1e3 * blind.translationError_m().norm())
                       .arg(1e3 * sigma_m)));
  }

  // Within a ruler's uncertainty: no complaint, and sigmas that allow for it.
  void boardOffByTwoOfItsSigmas_isWithinTheSigmas() {
    for (const double scale : {0.996, 1.004}) {
      const BoardSizeRun run = calibrateForBoardSize(boardOf(scale, 0.0));
      QVERIFY2(run.translationError_sigmas() < 4.0,
               qPrintable(QString::number(run.translationError_sigmas())));
      QVERIFY2(std::abs(run.solution.state.board.scale - scale) < 4.0 * run.estimate.report.board.scale_std,
               qPrintable(QString::number(run.solution.state.board.scale)));
      QVERIFY2(run.estimate.scale_doubt.empty(), run.estimate.scale_doubt.c_str());
    }
    OptimisationOptions held;
    held.free_board_size = held.free_gravity_norm = false;
    const BoardSizeRun wrong = calibrateForBoardSize(boardOf(0.99, 0.0), held);
    QVERIFY2(wrong.translationError_sigmas() > 4.0,
             qPrintable(QString::number(wrong.translationError_sigmas())));
  }

  void boardThatIsFarOff_isDoubted_data() {
    QTest::addColumn<double>("scale");
    QTest::addColumn<QString>("words");
    QTest::newRow("larger") << 1.015 << "larger than specified (spacing ";
    QTest::newRow("smaller") << 0.985 << "smaller than specified (spacing ";
  }
  void boardThatIsFarOff_isDoubted() {
    QFETCH(double, scale);
    QFETCH(QString, words);
    const BoardSizeRun run = calibrateForBoardSize(boardOf(scale, 0.0));
    const QString doubt = QString::fromStdString(run.estimate.scale_doubt);
    QVERIFY2(doubt.contains(words), qPrintable(doubt));
  }

  void stretchBeyondWhatWasMeasured_isDoubted() {
    const BoardSizeRun run = calibrateForBoardSize(boardOf(1.0, -0.02));
    const QString doubt = QString::fromStdString(run.estimate.stretch_doubt);
    QVERIFY2(doubt.contains("shorter along its rows"), qPrintable(doubt));
    QVERIFY(run.translationError_sigmas() < 4.0);
  }

  // The middle of its columns of half a metre is bowed by a millimetre, forwards or backwards.
  void bentBoard_isFound() {
    OptimisationOptions flat;
    flat.board_bow = false;
    for (const double height_m : {1e-3, -1e-3}) {
      const BoardSizeRun run = calibrateForBoardSize(bentBoard(height_m)),
                         blind = calibrateForBoardSize(bentBoard(height_m), flat);
      const BoardState &board = run.solution.state.board, truth = bentBoard(height_m).board;
      const BoardUncertainty& sigma = run.estimate.report.board;
      const double error_1_m = board.column_curvature_1_m - truth.column_curvature_1_m;
      QVERIFY2(sigma.column_curvature_std_1_m > 0.0 && sigma.column_curvature_std_1_m < 2e-3,  // 0.06 mm
               qPrintable(QString::number(sigma.column_curvature_std_1_m)));
      QVERIFY2(std::abs(error_1_m) < 4.0 * sigma.column_curvature_std_1_m,
               qPrintable(QString::number(error_1_m)));
      QVERIFY(std::abs(board.row_curvature_1_m) < 4.0 * sigma.row_curvature_std_1_m);
      QVERIFY(std::abs(board.twist_1_m) < 4.0 * sigma.twist_std_1_m);
      QVERIFY2(run.translationError_sigmas() < 4.0,
               qPrintable(QString::number(run.translationError_sigmas())));
      QVERIFY(run.estimate.bow_doubt.empty() && run.estimate.bent_board.empty());
      QVERIFY2(run.estimate.notes.back().starts_with("the board seems bent: over the 0.5 m of its columns"),
               run.estimate.notes.back().c_str());
      QCOMPARE(blind.solution.state.board.column_curvature_1_m, 0.0);
      QCOMPARE(blind.estimate.report.board.column_curvature_std_1_m, 0.0);
      QVERIFY(blind.estimate.report.cameras[0].rotation_std_rad.norm() >
              1.3 * run.estimate.report.cameras[0].rotation_std_rad.norm());
    }
  }

  // A cylinder about a diagonal, which is a twist, too.
  void twistedBoard_isFound() {
    test::RigOptions simulation = boardOf(1.0, 0.0);
    simulation.board.row_curvature_1_m = simulation.board.column_curvature_1_m = 0.02;
    simulation.board.twist_1_m = -0.02;
    const BoardSizeRun run = calibrateForBoardSize(simulation);
    const BoardState& board = run.solution.state.board;
    const BoardUncertainty& sigma = run.estimate.report.board;
    QVERIFY2(std::abs(board.twist_1_m + 0.02) < 4.0 * sigma.twist_std_1_m,
             qPrintable(QString::number(board.twist_1_m)));
    QVERIFY2(std::abs(board.row_curvature_1_m - 0.02) < 4.0 * sigma.row_curvature_std_1_m,
             qPrintable(QString::number(board.row_curvature_1_m)));
    QVERIFY2(run.translationError_sigmas() < 4.0, qPrintable(QString::number(run.translationError_sigmas())));
  }

  void boardBentBeyondWhatIsModelled_isDoubted() {
    const std::string doubt = calibrateForBoardSize(bentBoard(8e-3)).estimate.bow_doubt;
    QVERIFY2(
        doubt.starts_with("the board seems bent: over the 0.5 m of its columns, the middle protrudes by"),
        doubt.c_str());
    QVERIFY(calibrateForBoardSize(boardOf(1.0, 0.0)).estimate.bow_doubt.empty());
  }

  // Rao's score test, with lenses free, which absorb part of it, and fixed.
  void bentBoardThatIsTakenForFlat_isDoubted() {
    for (const CameraIntrinsicsChoice lens : {CameraIntrinsicsChoice::Free, CameraIntrinsicsChoice::Fixed}) {
      OptimisationOptions options;
      options.camera_intrinsics = lens;
      options.board_bow = false;
      const QString out =
          QString::fromStdString(calibrateForBoardSize(bentBoard(1e-3), options).estimate.bent_board);
      QVERIFY2(
          out.startsWith("the board seems bent: over the 0.5 m of its columns, the middle protrudes by 1"),
          qPrintable(out));
      QVERIFY(out.contains("mount it on glass"));
      const QString back =
          QString::fromStdString(calibrateForBoardSize(bentBoard(-1e-3), options).estimate.bent_board);
      QVERIFY2(back.contains("is recessed by "), qPrintable(back));
      const BoardSizeRun flat = calibrateForBoardSize(bentBoard(0.0), options),
                         stretched = calibrateForBoardSize(boardOf(1.0, 0.005), options);
      QVERIFY2(flat.estimate.bent_board.empty(), flat.estimate.bent_board.c_str());
      QVERIFY2(stretched.estimate.bent_board.empty(), stretched.estimate.bent_board.c_str());
    }
  }

  void gravityOfTheTropics_isWithinTheSigmas() {
    test::RigOptions simulation = boardOf(1.0, 0.0);
    simulation.gravity_m_s2 = 9.78;
    const BoardSizeRun run = calibrateForBoardSize(simulation);
    QVERIFY2(run.translationError_sigmas() < 4.0, qPrintable(QString::number(run.translationError_sigmas())));
    const double error_m_s2 = run.solution.state.gravity_in_world_m_s2.norm() - 9.78;
    QVERIFY2(std::abs(error_m_s2) < 4.0 * run.estimate.report.gravity_norm_std_m_s2,
             qPrintable(QString::number(error_m_s2)));
    QVERIFY2(run.estimate.scale_doubt.empty(), run.estimate.scale_doubt.c_str());
  }

  void whatTheBoardLeavesOpen_isSaidAndInTheSigmas() {
    OptimisationOptions held;
    held.free_board_size = held.free_gravity_norm = false;
    const BoardSizeRun run = calibrateForBoardSize(boardOf(1.0, 0.0)),
                       exact = calibrateForBoardSize(boardOf(1.0, 0.0), held);
    QVERIFY(run.estimate.report.cameras[0].translation_std_m.norm() >
            exact.estimate.report.cameras[0].translation_std_m.norm());
    QCOMPARE(run.estimate.notes.size(), std::size_t{1});
    QVERIFY2(run.estimate.notes[0].starts_with("left: if the board is 0.1 % larger than given"),
             run.estimate.notes[0].c_str());
    QVERIFY(exact.estimate.notes.empty());
    QCOMPARE(exact.solution.state.board.scale, 1.0);
    QCOMPARE(exact.estimate.report.board.scale_std, 0.0);
  }
};

}  // namespace

EVICAL_TEST(TestBoardSize)
#include "tst_board_size.moc"
