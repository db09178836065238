// Recordings that do not show the session's board, or not enough of it.
#include "tests/system/session_case.h"

using namespace evical::test;

class TestBadView : public QObject {
  Q_OBJECT

 private slots:
  void board_thatIsNeverSeen_saysWhereWindowsWereLost();
  void board_ofAnotherSize_isNamed_data();
  void board_ofAnotherSize_isNamed();
  void boardSpacing_tenPercentOff_isDoubtful_data();
  void boardSpacing_tenPercentOff_isDoubtful();
  void recording_tooShort_fails();
  void recording_withoutMotion_fails();
};

void TestBadView::board_thatIsNeverSeen_saysWhereWindowsWereLost() {
  SessionCase test;
  test.change("circles: dark", "circles: bright");
  const Outcome outcome = test.calibrate();
  VERIFY_FAILED(test, outcome, "never (found|seen).*\\d+ windows.*\\(.*(bright|circles)");
}

void TestBadView::board_ofAnotherSize_isNamed_data() {
  QTest::addColumn<int>("rows");
  QTest::addColumn<int>("cols");
  QTest::addColumn<QString>("says");
  QTest::newRow("fewer rows") << 9 << 4
                              << "left: .*larger than 9 x 4: .*beyond its first or last row in \\d+ % of";
  QTest::newRow("fewer columns") << 11 << 3 << "larger than 11 x 3: .*beyond its first or last column";
  QTest::newRow("fewer of both") << 7 << 3 << "larger than 7 x 3: .*first or last row.*first or last column";
  QTest::newRow("more rows") << 13 << 4 << "smaller than 13 x 4: .*rows? w.* never seen in \\d+ views";
  QTest::newRow("more columns") << 11 << 5 << "smaller than 11 x 5: .*column";
  QTest::newRow("more of both")
      << 13 << 7 << "smaller than 13 x 7: .*columns? w.* never seen in \\d+ views|no 13 x 7 board";
}

void TestBadView::board_ofAnotherSize_isNamed() {
  QFETCH(int, rows);
  QFETCH(int, cols);
  QFETCH(QString, says);
  SessionCase test;
  test.change("rows: 11", QString("rows: %1").arg(rows));
  test.change("cols: 4", QString("cols: %1").arg(cols));
  const Outcome outcome = test.calibrate();
  VERIFY_FAILED(test, outcome, says);
  VERIFY_SAYS(outcome, "[Cc]heck rows(,| and) columns .*in the session");
}

void TestBadView::boardSpacing_tenPercentOff_isDoubtful_data() {
  QTest::addColumn<QString>("spacing_m");
  QTest::addColumn<QString>("says");
  QTest::newRow("right") << "0.05" << QString();
  QTest::newRow("too small") << "0.0455"
                             << "(9|10|11) % larger than specified .spacing 0.0455 m";
  QTest::newRow("too large") << "0.0556"
                             << "(9|10|11) % smaller than specified .spacing 0.0556 m";
}

void TestBadView::boardSpacing_tenPercentOff_isDoubtful() {
  QFETCH(QString, spacing_m);
  QFETCH(QString, says);
  SessionCase test;
  test.change("spacing_m: 0.05", "spacing_m: " + spacing_m);
  test.change("radius_m: 0.02", QString("radius_m: %1").arg(0.4 * spacing_m.toDouble()));
  const Outcome outcome = test.calibrate();
  VERIFY_OUTCOME(outcome, 0);
  const QString result = QString::fromUtf8(readFile(test.result() + "/result.yaml"));
  const bool warned =
      outcome.errors.contains(QRegularExpression("warning: .*than specified .spacing .*measure it"));
  QVERIFY2(warned == !says.isEmpty(), qPrintable(outcome.errors));
  if (says.isEmpty()) return;
  QVERIFY2(result.contains("status: doubtful"), qPrintable(result.left(400)));
  QVERIFY2(result.contains(QRegularExpression("reason: .*" + says)), qPrintable(result.left(400)));
}

void TestBadView::recording_tooShort_fails() {
  SessionCase test;
  test.append("time_range_s: [0, 0.6]\n");
  const Outcome outcome = test.calibrate();
  VERIFY_FAILED(test, outcome, "too short: 0\\.\\d+ s");
}

void TestBadView::recording_withoutMotion_fails() {
  SessionCase test("still");
  const Outcome outcome = test.calibrate();
  VERIFY_FAILED(test, outcome, "mov|motion");
}

EVICAL_TEST(TestBadView)
#include "tst_bad_view.moc"
