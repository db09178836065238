// Sessions and options that are wrong.
#include "tests/system/session_case.h"

using namespace evical::test;

class TestBadSession : public QObject {
  Q_OBJECT

 private slots:
  void session_thatIsMissing_isNamed();
  void session_thatIsNoYaml_isRefusedWithTheLine();
  void session_thatIsAFolder_isRefused();
  void session_withAMistake_isRefusedAtItsPlace_data();
  void session_withAMistake_isRefusedAtItsPlace();
  void option_thatIsUnknownOrOutOfRange_isRefused();
  void options_thatExcludeEachOther_areRefused_data();
  void options_thatExcludeEachOther_areRefused();
  void options_thatExcludeEachOtherOnTheWay_areTaken();
};

void TestBadSession::session_thatIsMissing_isNamed() {
  QTemporaryDir folder;
  const Outcome outcome =
      runProgram({"calibrate", folder.filePath("nowhere.yaml"), "-o", folder.filePath("result")});
  VERIFY_OUTCOME(outcome, 2);
  VERIFY_SAYS(outcome, "nowhere.yaml.*does not exist");
  QVERIFY(filesIn(folder.path()).isEmpty());
}

void TestBadSession::session_thatIsNoYaml_isRefusedWithTheLine() {
  SessionCase test;
  writeFile(test.session(), "evical_session: 1\nboard: {rows: 3\ncameras: ]\n");
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "session.yaml.*line [23].*YAML");
}

void TestBadSession::session_thatIsAFolder_isRefused() {
  SessionCase test;
  const Outcome outcome = runProgram({"calibrate", test.path(""), "-o", test.result()});
  VERIFY_REJECTED(test, outcome, "folder");
}

void TestBadSession::session_withAMistake_isRefusedAtItsPlace_data() {
  QTest::addColumn<QString>("from");
  QTest::addColumn<QString>("to");
  QTest::addColumn<QString>("says");
  QTest::newRow("unknown key") << "recording:"
                               << "recordng:"
                               << "recordng.*[Dd]id you mean 'recording'";
  QTest::newRow("unknown board key") << "  rows:"
                                     << "  row:"
                                     << "board.row .*[Dd]id you mean 'rows'";
  QTest::newRow("unknown camera key") << "    stream: events.txt"
                                      << "    streem: events.txt"
                                      << "streem.*[Dd]id you mean 'stream'";
  QTest::newRow("wrong type") << "rows: 11"
                              << "rows: eleven"
                              << "rows.*eleven.*whole number";
  QTest::newRow("out of range") << "rows: 11"
                                << "rows: 0"
                                << "rows";
  QTest::newRow("circles that touch") << "radius_m: 0.02"
                                      << "radius_m: 0.2"
                                      << "radius|touch|overlap";
  QTest::newRow("symmetric board") << "asymmetric_circles"
                                   << "symmetric_circles"
                                   << "180|half turn|turned";
  QTest::newRow("even number of rows") << "rows: 11"
                                       << "rows: 10"
                                       << "180|half turn|turned";
  QTest::newRow("unknown unit") << "acceleration_unit: m/s^2"
                                << "acceleration_unit: ft/s^2"
                                << "acceleration_unit.*ft";
  QTest::newRow("unknown reference") << "reference: left_imu"
                                     << "reference: right_imu"
                                     << "reference.*right_imu";
  QTest::newRow("no version") << "evical_session: 1"
                              << "evical_session: 99"
                              << "evical_session";
}

void TestBadSession::session_withAMistake_isRefusedAtItsPlace() {
  QFETCH(QString, from);
  QFETCH(QString, to);
  QFETCH(QString, says);
  SessionCase test;
  test.change(from, to);
  const Outcome outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, says);
  VERIFY_SAYS(outcome, "session.yaml");
}

void TestBadSession::option_thatIsUnknownOrOutOfRange_isRefused() {
  SessionCase test;
  Outcome outcome = test.calibrate({"--set", "detection.methd=ring_vote"});
  VERIFY_REJECTED(test, outcome, "detection.methd.*'(detection.)?method'");
  outcome = test.calibrate({"--set", "detection.max_window_s=7"});
  VERIFY_REJECTED(test, outcome, "detection.max_window_s.*7 s.*0.2 s");
  test.append("options: {detection.method: guess}\n");
  outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, "guess.*ring_vote");
}

void TestBadSession::options_thatExcludeEachOther_areRefused_data() {
  QTest::addColumn<QStringList>("settings");
  QTest::addColumn<QString>("says");
  QTest::newRow("windows") << QStringList{"detection.min_window_s=0.1", "detection.max_window_s=0.005"}
                           << "detection.min_window_s \\(0.1 s\\) is above detection.max_window_s "
                              "\\(0.005 s\\). Set .* at most 0.005 s, or .* at least 0.1 s";
  QTest::newRow("polarity cosines") << QStringList{"tuning.tracking.min_polarity_cosine=0.9",
                                                   "tuning.tracking.full_polarity_cosine=0.1"}
                                    << "tuning.tracking.min_polarity_cosine \\(0.9\\) is above "
                                       "tuning.tracking.full_polarity_cosine \\(0.1\\)";
  QTest::newRow("one against a default") << QStringList{"detection.min_window_s=0.1"}
                                         << "detection.min_window_s \\(0.1 s\\) is above "
                                            "detection.max_window_s \\(0.05 s\\)";
}

void TestBadSession::options_thatExcludeEachOther_areRefused() {
  QFETCH(QStringList, settings);
  QFETCH(QString, says);
  SessionCase test;
  QStringList arguments;
  for (const QString& setting : settings) arguments << "--set" << setting;
  Outcome outcome = test.calibrate(arguments);
  VERIFY_REJECTED(test, outcome, says);
  QString options = "options:\n";
  for (const QString& setting : settings) options += "  " + QString(setting).replace("=", ": ") + "\n";
  test.append(options);
  outcome = test.calibrate();
  VERIFY_REJECTED(test, outcome, says);
  VERIFY_SAYS(outcome, "session.yaml: options \\(line \\d+\\)");
}

void TestBadSession::options_thatExcludeEachOtherOnTheWay_areTaken() {
  SessionCase test;
  const Outcome outcome =
      test.calibrate({"--set", "tuning.bursts.min_gap_s=0.1", "--set", "tuning.bursts.max_gap_s=0.05",
                      "--set", "tuning.bursts.min_gap_s=0.004", "--set", "tuning.bursts.max_gap_s=0.15"});
  VERIFY_OUTCOME(outcome, 0);
}

EVICAL_TEST(TestBadSession)
#include "tst_bad_session.moc"
