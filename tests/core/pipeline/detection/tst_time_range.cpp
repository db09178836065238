// A part of a recording: the data within time_range_s, read from no more of the file than necessary.
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/detection/session_recording.h"
#include "core/pipeline/rig/calibration_checks.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

using namespace evical;

class TestTimeRange : public QObject {
  Q_OBJECT

 private slots:
  // A file that is truncated far beyond the range gives the same result as the complete one, without a
  // message about its end.
  void behindTheRange_nothingIsRead() {
    QTemporaryDir folder;
    Scenario scenario = readScenario(test::scenarioPath("davis346_10s"));
    scenario.duration_s = 5.0;
    const SimulationSummary made = simulate(scenario, folder.path().toStdString(), {});
    Session session = readSession(made.session);
    session.time_range_s = {0.5, 1.5};
    const DetectionResult whole = readAndDetect(session, {});
    std::filesystem::resize_file(made.recording, std::filesystem::file_size(made.recording) * 8 / 10);
    const DetectionResult part = readAndDetect(session, {});

    QVERIFY(whole.cameras[0].views.size() > 20);
    QCOMPARE(part.cameras[0].views.size(), whole.cameras[0].views.size());
    QCOMPARE(part.cameras[0].events, whole.cameras[0].events);
    QCOMPARE(part.imus[0].samples.size(), whole.imus[0].samples.size());
    for (const ImuSample& sample : part.imus[0].samples) {
      const double time_s = 1e-9 * static_cast<double>(sample.time_ns - part.start_ns);
      QVERIFY(time_s >= 0.5 && time_s <= 1.5);
    }
    for (const RecordingFault& fault : part.faults)
      QVERIFY2(fault.text.find("nothing after it is read") == std::string::npos, fault.text.c_str());

    // It is reported if the range extends that far.
    session.time_range_s = {0.5, 5.0};
    const DetectionResult to_the_end = readAndDetect(session, {});
    QVERIFY(std::ranges::any_of(to_the_end.faults, [](const RecordingFault& fault) {
      return fault.text.find("nothing after it is read") != std::string::npos;
    }));
  }

  // A clock that counts double, or ms as us, is reported with the repair; other differences of duration are
  // not a reason.
  void clockRates_areNamed_data() {
    QTest::addColumn<double>("imu_s");
    QTest::addColumn<double>("rate_hz");
    QTest::addColumn<QString>("key");
    QTest::addColumn<QString>("value");
    QTest::newRow("IMU doubled") << 40.0 << 100.0 << "imus.imu.clock_scale"
                                 << "0.5";
    QTest::newRow("ms read as us") << 0.02 << 2e5 << "imus.imu.clock_scale"
                                   << "1000";
    QTest::newRow("events in ms") << 20000.0 << 200.0 << "cameras.camera.clock_scale"
                                  << "1000";
    QTest::newRow("as long") << 20.1 << 200.0 << ""
                             << "";
    QTest::newRow("another length") << 27.0 << 200.0 << ""
                                    << "";
  }
  void clockRates_areNamed() {
    QFETCH(double, imu_s);
    QFETCH(double, rate_hz);
    QFETCH(QString, key);
    QFETCH(QString, value);
    BoardObservations seen;
    seen.camera = "camera";
    seen.windows.resize(2);
    seen.windows[1].time_s = 20.0;
    ImuData imu;
    imu.name = "imu";
    for (int i = 0; i <= static_cast<int>(imu_s * rate_hz); i += 4)  // every fourth, for the test's memory
      for (int k = 0; k < (imu_s > 1000.0 ? 1 : 4); ++k) {
        imu.samples.emplace_back();
        imu.samples.back().time_ns = std::llround(1e9 * (i + k) / rate_hz);
      }
    const CalibrationError error = calibrationFailed("imu", "nothing agrees", "Look");
    const CalibrationError found = withClockRate(error, Session{}, seen, std::span(&imu, 1));
    QCOMPARE(found.repair().has_value(), !key.isEmpty());
    if (key.isEmpty()) {
      QCOMPARE(std::string(found.what()), std::string(error.what()));
      return;
    }
    QCOMPARE(QString::fromStdString(found.repair()->key), key);
    QCOMPARE(QString::fromStdString(found.repair()->value), value);
    Session cut;
    cut.time_range_s = {0.0, 20.0};
    QVERIFY(!withClockRate(error, cut, seen, std::span(&imu, 1)).repair());
  }

  // The range counts from the session's first event or sample, also if the IMU starts later and is read
  // alone.
  void rangeOfIMUsAlone_countsFromTheSessionsStart() {
    QTemporaryDir folder;
    const std::filesystem::path path = folder.path().toStdString();
    std::string events = "t_s x y p\n", samples = "t_s,ax,ay,az,gx,gy,gz\n";
    for (int i = 0; i < 2000; ++i) events += fmt::format("{:.6f} 10 10 1\n", 100.0 + 0.005 * i);
    for (int i = 400; i < 2000; ++i)
      samples += fmt::format("{:.6f},0,0,9.8,0.1,0.2,0.3\n", 100.0 + 0.005 * i);
    writeFileWhole(path / "events.txt", events);
    writeFileWhole(path / "imu.csv", samples);
    Session session;
    session.recording = path / "events.txt";
    SessionCamera camera;
    camera.name = "camera";
    camera.stream = "events.txt";
    camera.resolution_px = {346, 260};
    session.cameras = {camera};
    SessionImu imu;
    imu.name = "imu";
    imu.stream = "imu.csv";
    imu.recording = path / "imu.csv";
    session.imus = {imu};
    session.time_range_s = {3.0, 8.0};
    const std::int64_t start_ns = SessionRecording(session).start_ns();
    QCOMPARE(qint64(start_ns), qint64(100'000'000'000));
    const DetectionResult detections = readImus(session, start_ns, {});
    QCOMPARE(qint64(detections.imus[0].samples.front().time_ns), qint64(103'000'000'000));
    QCOMPARE(qint64(detections.imus[0].samples.back().time_ns), qint64(108'000'000'000));
    session.time_range_s = {20.0, 30.0};
    try {
      readAndDetect(session, {});
      QFAIL("data in a range behind the end");
    } catch (const CalibrationError& error) {
      QCOMPARE(QString::fromStdString(error.problem()),
               QString("lasts 10.0 s, but time_range_s begins at 20 s"));
    }
  }

  // The file is the IMU's own one, if it has one.
  void fewSamples_areRefusedWithTheirFile_data() {
    QTest::addColumn<int>("samples");
    QTest::addColumn<bool>("own_file");
    QTest::addColumn<QString>("problem");
    QTest::newRow("none") << 0 << true << "IMU imu has no samples";
    QTest::newRow("none, of the session's recording") << 0 << false << "IMU imu has no samples";
    QTest::newRow("one") << 1 << true << "IMU imu has 1 sample";
    QTest::newRow("three") << 3 << true << "IMU imu has 3 samples";
    QTest::newRow("enough") << 50 << true << "";
  }
  void fewSamples_areRefusedWithTheirFile() {
    QFETCH(int, samples);
    QFETCH(bool, own_file);
    QFETCH(QString, problem);
    QTemporaryDir folder;
    const std::filesystem::path path = folder.path().toStdString();
    std::string table = "t_s,ax,ay,az,gx,gy,gz\n";
    for (int i = 0; i < samples; ++i) table += fmt::format("{:.6f},0,0,9.8,0.1,0.2,0.3\n", 0.005 * i);
    writeFileWhole(path / "imu.csv", table);
    Session session;
    session.recording = path / (own_file ? "recording.bag" : "imu.csv");
    SessionImu imu;
    imu.name = "imu";
    imu.stream = "imu.csv";
    if (own_file) imu.recording = path / "imu.csv";
    session.imus = {imu};
    try {
      readImus(session, 0, {});
      QVERIFY(problem.isEmpty());
    } catch (const CalibrationError& error) {
      QCOMPARE(QString::fromStdString(error.problem()), problem);
      QCOMPARE(error.place(), (path / "imu.csv").string());
    }
  }
};

EVICAL_TEST(TestTimeRange)
#include "tst_time_range.moc"
