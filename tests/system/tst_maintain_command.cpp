// `evical maintain`: verdicts as exit codes, files, JSON alone on stdout, and invalid input, for which
// nothing is written.
#include "tests/support/test_program.h"
#include "tests/system/program.h"

#include <QDir>
#include <QFile>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QRegularExpression>
#include <QTemporaryDir>

#include <cmath>
#include <csignal>
#include <functional>

using namespace evical::test;

class TestMaintainCommand : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;

  QString path(const QString& name) const { return folder_.filePath(name); }
  QString scenario(const QString& name) const {
    return inSources("config/scenarios/maintain/" + name + ".yaml");
  }
  QStringList maintain(const QString& name, const QString& log = {}, const QString& out = "out") const {
    return {"maintain", log.isEmpty() ? path(name) + "/recording.bag" : log,
            "--result", path(name) + "/calibration",
            "-o",       path(out),
            "--quiet"};
  }
  void simulate(const QString& name, const QStringList& more = {}) {
    const Outcome made =
        runProgram(QStringList{"simulate", scenario(name), "-o", path(name), "--quiet"} + more);
    VERIFY_OUTCOME(made, 0);
  }

  // imu.csv in EuRoC's format, with each line changed.
  QString changedLog(const QString& name, const std::function<void(QList<double>&)>& change) const {
    QStringList lines =
        QString::fromUtf8(readFile(path("stops_csv") + "/imu.csv")).split('\n', Qt::SkipEmptyParts);
    for (QString& line : lines) {
      if (line.startsWith('#')) continue;
      const QStringList words = line.split(',');
      QList<double> values;
      for (int i = 1; i < words.size(); ++i) values.push_back(words[i].toDouble());
      change(values);
      line = words.front();
      for (const double value : values) line += "," + QString::number(value, 'g', 12);
    }
    QDir().mkpath(path(name));
    writeFile(path(name) + "/imu.csv", (lines.join('\n') + '\n').toUtf8());
    return path(name);
  }

  QString changedTrajectory(const QString& name, const std::function<void(QList<double>&)>& change) const {
    QStringList lines = QString::fromUtf8(readFile(path("drive_trajectory") + "/trajectory.csv"))
                            .split('\n', Qt::SkipEmptyParts);
    for (int k = 1; k < lines.size(); ++k) {
      QList<double> values;
      for (const QString& word : lines[k].split(',')) values.push_back(word.toDouble());
      change(values);
      QStringList words;
      for (const double value : values) words.push_back(QString::number(value, 'g', 15));
      lines[k] = words.join(' ');
    }
    lines.removeFirst();
    writeFile(path(name), (lines.join('\n') + '\n').toUtf8());
    return path(name);
  }

 private slots:
  void initTestCase() {
    simulate("drive_stops");
    simulate("step_rotation");
    simulate("none");
    simulate("drive_trajectory");
    const Outcome csv = runProgram(
        {"simulate", scenario("drive_stops"), "-o", path("stops_csv"), "--format", "csv", "--quiet"});
    VERIFY_OUTCOME(csv, 0);
  }

  void stops_sayWhatHasChanged() {
    const Outcome outcome = runProgram(maintain("drive_stops"));
    VERIFY_OUTCOME(outcome, 3);
    const QString yaml = QString::fromUtf8(readFile(path("out/maintenance.yaml")));
    QVERIFY2(yaml.startsWith("evical_maintenance: 1\nverdict: changed\nreason: "),
             qPrintable(yaml.left(200)));
    QVERIFY(yaml.contains("accelerometer bias of imu by 0.2"));
    for (const char* const file : {"report.html", "stops.csv", "log.txt"})
      QVERIFY2(QFile::exists(path("out/") + file), file);
    QVERIFY(QString::fromUtf8(readFile(path("out/report.html"))).contains("<svg"));
  }

  // Half of an IMU would look like a large change.
  void logsOfOneSensor_areRefused_data() {
    QTest::addColumn<bool>("gyroscope");
    QTest::addColumn<QString>("problem");
    QTest::newRow("no gyroscope") << false << "has no measurements of the gyroscope";
    QTest::newRow("no accelerometer") << true << "has no measurements of the accelerometer";
  }
  void logsOfOneSensor_areRefused() {
    QFETCH(bool, gyroscope);
    QFETCH(QString, problem);
    const QString log = changedLog("half", [gyroscope](QList<double>& values) {
      for (int k = 0; k < 3; ++k) values[gyroscope ? k + 3 : k] = 0.0;
    });
    const Outcome outcome = runProgram(
        {"maintain", log, "--result", path("stops_csv/calibration"), "-o", path("out_half"), "--quiet"});
    VERIFY_OUTCOME(outcome, 2);
    QVERIFY2(outcome.errors.contains(problem), qPrintable(outcome.errors));
    QVERIFY(!QFile::exists(path("out_half/maintenance.yaml")));
  }

  // More orientations would be no advice for such a log.
  void logsOfFewSamples_areRefused() {
    const QByteArray log = readFile(path("stops_csv") + "/imu.csv");
    QDir().mkpath(path("few"));
    writeFile(path("few") + "/imu.csv", log.left(log.indexOf('\n', log.indexOf('\n') + 1) + 1));
    const Outcome outcome = runProgram({"maintain", path("few"), "--result", path("stops_csv/calibration"),
                                        "-o", path("out_few"), "--quiet"});
    VERIFY_OUTCOME(outcome, 2);
    QVERIFY2(outcome.errors.contains("imu has 1 sample"), qPrintable(outcome.errors));
    QVERIFY(!QFile::exists(path("out_few/maintenance.yaml")));
  }

  // A calibration with another interpretation of the IMU's axes than the log: stops detect it.
  void axesOfTheCalibration_areThoseOfTheLog() {
    const QString log = changedLog("turned", [](QList<double>& values) {
      const QList<double> as = values;
      values = {as[1], as[0], -as[2], as[4], as[3], -as[5]};  // its own inverse
    });
    QDir().mkpath(path("turned/calibration"));
    QFile::copy(path("stops_csv/calibration/result.yaml"), path("turned/calibration/result.yaml"));
    const auto verdictOf = [&](const QString& result, const QString& out) {
      const Outcome outcome =
          runProgram({"maintain", log, "--result", result, "-o", path(out), "--json", "--quiet"});
      return QJsonDocument::fromJson(outcome.output.toUtf8()).object();
    };
    const QJsonObject as_it_was =
        QJsonDocument::fromJson(
            runProgram({"maintain", path("stops_csv"), "--result", path("stops_csv/calibration"), "-o",
                        path("out_straight"), "--json", "--quiet"})
                .output.toUtf8())
            .object();
    writeFile(path("turned/calibration/run_session.yaml"),
              "evical_session: 1\nrecording: gone.csv\n"
              "board: {type: asymmetric_circles, rows: 11, cols: 4, spacing_m: 0.05, radius_m: 0.02}\n"
              "cameras: {left: {stream: events, resolution_px: [346, 260]}}\n"
              "imus: {imu: {stream: imu, accelerometer_noise_density: 0.01, gyroscope_noise_density: 0.001, "
              "gyroscope_axes: \"y,x,-z\", accelerometer_axes: \"y,x,-z\"}}\n");
    const QJsonObject turned = verdictOf(path("turned/calibration"), "out_turned");
    QVERIFY(!as_it_was["verdict"].toString().isEmpty());
    QCOMPARE(turned["verdict"], as_it_was["verdict"]);
    QCOMPARE(turned["reason"], as_it_was["reason"]);
  }

  void step_isNamedWithItsTime_inJson() {
    QStringList arguments = maintain("step_rotation", {}, "out_step");
    arguments.push_back("--json");
    const Outcome outcome = runProgram(arguments);
    VERIFY_OUTCOME(outcome, 3);
    const QJsonObject json = QJsonDocument::fromJson(outcome.output.toUtf8()).object();
    QCOMPARE(json["evical_maintenance"].toInt(), 1);
    const QJsonArray steps = json["steps"].toArray();
    QCOMPARE(steps.size(), 1);
    QCOMPARE(steps[0].toObject()["quantity"].toString(), QStringLiteral("rotation"));
    QCOMPARE(steps[0].toObject()["sensor"].toString(), QStringLiteral("rear"));
    QVERIFY(std::abs(steps[0].toObject()["at_s"].toDouble() - 60.0) <= 2.0);
    QVERIFY(std::abs(steps[0].toObject()["change"].toDouble() - 0.5) < 0.05);
    QVERIFY(QFile::exists(path("out_step/track1.csv")));
  }

  // All others see the same step at the same moment.
  void stepOfTheReference_isItsOwn() {
    writeFile(path("reference.yaml"), ("base: " + scenario("three_imus_hour") +
                                       "\nduration_s: 120\nsteps:\n  - {imu: front, at_s: 55, "
                                       "accelerometer_bias_m_s2: [0.15, -0.12, 0.1]}\n")
                                          .toUtf8());
    VERIFY_OUTCOME(runProgram({"simulate", path("reference.yaml"), "-o", path("reference"), "--quiet"}), 0);
    QStringList arguments = maintain("reference", {}, "out_reference");
    arguments.push_back("--json");
    const Outcome outcome = runProgram(arguments);
    VERIFY_OUTCOME(outcome, 3);
    const QJsonArray steps =
        QJsonDocument::fromJson(outcome.output.toUtf8()).object().value("steps").toArray();
    QCOMPARE(steps.size(), 1);
    const QJsonObject step = steps.first().toObject();
    QCOMPARE(step.value("sensor").toString(), QString("front"));
    QCOMPARE(step.value("against").toString(), QString());
    QCOMPARE(step.value("quantity").toString(), QString("accelerometer_bias"));
    QVERIFY(std::abs(step.value("at_s").toDouble() - 55.0) <= 2.0);
    QVERIFY(std::abs(step.value("change").toDouble() - 0.2166) < 0.02);
  }

  void shakenMounts_areNoChange() {
    simulate("shaken");
    const Outcome outcome = runProgram(maintain("shaken", {}, "out_shaken"));
    VERIFY_OUTCOME(outcome, 4);
    QVERIFY2(outcome.output.contains("mount them more stiffly"), qPrintable(outcome.output));
  }

  void nothing_isNoChange() { VERIFY_OUTCOME(runProgram(maintain("none", {}, "out_none")), 0); }

  void trajectory_saysTheSameAsStops() {
    const QStringList arguments = maintain("drive_trajectory", {}, "out_trajectory") +
                                  QStringList{"--trajectory", path("drive_trajectory") + "/trajectory.csv"};
    const Outcome outcome = runProgram(arguments);
    VERIFY_OUTCOME(outcome, 3);
    const QString yaml = QString::fromUtf8(readFile(path("out_trajectory/maintenance.yaml")));
    QVERIFY2(yaml.contains("from: trajectory"), qPrintable(yaml));
    QVERIFY2(yaml.contains("accelerometer bias of imu by 0.2"), qPrintable(yaml));
  }

  void withoutStops_itCannotTell() {
    const Outcome outcome = runProgram(maintain("drive_trajectory", {}, "out_moving"));
    VERIFY_OUTCOME(outcome, 4);
    QVERIFY2(outcome.output.contains("cannot tell"), qPrintable(outcome.output));
    QVERIFY2(outcome.output.contains("to do: "), qPrintable(outcome.output));
  }

  void oneLogTwice_isRefused() {
    const Outcome outcome = runProgram({"maintain", path("drive_stops") + "/recording.bag",
                                        path("drive_stops") + "/recording.bag", "--result",
                                        path("drive_stops") + "/calibration", "-o", path("out_twice")});
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, "overlaps in time with another log");
  }

  void wrongUnits_areSaid_data() {
    QTest::addColumn<double>("rates");
    QTest::addColumn<double>("forces");
    QTest::addColumn<QString>("says");
    QTest::addColumn<QStringList>("mended");
    QTest::newRow("g") << 1.0 << 1.0 / 9.80665 << "the log is in g"
                       << QStringList{"--acceleration-unit", "g"};
    QTest::newRow("deg/s") << 57.29578 << 1.0 << "the rates are in deg/s"
                           << QStringList{"--angular-rate-unit", "deg/s"};
  }
  void wrongUnits_areSaid() {
    QFETCH(const double, rates);
    QFETCH(const double, forces);
    QFETCH(const QString, says);
    QFETCH(const QStringList, mended);
    const QString log = changedLog("units", [&](QList<double>& v) {
      for (int i = 0; i < 3; ++i) v[i] *= rates;
      for (int i = 3; i < 6; ++i) v[i] *= forces;
    });
    const Outcome outcome = runProgram(maintain("drive_stops", log, "out_units"));
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, says);
    QVERIFY(!QDir(path("out_units")).exists());
    const Outcome right = runProgram(maintain("drive_stops", log, "out_mended") + mended);
    VERIFY_OUTCOME(right, 3);
    QVERIFY(right.output.contains("accelerometer bias of imu by 0.2"));
  }

  void gaps_areSaid() {
    QStringList lines =
        QString::fromUtf8(readFile(path("stops_csv") + "/imu.csv")).split('\n', Qt::SkipEmptyParts);
    lines.erase(lines.begin() + 3000, lines.begin() + 3400);
    QDir().mkpath(path("gap"));
    writeFile(path("gap") + "/imu.csv", (lines.join('\n') + '\n').toUtf8());
    const Outcome outcome = runProgram(maintain("drive_stops", path("gap"), "out_gap"));
    VERIFY_OUTCOME(outcome, 3);
    QVERIFY2(outcome.output.contains("samples are missing, for 2.0"), qPrintable(outcome.output));
  }

  void otherTrajectories_areRefused_data() {
    QTest::addColumn<int>("kind");
    QTest::addColumn<QString>("says");
    QTest::newRow("another frame") << 0 << "of another frame, rotated by 90.0 deg";
    QTest::newRow("not in metres") << 1 << "not in metres";
    QTest::newRow("inverted") << 2 << "imu_from_world";
    QTest::newRow("w first") << 3 << "in the order w, x, y, z";
    QTest::newRow("another time") << 4 << "does not overlap in time";
    QTest::newRow("no rotations") << 5 << "not a rotation";
    QTest::newRow("backwards") << 6 << "time runs backwards";
    QTest::newRow("a point at a lever arm from it") << 7 << "of a point";
  }
  void otherTrajectories_areRefused() {
    QFETCH(const int, kind);
    QFETCH(const QString, says);
    const QString file = changedTrajectory("bad.txt", [&](QList<double>& v) {
      const double x = v[4], y = v[5], z = v[6], w = v[7];
      if (kind == 0) {  // by a quarter about z
        const double c = std::sqrt(0.5);
        v[4] = c * (x + y), v[5] = c * (y - x), v[6] = c * (z + w), v[7] = c * (w - z);
      }
      for (int i = 1; kind == 1 && i < 4; ++i) v[i] *= 1.5;
      for (int i = 4; kind == 2 && i < 7; ++i) v[i] = -v[i];
      if (kind == 3) v[4] = w, v[5] = x, v[6] = y, v[7] = z;
      if (kind == 4) v[0] += 5000.0;
      if (kind == 5) v[7] += 0.5;
      if (kind == 6) v[0] = -v[0];
      if (kind == 7) {  // by 0.3 m along the IMU's x
        v[1] += 0.3 * (1.0 - 2.0 * (y * y + z * z)), v[2] += 0.6 * (x * y + z * w),
            v[3] += 0.6 * (x * z - y * w);
      }
    });
    const Outcome outcome =
        runProgram(maintain("drive_trajectory", {}, "out_bad") + QStringList{"--trajectory", file});
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, says);
    QVERIFY(!QDir(path("out_bad")).exists());
  }

  void badInput_isSaid_data() {
    QTest::addColumn<QStringList>("arguments");
    QTest::addColumn<QString>("says");
    const QString log = path("drive_stops") + "/recording.bag", result = path("drive_stops") + "/calibration";
    writeFile(path("empty.csv"), "");
    QTest::newRow("no log") << QStringList{path("gone.bag"), "--result", result} << "does not exist";
    QTest::newRow("empty log") << QStringList{path("empty.csv"), "--result", result} << "the file is empty";
    QTest::newRow("no result") << QStringList{log, "--result", path("gone")} << "does not exist";
    QTest::newRow("a stream that is not there")
        << QStringList{simulated("still"), "--result", result, "--imu", "imu=/gone"}
        << "no stream matches an IMU of the old result";
    QTest::newRow("an IMU that the result does not know")
        << QStringList{path("none") + "/recording.bag", "--result", result}
        << "no stream matches an IMU of the old result: streams /front/imu, /rear/imu";
    QTest::newRow("a name that the result does not know")
        << QStringList{log, "--result", result, "--imu", "front=/imu"} << "no IMU of this name";
    QTest::newRow("a session for a result")
        << QStringList{log, "--result", simulated("still") + "/session.yaml"} << "neither a result";
    QTest::newRow("no option") << QStringList{log, "--result", result, "--set", "maintain.lags=3"} << "lag_s";
  }
  void badInput_isSaid() {
    QFETCH(const QStringList, arguments);
    QFETCH(const QString, says);
    const Outcome outcome =
        runProgram(QStringList{"maintain"} + arguments + QStringList{"-o", path("out_none_made")});
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, says);
    QVERIFY(!QDir(path("out_none_made")).exists());
  }

  // One IMU of a drive, the other of another drive at the same time.
  void imusOfOtherBodies_cannotTell() {
    writeFile(path("other_seed.yaml"), ("base: " + scenario("none") + "\nseed: 77\n").toUtf8());
    VERIFY_OUTCOME(runProgram({"simulate", path("other_seed.yaml"), "-o", path("other_seed"), "--quiet"}), 0);
    const Outcome outcome =
        runProgram({"maintain", path("none") + "/recording.bag", path("other_seed") + "/recording.bag",
                    "--result", path("none") + "/calibration", "-o", path("out_other"), "--quiet", "--imu",
                    "front=" + path("none") + "/recording.bag", "--imu",
                    "rear=" + path("other_seed") + "/recording.bag"});
    VERIFY_OUTCOME(outcome, 4);
    QVERIFY2(outcome.output.contains("does not match that of"), qPrintable(outcome.output));
  }

  // A log in -g, and a sensor that was mounted upside down.
  void opposedForces_areSaid() {
    writeFile(path("turned_over.yaml"),
              ("base: " + scenario("none") +
               "\nduration_s: 5\nimus:\n  - {}\n  - reference_from_imu: {rotation_xyzw: "
               "[0.7233, 0.69, -0.015, -0.02], translation_m: [-0.35, 0.12, 0.08]}\n")
                  .toUtf8());
    VERIFY_OUTCOME(runProgram({"simulate", path("turned_over.yaml"), "-o", path("turned_over"), "--quiet"}),
                   0);
    const Outcome outcome =
        runProgram(maintain("turned_over", path("none") + "/recording.bag", "out_turned_over"));
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, "rear: its specific force is opposite to that of front");
    QVERIFY(!QDir(path("out_turned_over")).exists());
  }

  void cancelled_leavesNothing() {
    const Outcome outcome =
        interruptProgram({"maintain", path("none") + "/recording.bag", "--result",
                          path("none") + "/calibration", "-o", path("out_cut")},
                         SIGINT, [](const QString& errors) { return errors.contains("look"); });
    if (outcome.exit_code == 0) QSKIP("it ended before it could be stopped");
    VERIFY_OUTCOME(outcome, 1);
    QVERIFY(!QDir(path("out_cut")).exists());
  }
};

EVICAL_TEST(TestMaintainCommand)
#include "tst_maintain_command.moc"
