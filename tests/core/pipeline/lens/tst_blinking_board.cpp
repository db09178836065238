// Intrinsics from a flashing screen: simulated with a known truth, and real recordings; and the messages if a
// blinking board is not suitable.
#include "core/base/error.h"
#include "core/geometry/projection_difference.h"
#include "core/pipeline/lens/intrinsics_calibration.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/session/session.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/real_recordings.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>

namespace {

using namespace evical;

// The scenario's camera with a quarter of its pixels, and faster: the full size takes minutes.
Scenario smallScenario() {
  Scenario scenario = readScenario(test::scenarioPath("blinking"));
  scenario.duration_s = 10.0;
  scenario.motion.image_speed_px_s = 12.0;
  CameraIntrinsics& camera = scenario.cameras.front().intrinsics;
  camera.resolution_px = {173, 130};
  camera.focal_length_px *= 0.5;
  camera.principal_point_px = {85.6, 65.3};
  return scenario;
}

QString errorOf(const std::function<void()>& work, ErrorKind kind) {
  try {
    work();
  } catch (const CalibrationError& error) {
    return error.kind() == kind ? QString(error.what()) : "of another kind: " + QString(error.what());
  }
  return "none";
}

}  // namespace

class TestBlinkingBoard : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() {
    folder_ = std::make_unique<QTemporaryDir>();
    scenario_ = smallScenario();
    simulate(scenario_, path(), RunContext{});
  }

  void simulatedScreen_givesTheTrueLens() {
    const IntrinsicsRun run = calibrateIntrinsics(session(), 0, RunContext{});
    const CameraIntrinsics& truth = scenario_.cameras.front().intrinsics;
    const CameraIntrinsics& found = run.result.intrinsics;
    const IntrinsicsVector sigma = run.result.standardDeviations();
    const Eigen::Vector4d errors(found.focal_length_px.x() - truth.focal_length_px.x(),
                                 found.focal_length_px.y() - truth.focal_length_px.y(),
                                 found.principal_point_px.x() - truth.principal_point_px.x(),
                                 found.principal_point_px.y() - truth.principal_point_px.y());
    qInfo(
        "%d views of %zu pictures, f %.2f +- %.2f (%.2f), %.3f px RMS, projection off by %.3f px, said %.3f",
        run.result.views_used, run.detections.cameras.front().windows.size(), found.focal_length_px.x(),
        sigma[0], truth.focal_length_px.x(), run.result.reprojection_rms_px,
        projectionDifference(truth, found).rms_px, run.result.image.rms_px);
    constexpr double kSigmas = 4.0;
    for (int k = 0; k < 4; ++k)
      QVERIFY2(std::abs(errors[k]) < kSigmas * sigma[k],
               QByteArray::number(errors[k]) + " against " + QByteArray::number(sigma[k]));
    QVERIFY2(sigma[0] < 0.01 * truth.focal_length_px.x(), QByteArray::number(sigma[0]));
    QVERIFY2(projectionDifference(truth, found).rms_px < 0.5,
             QByteArray::number(projectionDifference(truth, found).rms_px));
    QVERIFY2(run.result.reprojection_rms_px < 0.3, QByteArray::number(run.result.reprojection_rms_px));
    QCOMPARE(run.result.passes, 1);
  }

  void simulatedSession_saysThatTheBoardBlinks() {
    QVERIFY(session().board_blinks);
    QVERIFY(readSession(copyOfSession()).board_blinks);
  }

  void calibrationBesideAnImu_isRefusedWithTheReason() {
    const QString error = errorOf([&] { calibrate(session(), RunContext{}); }, ErrorKind::BadInput);
    QVERIFY2(error.contains("board.blinking") && error.contains("cannot determine time offsets") &&
                 error.contains("evical intrinsics"),
             qPrintable(error));
  }

  void cornersBeforeAnEventCamera_areToldHowToBlink() {
    Session other = session();
    other.board_blinks = false;
    const QString error =
        errorOf([&] { calibrateIntrinsics(other, 0, RunContext{}); }, ErrorKind::CalibrationFailed);
    QVERIFY2(error.contains("something blinks at") && error.contains("blinking: true"), qPrintable(error));
  }

  void blinkThatTheSessionDoesNotSay_isNoticed() {
    Session other = session();
    other.board_blinks = false;
    other.board.type = BoardType::AsymmetricCircles;
    other.board.rows = 7;
    other.board.cols = 4;
    other.board.radius_m = 0.02;
    other.time_range_s = {{0.0, 3.0}};
    const QString error =
        errorOf([&] { calibrateIntrinsics(other, 0, RunContext{}); }, ErrorKind::CalibrationFailed);
    QVERIFY2(error.contains("blinks at 15 Hz") && error.contains("blinking: true"), qPrintable(error));
  }

  void otherBoardThanBlinks_isSaid() {
    Session other = session();
    other.board.type = BoardType::AprilGrid;
    other.board.tag_size_m = 0.05;
    other.time_range_s = {{0.0, 1.0}};
    const QString error =
        errorOf([&] { calibrateIntrinsics(other, 0, RunContext{}); }, ErrorKind::CalibrationFailed);
    QVERIFY2(error.contains("something blinks") && error.contains("aprilgrid of 6 x 9"), qPrintable(error));
  }

  void realScreen_givesItsLens_data() {
    QTest::addColumn<int>("rows");
    QTest::addColumn<int>("cols");
    QTest::newRow("the true board") << 4 << 8;
    QTest::newRow("a part of a larger one") << 5 << 9;
  }

  // f 89.8 +- 0.5 px, of 22 recordings of the set of which these are nine.
  void realScreen_givesItsLens() {
    QFETCH(const int, rows);
    QFETCH(const int, cols);
    const QString folder = test::realRecordings();
    if (folder.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
    const Session all = test::dvs128Blinking(folder, rows, cols);
    QCOMPARE(static_cast<int>(all.more_recordings.size()), 8);
    int found = 0;
    std::vector<std::filesystem::path> recordings = all.more_recordings;
    recordings.push_back(all.recording);
    for (const std::filesystem::path& recording : recordings) {
      Session one = all;
      one.recording = recording;
      one.more_recordings.clear();
      const DetectionResult detections = readAndDetect(one, {CameraLens{}}, RunContext{});
      found += !detections.cameras.front().views.empty();
    }
    QVERIFY2(found >= 8, QByteArray::number(found));
    const IntrinsicsRun run = calibrateIntrinsics(all, 0, RunContext{});
    const double f = run.result.intrinsics.focal_length_px.mean(), sigma = run.result.standardDeviations()[0];
    qInfo("%d of 9 found, f %.2f +- %.2f, %.3f px RMS", found, f, sigma, run.result.reprojection_rms_px);
    QVERIFY2(run.result.reprojection_rms_px < 0.2, QByteArray::number(run.result.reprojection_rms_px));
    QVERIFY2(sigma < 2.0, QByteArray::number(sigma));
    QVERIFY2(std::abs(f - 89.8) < 2.0 * std::hypot(sigma, 0.5), QByteArray::number(f));
  }

 private:
  std::filesystem::path path() const { return folder_->path().toStdString(); }
  Session session() const { return readSession(path() / "session.yaml"); }
  std::filesystem::path copyOfSession() const {
    const std::filesystem::path copy = path() / "copy.yaml";
    writeSession(session(), copy);
    return copy;
  }

  std::unique_ptr<QTemporaryDir> folder_;
  Scenario scenario_;
};

EVICAL_TEST(TestBlinkingBoard)
#include "tst_blinking_board.moc"
