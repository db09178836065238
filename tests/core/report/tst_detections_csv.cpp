// Detections as tables: unchanged after writing and reading; damaged tables are refused with the line.
#include "core/base/error.h"
#include "core/report/csv_text.h"
#include "core/report/detections_csv.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <algorithm>
#include <filesystem>
#include <fstream>

using namespace evical;

namespace {

CircleObservation circleAt(int index, double time_s) {
  CircleObservation circle;
  circle.circle = index;
  circle.time_s = time_s + 1e-9 / 3.0;
  circle.centre_px = {100.0 / 3.0, 1e-7 * index + 20.0};
  circle.covariance_px2 << 0.01 / 3.0, -1e-4 / 7.0, -1e-4 / 7.0, 0.02 / 3.0;
  circle.velocity_px_s = {-200.0 / 3.0, 0.1};
  circle.edge_localisation_bias_effect = {-1.0 / 3.0, 1.0 / 7.0};
  circle.semi_axes_px = {10.0 / 3.0, 3.0};
  circle.angle_rad = -1.0 / 3.0;
  circle.events = 123;
  circle.residual_rms_px = 0.1 / 3.0;
  circle.rows_below_middle = -17.0 / 3.0;
  circle.longer_exposed_s = 1e-3 / 7.0;
  return circle;
}

std::vector<BoardObservations> sampleForDetectionsCsv() {
  std::vector<BoardObservations> cameras(2);
  cameras[0].camera = "left, \"upper\"";
  cameras[0].views = {{0.1 / 3.0, ViewKind::Complete, {circleAt(0, 0.0), circleAt(1, 0.0)}},
                      {0.2, ViewKind::Partial, {circleAt(1, 0.2)}}};
  cameras[0].windows = {{0.1 / 3.0, 0.01 / 3.0, WindowOutcome::Complete, 1000, 5, 2, true},
                        {0.2, 0.01, WindowOutcome::Partial, 900, 4, 1, false}};
  cameras[1].camera = "blind";
  cameras[1].windows = {{0.3, 0.0, WindowOutcome::Unreadable, 0, 0, 0, false}};
  return cameras;
}

bool same(const CircleObservation& a, const CircleObservation& b) {
  return a.circle == b.circle && a.time_s == b.time_s && a.centre_px == b.centre_px &&
         a.covariance_px2 == b.covariance_px2 && a.velocity_px_s == b.velocity_px_s &&
         a.edge_localisation_bias_effect == b.edge_localisation_bias_effect &&
         a.semi_axes_px == b.semi_axes_px && a.angle_rad == b.angle_rad && a.events == b.events &&
         a.residual_rms_px == b.residual_rms_px && a.rows_below_middle == b.rows_below_middle &&
         a.longer_exposed_s == b.longer_exposed_s;
}

bool same(const WindowReport& a, const WindowReport& b) {
  return a.time_s == b.time_s && a.half_width_s == b.half_width_s && a.outcome == b.outcome &&
         a.events == b.events && a.candidates == b.candidates && a.circles == b.circles &&
         a.tracked == b.tracked;
}

}  // namespace

class TestDetectionsCsv : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

  std::filesystem::path folder() const { return scratch_.path().toStdString(); }
  void write(const std::string& detections, const std::string& windows) const {
    std::ofstream(folder() / "detections.csv") << detections;
    std::ofstream(folder() / "windows.csv") << windows;
  }

 private slots:
  void detections_readBackToTheLastBit() {
    const std::vector<BoardObservations> written = sampleForDetectionsCsv();
    write(detectionsCsv(written), windowsCsv(written));
    const std::vector<BoardObservations> read = readDetections(folder(), 2);
    QCOMPARE(read.size(), written.size());
    for (std::size_t k = 0; k < read.size(); ++k) {
      QCOMPARE(read[k].camera, written[k].camera);
      QVERIFY(std::equal(read[k].windows.begin(), read[k].windows.end(), written[k].windows.begin(),
                         written[k].windows.end(), [](const auto& a, const auto& b) { return same(a, b); }));
      QCOMPARE(read[k].views.size(), written[k].views.size());
      for (std::size_t v = 0; v < read[k].views.size(); ++v) {
        const BoardView &a = read[k].views[v], &b = written[k].views[v];
        QVERIFY(a.time_s == b.time_s && a.kind == b.kind);
        QVERIFY(std::equal(a.circles.begin(), a.circles.end(), b.circles.begin(), b.circles.end(),
                           [](const auto& x, const auto& y) { return same(x, y); }));
      }
    }
  }

  // Spreadsheets would calculate them.
  void cells_areNoFormulas_data() {
    QTest::addColumn<QString>("cell");
    for (const char* const text : {"=1+1", "+cmd|' /C calc'!A0", "-1+1", "@SUM(A1)", "'=1",
                                   "\xef\xbc\x9d"
                                   "1+1",
                                   "=\"a\",b", "-", "=a;b"})
      QTest::newRow(text) << "'" + QString(text);
    for (const char* const text : {"-1.5", "+", "left", "a=b", "1e-5", "-2e3"})
      QTest::newRow(text) << (QString(text) == "+" ? "'+" : text);
    QTest::newRow("a\x1b[2J") << "a\\x1b[2J";
    QTest::newRow("a\r\n=1") << "a  =1";
  }
  void cells_areNoFormulas() {
    QFETCH(QString, cell);
    const std::string text = QTest::currentDataTag();
    const QString word = QString::fromStdString(csvWord(text)),
                  quoted = QString::fromStdString(quotedCsv(text));
    const auto plain = [](QString csv) {
      return csv.startsWith('"') ? csv.mid(1, csv.size() - 2).replace("\"\"", "\"") : csv;
    };
    QCOMPARE(plain(word), cell);
    QCOMPARE(plain(quoted), cell);
    QCOMPARE(QString::fromStdString(fromCsv(cell.toStdString())), cell.startsWith('\'') ? cell.mid(1) : cell);
  }

  void nameThatBeginsAFormula_readsBack() {
    std::vector<BoardObservations> written = sampleForDetectionsCsv();
    written.front().camera = "=cmd|'/C calc'!A0";
    write(detectionsCsv(written), windowsCsv(written));
    QCOMPARE(readDetections(folder(), 2).front().camera, written.front().camera);
  }

  void damagedTables_areRefused_data() {
    QTest::addColumn<QByteArray>("what");
    QTest::addColumn<QByteArray>("by");
    QTest::addColumn<QByteArray>("said");
    QTest::newRow("column missing") << QByteArray("edge_localisation_bias_effect_x") << QByteArray("x")
                                    << QByteArray("has no column edge_localisation_bias_effect_x");
    QTest::newRow("a number missing")
        << QByteArray(",-5.666666666666667,") << QByteArray(",") << QByteArray("columns");
    QTest::newRow("no number") << QByteArray("33.33") << QByteArray("a33.33") << QByteArray("(line 2): x_px");
    QTest::newRow("not finite") << QByteArray("33.333333333333336") << QByteArray("nan")
                                << QByteArray("(line 2): x_px");
    QTest::newRow("another board's circle") << QByteArray("complete,1,") << QByteArray("complete,2,")
                                            << QByteArray("(line 3): circle '2' is not in 0..1");
    QTest::newRow("no covariance") << QByteArray("0.006666666666666667")
                                   << QByteArray("-0.006666666666666667")
                                   << QByteArray("(line 2): var_x_px2");
    QTest::newRow("backwards") << QByteArray(",0.2,partial") << QByteArray(",0.01,partial")
                               << QByteArray("(line 4): window_time_s '0.01' decreases");
    QTest::newRow("unknown kind") << QByteArray("partial") << QByteArray("whole")
                                  << QByteArray("(line 4): grid 'whole' is unknown");
    QTest::newRow("quotes left open")
        << QByteArray("upper\"\"\"") << QByteArray("upper\"\"") << QByteArray("columns");
    QTest::newRow("empty") << QByteArray() << QByteArray() << QByteArray("is empty");
  }

  void damagedTables_areRefused() {
    QFETCH(const QByteArray, what);
    QFETCH(const QByteArray, by);
    QFETCH(const QByteArray, said);
    QByteArray text =
        what.isEmpty() ? QByteArray() : QByteArray::fromStdString(detectionsCsv(sampleForDetectionsCsv()));
    QVERIFY(what.isEmpty() || text.contains(what));
    if (!what.isEmpty()) text.replace(text.indexOf(what), what.size(), by);
    write(text.toStdString(), windowsCsv(sampleForDetectionsCsv()));
    try {
      readDetections(folder(), 2);
      QFAIL("read");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY2(QByteArray(error.what()).contains(said), error.what());
    }
  }

  void missingTables_areSaid() {
    write(detectionsCsv(sampleForDetectionsCsv()), windowsCsv(sampleForDetectionsCsv()));
    std::filesystem::remove(folder() / "windows.csv");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, readDetections(folder(), 2));
  }
};

EVICAL_TEST(TestDetectionsCsv)
#include "tst_detections_csv.moc"
