// A run that starts from an earlier run's detections gives the same result, without reading events or frames;
// detections of another session are refused.
#include "core/base/error.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/detection/saved_detections.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/report/report_options.h"
#include "core/report/truth_comparison.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/file_content.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <cmath>
#include <filesystem>
#include <functional>

using namespace evical;

namespace {

using Change = std::function<void(Session&)>;

// Six seconds of an event camera and a small frame camera.
Scenario eventsAndFrames() {
  Scenario scenario = readScenario(test::scenarioPath("hybrid_stereo"));
  scenario.duration_s = 6.0;
  for (SimulatedCamera& camera : scenario.cameras) {
    CameraIntrinsics& lens = camera.intrinsics;
    lens.resolution_px = {lens.resolution_px.width_px / 2, lens.resolution_px.height_px / 2};
    lens.focal_length_px *= 0.5;
    lens.principal_point_px = 0.5 * (lens.principal_point_px.array() - 0.5);
  }
  return scenario;
}

class LoggedText : public ProgressSink {
 public:
  void stageStarted(const ProgressStage& /*stage*/) override {}
  void stageProgress(double /*fraction*/) override {}
  void log(LogLevel /*level*/, std::string_view line) override { text += line; }
  std::string text;
};

void replaceIn(const std::filesystem::path& path, const QByteArray& what, const QByteArray& by) {
  QByteArray text = evical::test::fileContent(path);
  QVERIFY2(text.contains(what), text.constData());
  text.replace(what, by);
  QFile file(QString::fromStdString(path.string()));
  QVERIFY(file.open(QIODevice::WriteOnly));
  file.write(text);
}

}  // namespace

class TestSavedDetections : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;
  Session session_;  // the frame camera's lens is unknown
  CalibrationRun run_;

  std::filesystem::path path() const { return folder_.path().toStdString(); }
  std::filesystem::path result() const { return path() / "result"; }

  // Every number and its sigma.
  void verifySame(const CalibrationRun& other) const {
    const auto named = [&](const CalibrationRun& run) {
      return namedResult(session_, std::make_shared<CalibrationResult>(run.result), "test");
    };
    const NamedResult before = named(run_), after = named(other);
    constexpr double kSame = 1e-6;
    int compared = 0;
    for (const QuantityDifference& each : compareWithTruth(after, before).quantities) {
      QVERIFY2(std::abs(each.difference) < kSame, each.name.c_str());
      ++compared;
    }
    QVERIFY(compared > 30);
    const Eigen::VectorXd &sigmas = run_.result.uncertainty.standard_deviations,
                          &others = other.result.uncertainty.standard_deviations;
    QCOMPARE(others.size(), sigmas.size());
    QVERIFY(((others - sigmas).array().abs() <= kSame * sigmas.array()).all());
    QVERIFY(other.result.status == run_.result.status);
    QCOMPARE(other.result.reason, run_.result.reason);
    for (std::size_t k = 0; k < run_.result.cameras.size(); ++k) {
      const CameraFit &a = run_.result.cameras[k], &b = other.result.cameras[k];
      QVERIFY(a.windows_total == b.windows_total && a.windows_used == b.windows_used &&
              a.circles_used == b.circles_used && a.circles_rejected == b.circles_rejected);
    }
  }

 private slots:
  void initTestCase() {
    simulate(eventsAndFrames(), path(), RunContext{});
    session_ = readSession(path() / "session.yaml");
    session_.cameras[1].intrinsics.reset();
    session_.options.report.edit().split_half_check = false;
    run_ = calibrate(session_, RunContext{});
    QVERIFY(run_.intrinsics[1].has_value());
    writeResultFiles(result(), session_, std::make_shared<const CalibrationRun>(run_), "test", "");
  }

  void restored_givesTheSameResult_withoutTheFrames() {
    std::filesystem::rename(path() / "frames", path() / "moved");
    RestoredDetections restored = restoreDetections(result(), session_, RunContext{});
    const DetectionResult detections = restored.detections;
    const CalibrationRun again =
        calibrate(session_, std::move(restored.detections), RunContext{}, std::move(restored.intrinsics));
    std::filesystem::rename(path() / "moved", path() / "frames");
    verifySame(again);
    QCOMPARE(again.detections.faults.size(), run_.detections.faults.size());
    const IntrinsicsResult &before = *run_.intrinsics[1], &after = *again.intrinsics[1];
    QVERIFY(after.intrinsics == before.intrinsics && after.covariance == before.covariance);
    QCOMPARE(after.image.rms_px, before.image.rms_px);
    QCOMPARE(after.views_used, before.views_used);
    // Its own detections are the same again.
    const std::vector<FileContent> files = detectionFiles(session_, detections, again.intrinsics);
    for (const FileContent& file : files)
      QVERIFY2(evical::test::fileContent(result() / file.path) == QByteArray::fromStdString(contentOf(file)),
               file.path.c_str());
  }

  void shorterTimeRange_isAPartOfThem() {
    Session shorter = session_;
    shorter.time_range_s = {1.0, 4.0};
    const DetectionResult detections = restoreDetections(result(), shorter, RunContext{}).detections;
    for (std::size_t k = 0; k < detections.cameras.size(); ++k) {
      const std::vector<BoardView>& views = detections.cameras[k].views;
      QVERIFY(views.size() > 10 && views.size() < run_.detections.cameras[k].views.size());
      QVERIFY(views.front().time_s >= 1.0 && views.back().time_s <= 4.0);
    }
    QVERIFY(detections.imus[0].samples.size() < run_.detections.imus[0].samples.size());
  }

  void boardMeasuredAgain_isTheSameBoard() {
    Session measured = session_;
    measured.board.spacing_m *= 1.01;
    measured.board.radius_m *= 1.005;
    restoreDetections(result(), measured, RunContext{});
  }

  // The frames have the lens of the event camera, whether given or found first.
  void camerasOfOneSensor_areRestored() {
    QTemporaryDir folder;
    const std::filesystem::path path = folder.path().toStdString();
    Scenario scenario = readScenario(test::scenarioPath("davis346_frames"));
    scenario.duration_s = 3.0;
    simulate(scenario, path, RunContext{});
    const Session session = readSession(path / "session.yaml");
    const DetectionResult detections = readAndDetect(session, RunContext{});
    for (const FileContent& file : detectionFiles(session, detections, {}))
      writeFileWhole(path / file.path, contentOf(file));
    const RestoredDetections restored = restoreDetections(path, session, RunContext{});
    QVERIFY(restored.detections.lenses == detections.lenses);
    QCOMPARE(restored.detections.cameras[1].views.size(), detections.cameras[1].views.size());

    Session other = session;
    other.cameras[0].intrinsics->focal_length_px *= 1.01;
    try {
      restoreDetections(path, other, RunContext{});
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains("intrinsics other than"), error.what());
    }
  }

  void fewerCameras_areTaken() {
    Session one = session_;
    one.cameras.pop_back();
    const RestoredDetections restored = restoreDetections(result(), one, RunContext{});
    QCOMPARE(restored.detections.cameras.size(), std::size_t{1});
    QCOMPARE(restored.detections.cameras[0].camera, run_.detections.cameras[0].camera);
  }

  // Changes that do not affect the detection are accepted.
  void laterStages_mayChange() {
    Session other = session_;
    other.cameras[0].prior.time_offset = KnownNumber{0.001, 0.001};
    other.cameras[1].shutter = Shutter::Rolling;
    other.options.optimisation.edit().huber_sigma = 3.0;
    restoreDetections(result(), other, RunContext{});
  }

  void otherOptionsOfTheDetection_areReported_data() {
    QTest::addColumn<QString>("option");
    QTest::addColumn<QString>("value");
    QTest::newRow("events") << "detection.max_window_s"
                            << "0.04";
    QTest::newRow("lens that is calibrated first") << "intrinsics.model"
                                                   << "pinhole_equidistant";
  }
  void otherOptionsOfTheDetection_areReported() {
    QFETCH(const QString, option);
    QFETCH(const QString, value);
    Session other = session_;
    setOption(other.options, option.toStdString(), value.toStdString());
    LoggedText logged;
    restoreDetections(result(), other, RunContext{logged});
    QVERIFY2(QString::fromStdString(logged.text).contains(option), logged.text.c_str());
    LoggedText same;
    restoreDetections(result(), session_, RunContext{same});
    QVERIFY2(same.text.find("other options") == std::string::npos, same.text.c_str());
  }

  void anotherSession_isRefused_data() {
    QTest::addColumn<Change>("change");
    QTest::addColumn<QString>("said");
    const auto row = [](const char* name, const Change& change, const char* said) {
      QTest::newRow(name) << change << said;
    };
    row(
        "rows", [](Session& s) { s.board.rows = 9; }, "board.rows");
    row(
        "type", [](Session& s) { s.board.type = BoardType::SymmetricCircles; }, "board.type");
    row(
        "shade", [](Session& s) { s.board.circles = CircleShade::Bright; }, "board.circles");
    row(
        "radius", [](Session& s) { s.board.radius_m *= 0.8; }, "board.radius_m");
    row(
        "camera", [](Session& s) { s.cameras[1].name = "third"; },
        "camera 'third' is missing; existing cameras: events, frames");
    row(
        "stream", [](Session& s) { s.cameras[0].stream = "/other"; }, "cameras.events.stream");
    row(
        "clock", [](Session& s) { s.cameras[0].clock_offset_s = 1.0; }, "cameras.events.clock_offset_s");
    row(
        "rate of the clock", [](Session& s) { s.cameras[0].clock_scale = 0.5; },
        "cameras.events.clock_scale");
    row(
        "columns", [](Session& s) { s.cameras[0].columns = "t,y,x,p"; }, "cameras.events.columns");
    row(
        "mirroring", [](Session& s) { s.cameras[0].mirrored = Mirroring::X; }, "cameras.events.mirrored");
    row(
        "the other camera's clock", [](Session& s) { s.cameras[1].clock_scale = 1.0001; },
        "cameras.frames.clock_scale");
    row(
        "resolution",
        [](Session& s) {
          s.cameras[1].resolution_px = {100, 80};
        },
        "cameras.frames.resolution_px");
    row(
        "lens", [](Session& s) { s.cameras[0].intrinsics->focal_length_px.x() += 1e-3; },
        "with intrinsics other than");
    row(
        "lens not given", [](Session& s) { s.cameras[0].intrinsics.reset(); }, "the session gives none");
    row(
        "lens given", [](Session& s) { s.cameras[1].intrinsics = s.cameras[0].intrinsics; },
        "with intrinsics other than");
  }

  void anotherSession_isRefused() {
    QFETCH(const Change, change);
    QFETCH(const QString, said);
    Session other = session_;
    change(other);
    try {
      restoreDetections(result(), other, RunContext{});
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY2(QString(error.what()).contains(said), error.what());
    }
  }

  void damagedFolder_isRefused_data() {
    QTest::addColumn<QByteArray>("what");
    QTest::addColumn<QByteArray>("by");
    QTest::addColumn<QString>("said");
    QTest::newRow("of a part") << QByteArray("board:") << QByteArray("time_range_s: [1, 3]\nboard:")
                               << "the session covers the whole recording";
    QTest::newRow("of another time") << QByteArray("start_ns: 17") << QByteArray("start_ns: 16")
                                     << "another recording";
    QTest::newRow("of a later version")
        << QByteArray("evical_detections: 1") << QByteArray("evical_detections: 2") << "evical_detections";
    QTest::newRow("something else") << QByteArray("evical_detections") << QByteArray("evical_session")
                                    << "does not contain detections";
    QTest::newRow("without intrinsics")
        << QByteArray("detection_intrinsics") << QByteArray("lens") << "without intrinsics";
    QTest::newRow("kind") << QByteArray("kind: frames") << QByteArray("kind: film") << "film";
  }

  void damagedFolder_isRefused() {
    QFETCH(const QByteArray, what);
    QFETCH(const QByteArray, by);
    QFETCH(const QString, said);
    const QTemporaryDir copy;
    const std::filesystem::path folder = copy.path().toStdString();
    for (const char* name : {"detections.csv", "windows.csv", "detections.yaml"})
      std::filesystem::copy_file(result() / name, folder / name);
    replaceIn(folder / "detections.yaml", what, by);
    try {
      restoreDetections(folder, session_, RunContext{});
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY2(QString(error.what()).contains(said), error.what());
    }
  }

  void folderOfNoRun_isRefused() {
    QVERIFY_THROWS_EXCEPTION(CalibrationError, restoreDetections(path(), session_, RunContext{}));
  }
};

EVICAL_TEST(TestSavedDetections)
#include "tst_saved_detections.moc"
