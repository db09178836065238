// Cameras that see different boards, from the session to the files of the result.
#include "core/base/error.h"
#include "core/pipeline/detection/saved_detections.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/report/truth_comparison.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

using namespace evical;
using namespace evical::test;

namespace {

constexpr double kSeveralBoardsDuration_s = 8.0;

NamedResult truthOf(const Scenario& scenario, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "truth.yaml";
  std::ofstream(file) << truthYaml(scenario);
  return readResultYaml(file);
}

// Quantities that the recording determines; `of`: part of their names.
double worstNormalised(const TruthComparison& comparison, const std::string& of) {
  double worst = -1.0;
  for (const QuantityDifference& each : comparison.quantities)
    if (each.sigma > 0.0 && each.name.find(of) != std::string::npos)
      worst = std::max(worst, std::abs(each.normalised()));
  return worst;
}

void keepViews(double begin_s, double end_s, BoardObservations& camera) {
  std::erase_if(camera.views,
                [&](const BoardView& view) { return view.time_s < begin_s || view.time_s > end_s; });
}

QString failureOfSeveralBoards(const SimulatedPass& simulated) {
  try {
    return QString::fromStdString(calibrate(simulated.session, simulated.detections, {}).result.reason);
  } catch (const CalibrationError& error) {
    return error.what();
  }
}

}  // namespace

class TestSeveralBoards : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;
  SimulatedPass simulated_;

  std::filesystem::path path() const { return folder_.path().toStdString(); }

 private slots:
  void initTestCase() { simulated_ = simulatePass(kSeveralBoardsDuration_s, "two_boards"); }

  void rigAndBoards_areAsTheyAre() {
    const auto run =
        std::make_shared<const CalibrationRun>(calibrate(simulated_.session, simulated_.detections, {}));
    const std::filesystem::path out = path() / "out";
    writeResultFiles(out, simulated_.session, run, "0", "");
    const NamedResult result = readResultYaml(out / "result.yaml");
    QCOMPARE(result.boards, (std::vector<std::string>{"board", "tags"}));
    const TruthComparison comparison = compareWithTruth(result, truthOf(simulated_.truth, path()));
    for (const char* const of : {"tags.rotation", "tags.translation", "frames.rotation", "frames.translation",
                                 "events.rotation", "events.translation"}) {
      const double worst = worstNormalised(comparison, of);
      QVERIFY2(worst >= 0.0 && worst < 4.0, qPrintable(QString("%1: %2 sigmas").arg(of).arg(worst)));
    }
    const BoardUncertainty& tags = result.result->uncertainty.boardAt(1);
    QVERIFY2(tags.translation_std_m.maxCoeff() < 1e-3,
             qPrintable(QString::number(tags.translation_std_m.maxCoeff())));
    const RigidTransform &found = result.result->state.boardAt(1).world_from_board,
                         &is = simulated_.truth.further_boards[0].world_from_board;
    QVERIFY((found.translation_m - is.translation_m).norm() < 2e-3);
    QVERIFY(rotationAngleBetween_rad(found.rotation, is.rotation) < 2e-3);
  }

  void withoutAnImu_too() {
    SimulatedPass alone = simulated_;
    alone.session.imus.clear();
    alone.detections.imus.clear();
    alone.session.reference = "events";
    const CalibrationRun run = calibrate(alone.session, alone.detections, {});
    Scenario truth = alone.truth;
    truth.imus.clear();
    const NamedResult named = namedResult(alone.session, std::make_shared<CalibrationResult>(run.result), "");
    const TruthComparison comparison = compareWithTruth(named, truthOf(truth, path()));
    for (const char* const of :
         {"tags.rotation", "tags.translation", "frames.rotation", "frames.translation"}) {
      const double worst = worstNormalised(comparison, of);
      QVERIFY2(worst >= 0.0 && worst < 4.0, qPrintable(QString("%1: %2 sigmas").arg(of).arg(worst)));
    }
  }

  void boardsThatAreNeverSeenTogether_areToldOf() {
    SimulatedPass apart = simulated_;
    keepViews(0.0, 0.45 * kSeveralBoardsDuration_s, apart.detections.cameras[0]);
    keepViews(0.55 * kSeveralBoardsDuration_s, kSeveralBoardsDuration_s, apart.detections.cameras[1]);
    const QString said = failureOfSeveralBoards(apart);
    QVERIFY2(said.contains("tags: fewer than") && said.contains("their relative pose is unknown"),
             qPrintable(said));
  }

  void boardThatIsMoved_isToldOf() {
    SimulatedPass moved = simulated_;
    SimulatedPass other = simulated_;
    other.truth.further_boards[0].world_from_board.translation_m.x() += 0.3;
    other = simulatePass(kSeveralBoardsDuration_s, other.truth);
    keepViews(0.0, 0.5 * kSeveralBoardsDuration_s, moved.detections.cameras[1]);
    keepViews(0.5 * kSeveralBoardsDuration_s, kSeveralBoardsDuration_s, other.detections.cameras[1]);
    std::vector<BoardView>& views = moved.detections.cameras[1].views;
    views.insert(views.end(), other.detections.cameras[1].views.begin(),
                 other.detections.cameras[1].views.end());
    const QString said = failureOfSeveralBoards(moved);
    QVERIFY2(said.contains("of its views agree on its pose relative to"), qPrintable(said));
  }

  void detectionsOfAnotherBoard_areRefused() {
    const std::filesystem::path saved = path() / "saved";
    std::filesystem::create_directories(saved);
    for (const FileContent& file : detectionFiles(simulated_.session, simulated_.detections, {}))
      std::ofstream(saved / file.path) << contentOf(file);
    Session other = simulated_.session;
    other.further_boards[0].board.cols += 1;
    try {
      restoreDetections(saved, other, {});
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      const QString said = error.what();
      QVERIFY2(said.contains("cameras.frames.board.cols") && said.contains("a board with columns:"),
               qPrintable(said));
    }
  }
};

EVICAL_TEST(TestSeveralBoards)
#include "tst_several_boards.moc"
