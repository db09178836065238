// The whole program: its files, its exit codes, and the remaining files after an interruption or on a full
// disk.
#include "core/report/truth_comparison.h"
#include "tests/support/test_program.h"
#include "tests/system/program.h"

#include <QDir>
#include <QElapsedTimer>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QRegularExpression>
#include <QTemporaryDir>

#include <cmath>
#include <csignal>
#include <filesystem>

using namespace evical::test;

namespace {

const QStringList kResultFiles = {"detections.csv", "detections.yaml", "kalibr",           "log.txt",
                                  "plots",          "report.html",     "residuals.csv",    "result.yaml",
                                  "run.data",       "run.yaml",        "run_session.yaml", "trajectory.csv",
                                  "windows.csv"};
// With an input file for the IMU of this name.
QStringList kalibrFiles(const QString& imu) {
  return {"camchain-imucam.yaml", "camchain.yaml", "imu.yaml", "input-" + imu + ".yaml"};
}

QString session(const QString& recording = "short") {
  return simulated(recording) + "/session.yaml";
}

#define VERIFY_EXIT(outcome, code)        \
  QVERIFY2((outcome).exit_code == (code), \
           qPrintable(QStringLiteral("exit code %1\n").arg((outcome).exit_code) + (outcome).errors))

}  // namespace

class TestCommandLine : public QObject {
  Q_OBJECT

 private slots:
  void help_isThereForEveryCommand();
  void version_startsFast();
  void usage_thatIsWrongEndsWith2_data();
  void usage_thatIsWrongEndsWith2();
  void unknownWords_areNamed_data();
  void unknownWords_areNamed();
  void options_asMarkdownAreTheManual();
  void options_asYamlAreTheDefaultFile();
  void board_isWrittenAsPdfSvgAndPng();
  void boardThatBlinks_isAPage();
  void simulate_isTheSameFromTheSameSeed();
  void calibrate_writesAResultNearTheTruth_data();
  void calibrate_writesAResultNearTheTruth();
  void calibrate_profileTellsWhereItsTimeGoes();
  void export_writesTheFoldersOfTargets();
  void export_ofBadInputWritesNothing_data();
  void export_ofBadInputWritesNothing();
  void export_goesOnWhereOneTargetRefuses();
  void export_check_tellsWhatItRead();
  void export_check_findsWhatIsInTheWay();
  void export_check_ofEarlierFiles();
  void export_toAll_namesWhatRefuses();
  void import_writesASession();
  void init_writesTheSessionThatTheRecordingSuggests_data();
  void init_writesTheSessionThatTheRecordingSuggests();
  void init_takesSensorsOfSeveralRecordings();
  void inspect_writesHugeMeansBriefly();
  void detect_writesDetectionsOnly();
  void detect_ofSeveralRecordingsWritesAFolderEach();
  void calibrate_startsFromDetections();
  void quiet_saysNothingButTheResult();
  void interruption_leavesNothingHalfWritten_data();
  void interruption_leavesNothingHalfWritten();
  void interruption_ofASimulationLeavesNothing();
  void folder_thatCannotBeMadeIsRefused();
  void diskFull_leavesTheOldResult();
  void failure_isInTheResultOfAFolderThatWasThere();
};

void TestCommandLine::help_isThereForEveryCommand() {
  const Outcome all = runProgram({"--help"});
  VERIFY_EXIT(all, 0);
  for (const QString command : {"calibrate", "detect", "simulate", "inspect", "convert", "options", "board",
                                "compare", "export", "import", "init"}) {
    QVERIFY2(all.output.contains(command), qPrintable(command));
    const Outcome outcome = runProgram({command, "--help"});
    VERIFY_EXIT(outcome, 0);
    QVERIFY(outcome.output.contains("-h,--help"));
    QVERIFY2(outcome.output.contains("Example:\n  evical " + command), qPrintable(outcome.output));
  }
  QVERIFY2(all.output.contains("Start with `evical init"), qPrintable(all.output));
  for (const QString command : {"inspect", "convert", "simulate"})  // arguments are in capitals
    QVERIFY(
        !runProgram({command, "--help"}).output.contains(QRegularExpression("\\n  (recording|scenario) ")));
}

void TestCommandLine::version_startsFast() {
  QElapsedTimer timer;
  timer.start();
  const Outcome outcome = runProgram({"--version"});
  VERIFY_EXIT(outcome, 0);
  QVERIFY(QRegularExpression("^evical \\d+\\.\\d+\\.\\d+\\n$").match(outcome.output).hasMatch());
  QVERIFY2(timer.elapsed() < 500,
           qPrintable(QString::number(timer.elapsed())));  // some 10 ms on an idle machine
}

void TestCommandLine::usage_thatIsWrongEndsWith2_data() {
  QTest::addColumn<QStringList>("arguments");
  QTest::newRow("no command") << QStringList{};
  QTest::newRow("unknown command") << QStringList{"calibrat"};
  QTest::newRow("no session") << QStringList{"calibrate", "-o", "x"};
  QTest::newRow("no folder") << QStringList{"calibrate", session()};
  QTest::newRow("unknown flag") << QStringList{"options", "--pdf"};
  QTest::newRow("setting without value") << QStringList{"calibrate", session(), "-o", "x", "--set", "grid"};
  QTest::newRow("board as a picture") << QStringList{"board", "-o", "board.jpg"};
  QTest::newRow("board as a page that does not blink") << QStringList{"board", "-o", "board.html"};
  QTest::newRow("board that blinks on paper") << QStringList{"board", "--blink", "-o", "board.pdf"};
}

void TestCommandLine::usage_thatIsWrongEndsWith2() {
  QFETCH(QStringList, arguments);
  const Outcome outcome = runProgram(arguments);
  VERIFY_EXIT(outcome, 2);
  QVERIFY(!outcome.reason().isEmpty());
}

void TestCommandLine::unknownWords_areNamed_data() {
  QTest::addColumn<QStringList>("arguments");
  QTest::addColumn<QString>("said");
  QTest::newRow("command") << QStringList{"calibrat"}
                           << "unknown command 'calibrat'. Did you mean 'calibrate'?";
  QTest::newRow("command with its arguments")
      << QStringList{"inti", "r.bag", "-o", "s.yaml"} << "unknown command 'inti'. Did you mean 'init'?";
  QTest::newRow("command that is like no other")
      << QStringList{"xyzzyxyzzy"} << "Known names: init, calibrate";
  QTest::newRow("required option") << QStringList{"calibrate", "s.yaml", "--ouput", "x"}
                                   << "unknown option --ouput. Did you mean '--output'?";
  QTest::newRow("with a value") << QStringList{"calibrate", "s.yaml", "-o", "x", "--treads=2"}
                                << "unknown option --treads. Did you mean '--threads'?";
  QTest::newRow("flag") << QStringList{"inspect", "--jsno", "r.bag"}
                        << "unknown option --jsno. Did you mean '--json'?";
  QTest::newRow("of the program") << QStringList{"--verson"}
                                  << "unknown option --verson. Did you mean '--version'?";
  QTest::newRow("short") << QStringList{"calibrate", "s.yaml", "-o", "x", "-z"} << "unknown option -z";
  QTest::newRow("missing") << QStringList{"calibrate", "s.yaml"} << "--output is required";
  QTest::newRow("no command") << QStringList{} << "no command is given";
}

void TestCommandLine::unknownWords_areNamed() {
  QFETCH(QStringList, arguments);
  QFETCH(QString, said);
  const Outcome outcome = runProgram(arguments);
  VERIFY_EXIT(outcome, 2);
  QVERIFY2(outcome.reason().contains(said), qPrintable(outcome.errors));
}

void TestCommandLine::options_asMarkdownAreTheManual() {
  const Outcome outcome = runProgram({"options", "--markdown"});
  VERIFY_EXIT(outcome, 0);
  QVERIFY2(outcome.output.toUtf8() == readFile(inSources("docs/options.md")),
           "docs/options.md is outdated: evical options --markdown > docs/options.md");
}

void TestCommandLine::options_asYamlAreTheDefaultFile() {
  const Outcome outcome = runProgram({"options", "--yaml"});
  VERIFY_EXIT(outcome, 0);
  QVERIFY2(outcome.output.toUtf8() == readFile(inSources("config/default.yaml")),
           "config/default.yaml is outdated: evical options --yaml > config/default.yaml");
}

void TestCommandLine::boardThatBlinks_isAPage() {
  QTemporaryDir folder;
  for (const QString type :
       {"asymmetric_circles", "symmetric_circles", "checkerboard", "aprilgrid", "charuco"}) {
    const QString page = folder.filePath(type + ".html");
    const Outcome outcome = runProgram({"board", "--type", type, "--rows", "7", "--cols", "4", "--spacing-m",
                                        "0.05", "--blink", "-o", page});
    QVERIFY2(outcome.exit_code == 0, qPrintable(outcome.errors));
    QVERIFY(readFile(page).startsWith("<!DOCTYPE html>"));
    QVERIFY(readFile(page).contains(("type: \"" + type + "\", rows: 7, cols: 4").toUtf8()));
  }
}

void TestCommandLine::board_isWrittenAsPdfSvgAndPng() {
  QTemporaryDir folder;
  for (const QString file : {"board.pdf", "board.svg", "board.png"}) {
    const Outcome outcome = runProgram({"board", "--rows", "7", "--cols", "3", "--spacing-m", "0.03",
                                        "--radius-m", "0.01", "--paper", "A4", "-o", folder.filePath(file)});
    VERIFY_EXIT(outcome, 0);
    QVERIFY(readFile(folder.filePath(file)).size() > 1000);
  }
  QVERIFY(readFile(folder.filePath("board.pdf")).startsWith("%PDF"));
  QVERIFY(readFile(folder.filePath("board.png")).startsWith("\x89PNG"));
  QVERIFY(readFile(folder.filePath("board.svg")).contains("<svg"));
}

void TestCommandLine::simulate_isTheSameFromTheSameSeed() {
  QTemporaryDir folder;
  writeFile(folder.filePath("tiny.yaml"),
            "base: " + inSources("tests/system/short.yaml").toUtf8() + "\nduration_s: 0.2\nseed: 5\n");
  for (const QString name : {"a", "b"}) {
    const Outcome outcome =
        runProgram({"simulate", folder.filePath("tiny.yaml"), "-o", folder.filePath(name)});
    VERIFY_EXIT(outcome, 0);
  }
  for (const QString file : {"events.txt", "imu.txt", "session.yaml", "truth.yaml"})
    QCOMPARE(readFile(folder.filePath("a/" + file)), readFile(folder.filePath("b/" + file)));
}

void TestCommandLine::calibrate_writesAResultNearTheTruth_data() {
  QTest::addColumn<QString>("recording");
  QTest::newRow("text") << "short";
  QTest::newRow("bag") << "short_bag";
}

void TestCommandLine::calibrate_writesAResultNearTheTruth() {
  QFETCH(QString, recording);
  QTemporaryDir folder;
  const QString result = folder.filePath("new/result");
  const Outcome outcome = runProgram({"calibrate", session(recording), "-o", result});
  VERIFY_EXIT(outcome, 0);
  QCOMPARE(filesIn(result), kResultFiles);
  QCOMPARE(filesIn(result + "/kalibr"), kalibrFiles("left_imu"));
  QVERIFY2(!outcome.errors.contains("planar poses") && !outcome.output.contains("random walks"),
           qPrintable(outcome.errors + outcome.output));
  const QByteArray log = readFile(result + "/log.txt");
  QVERIFY(log.contains("planar poses") && log.contains("random walks are not measured"));
  QVERIFY(!outcome.errors.contains("exists: "));
  const QByteArray yaml = readFile(result + "/result.yaml");
  for (const char* key :
       {"evical_result: 1", "status: ", "reference: left_imu", "rotation_std_deg:", "time_offset_std_s:",
        "gravity_m_s2:", "observability:", "timing_s:", "memory_peak_mb:", "program:"})
    QVERIFY2(yaml.contains(key), key);
  QVERIFY(readFile(result + "/trajectory.csv").count('\n') > 900);  // 200 Hz over most of 6 s

  // A fifth of the recording of the accuracy table.
  const auto path = [](const QString& file) { return std::filesystem::path(file.toStdString()); };
  const evical::TruthComparison comparison =
      evical::compareWithTruth(evical::readResultYaml(path(result + "/result.yaml")),
                               evical::readResultYaml(path(simulated(recording) + "/truth.yaml")));
  QVERIFY2(comparison.cameras.at(0).rotation_deg < 0.2, qPrintable(outcome.output));
  QVERIFY2(comparison.cameras.at(0).translation_mm < 4.0, qPrintable(outcome.output));
  QVERIFY2(comparison.cameras.at(0).time_offset_ms < 0.4, qPrintable(outcome.output));

  const Outcome table =
      runProgram({"compare", result + "/result.yaml", simulated(recording) + "/truth.yaml"});
  VERIFY_EXIT(table, 0);
  QVERIFY(table.output.contains("left"));
}

namespace {

const QByteArray kSmallResult =
    "evical_result: 1\nstatus: ok\nreference: imu\ncameras:\n  left:\n    reference_from_camera: "
    "{rotation_xyzw: [0, 0, 0, 1], "
    "translation_m: [0.1, 0, 0]}\n    intrinsics: {model: pinhole_radtan, resolution_px: [346, 260], "
    "focal_length_px: "
    "[260, 260], principal_point_px: [170, 130], distortion: [0, 0, 0, 0]}\nimus:\n  imu:\n    "
    "reference_from_imu: "
    "{rotation_xyzw: [0, 0, 0, 1], translation_m: [0, 0, 0]}\n";

}  // namespace

void TestCommandLine::calibrate_profileTellsWhereItsTimeGoes() {
  const QTemporaryDir folder;
  const QString trace = folder.filePath("trace.json");
  VERIFY_EXIT(runProgram({"calibrate", session(), "-o", folder.filePath("result"), "--profile", trace}), 0);
  QStringList stages;
  for (const QJsonValue& event : QJsonDocument::fromJson(readFile(trace)).object()["traceEvents"].toArray())
    if (event["ph"].toString() == "X" && event["tid"].toInt() == 0) stages.append(event["name"].toString());
  QCOMPARE(stages, (QStringList{"detect", "initialise", "optimise", "split_half_check"}));
}

void TestCommandLine::export_writesTheFoldersOfTargets() {
  QTemporaryDir folder;
  writeFile(folder.filePath("result.yaml"), kSmallResult);
  for (const QString& result : {folder.path(), folder.filePath("result.yaml")}) {
    const QString output = folder.filePath("new/" + QFileInfo(result).fileName());
    const Outcome outcome =
        runProgram({"export", result, "--to", "kalibr,openvins", "--to", "ros", "-o", output});
    VERIFY_EXIT(outcome, 0);
    QCOMPARE(filesIn(output), (QStringList{"kalibr", "openvins", "ros"}));
    QCOMPARE(filesIn(output + "/kalibr"), kalibrFiles("imu"));
    QVERIFY(outcome.output.contains("random walks are not measured"));
  }
}

void TestCommandLine::export_ofBadInputWritesNothing_data() {
  QTest::addColumn<QByteArray>("result");  // empty: none
  QTest::addColumn<QString>("target");
  QTest::addColumn<QString>("said");
  QTest::newRow("no result") << QByteArray() << "kalibr"
                             << "does not exist";
  QTest::newRow("no YAML") << QByteArray("[1, 2") << "kalibr"
                           << "result.yaml";
  QTest::newRow("later version") << QByteArray(kSmallResult).replace("evical_result: 1", "evical_result: 7")
                                 << "kalibr"
                                 << "evical_result";
  QTest::newRow("failed")
      << QByteArray(kSmallResult).replace("status: ok", "status: failed\nreason: no board") << "kalibr"
      << "no board";
  QTest::newRow("unknown target") << kSmallResult << "kalibre"
                                  << "Did you mean 'kalibr'?";
  QTest::newRow("one camera as a pair") << kSmallResult << "esvo"
                                        << "has one camera";
}

void TestCommandLine::export_ofBadInputWritesNothing() {
  QFETCH(QByteArray, result);
  QFETCH(QString, target);
  QFETCH(QString, said);
  QTemporaryDir folder;
  if (!result.isEmpty()) writeFile(folder.filePath("result.yaml"), result);
  const Outcome outcome =
      runProgram({"export", folder.filePath("result.yaml"), "--to", target, "-o", folder.filePath("out")});
  VERIFY_EXIT(outcome, 2);
  QVERIFY2(outcome.reason().contains(said), qPrintable(outcome.errors));
  QVERIFY(!QFileInfo::exists(folder.filePath("out")));
}

void TestCommandLine::export_goesOnWhereOneTargetRefuses() {
  QTemporaryDir folder;
  writeFile(folder.filePath("result.yaml"), kSmallResult);
  const Outcome outcome =
      runProgram({"export", folder.path(), "--to", "esvo,kalibr", "-o", folder.filePath("out")});
  VERIFY_EXIT(outcome, 1);
  QVERIFY2(outcome.reason().contains("esvo: not exported: "), qPrintable(outcome.errors));
  QCOMPARE(filesIn(folder.filePath("out")), QStringList{"kalibr"});
}

void TestCommandLine::export_check_tellsWhatItRead() {
  QTemporaryDir folder;
  writeFile(folder.filePath("result.yaml"), kSmallResult);
  const Outcome outcome = runProgram(
      {"export", folder.path(), "--to", "kalibr,esvo,ros", "--check", "-o", folder.filePath("out")});
  VERIFY_EXIT(outcome, 1);  // a single camera is not a stereo pair: refused, and not checked
  QVERIFY2(outcome.output.contains("kalibr: reads back: 1 camera within 0 px, 1 IMU, poses within "),
           qPrintable(outcome.output));
  QVERIFY(outcome.output.contains("ros: reads back: ") && !outcome.output.contains("esvo: reads back"));
  QVERIFY(outcome.errors.contains("esvo: not exported: ") && !outcome.errors.contains("does not read back"));
}

// The check reads the files on disk, and a program that uses the folder also finds its earlier files.
void TestCommandLine::export_check_findsWhatIsInTheWay() {
  QTemporaryDir folder;
  writeFile(folder.filePath("result.yaml"), kSmallResult);
  QVERIFY(QDir(folder.path()).mkpath("out/ros"));
  writeFile(folder.filePath("out/ros/old.yaml"), "image_width: 346\n");
  const Outcome outcome =
      runProgram({"export", folder.path(), "--to", "ros,kalibr", "--check", "-o", folder.filePath("out")});
  VERIFY_EXIT(outcome, 1);
  QVERIFY2(outcome.reason().contains("ros: does not read back: ") && outcome.reason().contains("old.yaml"),
           qPrintable(outcome.errors));
  QVERIFY(outcome.output.contains("kalibr: reads back: "));
}

// `--check FOLDER` writes nothing and checks the existing files.
void TestCommandLine::export_check_ofEarlierFiles() {
  QTemporaryDir folder;
  writeFile(folder.filePath("result.yaml"), kSmallResult);
  const QString out = folder.filePath("out");
  VERIFY_EXIT(runProgram({"export", folder.path(), "--to", "ros,kalibr", "-o", out}), 0);
  const Outcome all = runProgram({"export", folder.path(), "--check", out});
  VERIFY_EXIT(all, 0);
  QVERIFY2(all.output.contains("kalibr: reads back: ") && all.output.contains("ros: reads back: "),
           qPrintable(all.output));
  const QString camchain = out + "/kalibr/" + filesIn(out + "/kalibr").filter("camchain").value(0);
  writeFile(camchain, QByteArray(readFile(camchain)).replace("intrinsics", "intrinsic"));
  const Outcome broken = runProgram({"export", folder.path(), "--check", out});
  VERIFY_EXIT(broken, 1);
  QVERIFY2(broken.reason().contains("kalibr: does not read back: "), qPrintable(broken.errors));
  VERIFY_EXIT(runProgram({"export", folder.path(), "--to", "ros", "--check", out}), 0);
  for (const QStringList& wrong : {QStringList{"--check", folder.filePath("nowhere")},
                                   {"--check", folder.path()},
                                   {"--check", out, "-o", out},
                                   {"--check"},
                                   {"--to", "ros"}})
    VERIFY_EXIT(runProgram(QStringList{"export", folder.path()} + wrong), 2);
}

void TestCommandLine::export_toAll_namesWhatRefuses() {
  QTemporaryDir folder;
  writeFile(folder.filePath("result.yaml"), kSmallResult);
  const Outcome outcome =
      runProgram({"export", folder.path(), "--to", "all", "--check", "-o", folder.filePath("out")});
  VERIFY_EXIT(outcome, 0);
  QVERIFY2(outcome.output.contains("esvo: not exported: "), qPrintable(outcome.output));
  const QStringList written = filesIn(folder.filePath("out"));
  QVERIFY(written.size() > 8 && !written.contains("esvo"));
  for (const QString& target : written)
    QVERIFY2(outcome.output.contains(target + ": reads back: "), qPrintable(target));
}

void TestCommandLine::import_writesASession() {
  QTemporaryDir folder;
  writeFile(folder.filePath("result.yaml"), kSmallResult);
  VERIFY_EXIT(runProgram({"export", folder.path(), "--to", "kalibr", "-o", folder.path()}), 0);
  writeFile(
      folder.filePath("target.yaml"),
      "target_type: circlegrid\ntargetCols: 4\ntargetRows: 11\nspacingMeters: 0.05\nasymmetricGrid: true\n");
  writeFile(folder.filePath("recording.bag"), "x");
  const QStringList files{folder.filePath("kalibr/imu.yaml"), folder.filePath("target.yaml"),
                          folder.filePath("kalibr/camchain-imucam.yaml")};
  const QStringList command =
      QStringList{"import"} + files + QStringList{"-o", folder.filePath("session.yaml")};
  const Outcome without = runProgram(command);
  VERIFY_EXIT(without, 2);
  QVERIFY2(without.reason().contains("--recording"), qPrintable(without.errors));
  QVERIFY(!QFileInfo::exists(folder.filePath("session.yaml")));
  VERIFY_EXIT(runProgram(command + QStringList{"--recording", folder.filePath("recording.bag")}), 0);
  QVERIFY(readFile(folder.filePath("session.yaml")).contains("recording: recording.bag"));
  const Outcome again = runProgram(command + QStringList{"--recording", folder.filePath("recording.bag")});
  VERIFY_EXIT(again, 2);
  QVERIFY2(again.reason().contains("exists already"), qPrintable(again.errors));
}

void TestCommandLine::init_writesTheSessionThatTheRecordingSuggests_data() {
  QTest::addColumn<QString>("recording");
  QTest::addColumn<QString>("stream");
  QTest::newRow("bag") << simulated("short_bag") + "/recording.bag"
                       << "/davis_left/events";
  QTest::newRow("folder of text files") << simulated("short") << "events";
}

void TestCommandLine::init_writesTheSessionThatTheRecordingSuggests() {
  QFETCH(QString, recording);
  QFETCH(QString, stream);
  QTemporaryDir folder;
  const QString file = folder.filePath("session.yaml");
  const QStringList command = {"init", recording, "-o", file};
  const Outcome outcome = runProgram(command);
  VERIFY_EXIT(outcome, 0);
  QVERIFY2(outcome.output.startsWith(file + "\nboard: complete its entry"), qPrintable(outcome.output));
  const QString written = QString::fromUtf8(readFile(file));
  QVERIFY2(written.contains("stream: " + stream) && written.contains("# board:"), qPrintable(written));
  QVERIFY2(outcome.output.endsWith("\nThen run: evical calibrate " + file + " -o result\n"),
           qPrintable(outcome.output));

  // Not before the board is filled in; and entries that were filled in are not overwritten.
  const Outcome unfilled = runProgram({"calibrate", file, "-o", folder.filePath("result")});
  VERIFY_EXIT(unfilled, 2);
  QVERIFY2(unfilled.reason().contains("board"), qPrintable(unfilled.errors));
  const Outcome again = runProgram(command);
  VERIFY_EXIT(again, 2);
  QVERIFY2(again.reason().contains("exists already"), qPrintable(again.errors));
  QCOMPARE(QString::fromUtf8(readFile(file)), written);
}

void TestCommandLine::init_takesSensorsOfSeveralRecordings() {
  QTemporaryDir folder;
  for (const QString name : {"events.txt", "imu.txt"})
    QFile::link(simulated("short") + "/" + name, folder.filePath(name));
  const QString file = folder.filePath("session.yaml");
  const Outcome outcome =
      runProgram({"init", folder.filePath("events.txt"), folder.filePath("imu.txt"), "-o", file, "--quiet"});
  VERIFY_EXIT(outcome, 0);
  QCOMPARE(outcome.output, file + "\n");
  QCOMPARE(outcome.errors, QString());
  const QByteArray written = readFile(file);
  QVERIFY2(written.contains("imus:"), written.constData());
  QVERIFY2(written.contains("    recording: "), written.constData());
}

void TestCommandLine::inspect_writesHugeMeansBriefly() {
  QTemporaryDir folder;
  writeFile(folder.filePath("imu.csv"), "t_s,ax,ay,az,gx,gy,gz\n0,1e300,2,9.8,1e300,-2e300,3\n");
  const Outcome outcome = runProgram({"inspect", folder.filePath("imu.csv")});
  VERIFY_EXIT(outcome, 0);
  QVERIFY2(outcome.output.contains("mean angular rate      1e+300  -2e+300  3.00000 "),
           qPrintable(outcome.output));
  QVERIFY2(outcome.output.size() < 1000, qPrintable(outcome.output));
}

void TestCommandLine::detect_writesDetectionsOnly() {
  QTemporaryDir folder;
  const Outcome outcome = runProgram({"detect", session(), "-o", folder.filePath("seen")});
  VERIFY_EXIT(outcome, 0);
  const QStringList expected = {"detections.csv", "detections.yaml", "log.txt", "windows.csv"};
  QCOMPARE(filesIn(folder.filePath("seen")), expected);
  QVERIFY(readFile(folder.filePath("seen/detections.csv")).count('\n') > 1000);
}

void TestCommandLine::detect_ofSeveralRecordingsWritesAFolderEach() {
  QTemporaryDir folder;
  const QString recording = simulated("blinking") + "/recording.bag";
  QString text = QString::fromUtf8(readFile(session("blinking")));
  const qsizetype begin = text.indexOf("recording:");
  text.replace(begin, text.indexOf('\n', begin) - begin, QString("recording: [%1, %1]").arg(recording));
  writeFile(folder.filePath("session.yaml"), text.toUtf8());
  const Outcome outcome =
      runProgram({"detect", folder.filePath("session.yaml"), "-o", folder.filePath("seen")});
  VERIFY_EXIT(outcome, 0);
  QCOMPARE(filesIn(folder.filePath("seen")), (QStringList{"recording", "recording_2"}));
  const QByteArray seen = readFile(folder.filePath("seen/recording/detections.csv"));
  QVERIFY(seen.count('\n') > 54);
  QCOMPARE(readFile(folder.filePath("seen/recording_2/detections.csv")), seen);
}

void TestCommandLine::calibrate_startsFromDetections() {
  QTemporaryDir folder;
  const QString whole = folder.filePath("whole"), seen = folder.filePath("seen");
  VERIFY_EXIT(runProgram({"calibrate", session(), "-o", whole}), 0);
  VERIFY_EXIT(runProgram({"detect", session(), "-o", seen}), 0);
  const auto path = [](const QString& file) { return std::filesystem::path(file.toStdString()); };
  for (const QString& from : {whole, seen}) {
    const QString again = from + "_again";
    VERIFY_EXIT(runProgram({"calibrate", session(), "--detections", from, "-o", again}), 0);
    QCOMPARE(filesIn(again), kResultFiles);
    for (const char* file : {"/detections.csv", "/windows.csv", "/detections.yaml"})
      QCOMPARE(readFile(again + file), readFile(whole + file));
    for (const auto& each : evical::compareWithTruth(evical::readResultYaml(path(again + "/result.yaml")),
                                                     evical::readResultYaml(path(whole + "/result.yaml")))
                                .quantities)
      QVERIFY2(std::abs(each.difference) < 1e-6, each.name.c_str());
  }
  QFile::remove(seen + "/detections.yaml");
  const Outcome refused =
      runProgram({"calibrate", session(), "--detections", seen, "-o", folder.filePath("none")});
  VERIFY_EXIT(refused, 2);
  QVERIFY2(refused.reason().contains("detections.yaml"), qPrintable(refused.errors));
  QVERIFY(!QFileInfo::exists(folder.filePath("none")));
}

void TestCommandLine::quiet_saysNothingButTheResult() {
  QTemporaryDir folder;
  const Outcome outcome = runProgram({"calibrate", session(), "-o", folder.filePath("result"), "--quiet"});
  VERIFY_EXIT(outcome, 0);
  QCOMPARE(outcome.errors, QString());
}

void TestCommandLine::interruption_leavesNothingHalfWritten_data() {
  QTest::addColumn<int>("signal");
  QTest::addColumn<QString>("stage");
  QTest::newRow("Ctrl-C while detecting") << SIGINT << "detect";
  QTest::newRow("Ctrl-C while optimising") << SIGINT << "optimise";
  QTest::newRow("terminated") << SIGTERM << "detect";
}

void TestCommandLine::interruption_leavesNothingHalfWritten() {
  QFETCH(int, signal);
  QFETCH(QString, stage);
  QTemporaryDir folder;
  const QString result = folder.filePath("result");
  const Outcome outcome = interruptProgram({"calibrate", session("short_bag"), "-o", result}, signal,
                                           [&](const QString& errors) { return errors.contains(stage); });
  VERIFY_EXIT(outcome, 1);
  QCOMPARE(outcome.reason(), QStringLiteral("cancelled"));
  QVERIFY(!QDir(result).exists());
}

void TestCommandLine::interruption_ofASimulationLeavesNothing() {
  QTemporaryDir folder;
  const Outcome outcome = interruptProgram(
      {"simulate", inSources("config/scenarios/davis346.yaml"), "-o", folder.filePath("demo")}, SIGINT,
      [](const QString& errors) { return errors.contains("simulate"); });
  VERIFY_EXIT(outcome, 1);
  QCOMPARE(outcome.reason(), QStringLiteral("cancelled"));
  QVERIFY2(filesIn(folder.path()).isEmpty(), qPrintable(filesIn(folder.filePath("demo")).join(' ')));
}

// Permissions do not restrict root, but nobody can create a folder below a file.
void TestCommandLine::folder_thatCannotBeMadeIsRefused() {
  QTemporaryDir folder;
  writeFile(folder.filePath("file"), "not a folder");
  for (const QStringList& arguments : {QStringList{"calibrate", session()}, QStringList{"detect", session()},
                                       QStringList{"simulate", inSources("tests/system/short.yaml")}}) {
    const Outcome outcome = runProgram(arguments + QStringList{"-o", folder.filePath("file/result")});
    VERIFY_EXIT(outcome, 2);
    QVERIFY2(outcome.reason().contains("file/result"), qPrintable(outcome.errors));
  }
}

void TestCommandLine::diskFull_leavesTheOldResult() {
  QTemporaryDir folder;
  const QString result = folder.filePath("result");
  QDir().mkpath(result);
  writeFile(result + "/result.yaml", "evical_result: 1\nstatus: ok\n");
  writeFile(result + "/trajectory.csv", "time_s\n");
  const Outcome outcome = runProgramWithFileLimit({"calibrate", session(), "-o", result}, 16);
  VERIFY_EXIT(outcome, 1);
  QVERIFY2(outcome.reason().contains("cannot be written"), qPrintable(outcome.reason()));
  QVERIFY2(outcome.errors.contains("result.yaml exists: this run replaces it"), qPrintable(outcome.errors));
  QCOMPARE(readFile(result + "/result.yaml"), QByteArray("evical_result: 1\nstatus: ok\n"));
  const QStringList untouched = {"result.yaml", "trajectory.csv"};
  QCOMPARE(filesIn(result), untouched);

  const Outcome simulation = runProgramWithFileLimit(
      {"simulate", inSources("tests/system/short.yaml"), "-o", folder.filePath("demo")}, 100);
  VERIFY_EXIT(simulation, 1);
  QVERIFY(filesIn(folder.filePath("demo")).isEmpty());
}

void TestCommandLine::failure_isInTheResultOfAFolderThatWasThere() {
  QTemporaryDir folder;
  const QString result = folder.filePath("result");
  QDir().mkpath(result);
  const Outcome outcome =
      runProgram({"calibrate", session(), "-o", result, "--set", "initialisation.min_views=100000"});
  VERIFY_EXIT(outcome, 1);
  const QByteArray yaml = readFile(result + "/result.yaml");
  QVERIFY(yaml.contains("status: failed"));
  QVERIFY2(yaml.contains("views"), yaml.constData());
}

EVICAL_TEST(TestCommandLine)
#include "tst_command_line.moc"
