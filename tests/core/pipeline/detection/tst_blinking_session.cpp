// Settings of a session for a blinking board, and for several recordings of it.
#include "core/pipeline/detection/camera_views.h"
#include "core/pipeline/session/session.h"
#include "tests/core/pipeline/session/refused_session.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <fstream>

using namespace evical;

namespace {

const char* const kGood = R"(evical_session: 1
recording: [first.raw, second.raw]
board: {type: checkerboard, rows: 6, cols: 8, spacing_m: 0.03, blinking: true}
cameras:
  left: {stream: events}
imus:
  imu: {stream: imu, accelerometer_noise_density: 1.86e-3, gyroscope_noise_density: 1.87e-4}
)";

}  // namespace

class TestBlinkingSession : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() {
    for (const char* name : {"first.raw", "second.raw"}) std::ofstream(folder() / name) << "x";
  }

  // With IMUs, and a board that looks the same upside down, which is for its cameras' intrinsics only.
  void session_isReadAndWritten() {
    const Session session = sessionWith("", "");
    QVERIFY(session.board_blinks);
    QCOMPARE(session.recording.filename().string(), std::string("first.raw"));
    QCOMPARE(static_cast<int>(session.more_recordings.size()), 1);
    writeSession(session, folder() / "again.yaml");
    const Session again = readSession(folder() / "again.yaml");
    QVERIFY(again.board_blinks && again.board == session.board);
    QVERIFY(again.more_recordings == session.more_recordings);
  }

  void boardThatIsPrinted_needsNoWord() {
    const Session session =
        sessionWith("6, cols: 8, spacing_m: 0.03, blinking: true", "6, cols: 9, spacing_m: 0.03",
                    "[first.raw, second.raw]", "first.raw");
    QVERIFY(!session.board_blinks);
    QVERIFY(sessionYaml(session, folder()).find("blinking") == std::string::npos);
  }

  void mistake_isRefusedWithItsPlace_data() {
    QTest::addColumn<QString>("from");
    QTest::addColumn<QString>("to");
    QTest::addColumn<QStringList>("said");
    QTest::newRow("list of a printed board")
        << "cols: 8, spacing_m: 0.03, blinking: true"
        << "cols: 9, spacing_m: 0.03" << QStringList{"recording", "is a list", "blinking: true"};
    QTest::newRow("no such recording") << "second.raw"
                                       << "third.raw" << QStringList{"third.raw", "does not exist"};
    QTest::newRow("empty list") << "[first.raw, second.raw]"
                                << "[]" << QStringList{"recording", "is empty"};
    QTest::newRow("time range of several")
        << "cameras:"
        << "time_range_s: [0, 1]\ncameras:" << QStringList{"time_range_s", "ambiguous with several"};
    QTest::newRow("another recording in addition")
        << "stream: events"
        << "stream: events, recording: first.raw"
        << QStringList{"cameras.left.recording", "in addition to the list"};
    QTest::newRow("neither true nor false") << "blinking: true"
                                            << "blinking: 30" << QStringList{"board.blinking", "30"};
  }
  void mistake_isRefusedWithItsPlace() {
    QFETCH(QString, from);
    QFETCH(QString, to);
    QFETCH(QStringList, said);
    try {
      sessionWith(from, to);
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      test::verifyRefusal(error, said);
    }
  }

  // A run may start from detections whose recording has been moved.
  void recordingThatIsGone_tellsNothing() {
    Session session;
    session.recording = folder() / "gone.bag";
    session.cameras.push_back({"left", "/left/events", {64, 48}, {}});
    session.reference = "left";
    QVERIFY(!unexpectedBlink(session, 0));
  }

 private:
  std::filesystem::path folder() const { return folder_.path().toStdString(); }
  Session sessionWith(const QString& from, const QString& to, const QString& also_from = {},
                      const QString& also_to = {}) const {
    QString text = kGood;
    if (!from.isEmpty()) text.replace(from, to);
    if (!also_from.isEmpty()) text.replace(also_from, also_to);
    std::ofstream(folder() / "session.yaml") << text.toStdString();
    return readSession(folder() / "session.yaml");
  }

  QTemporaryDir folder_;
};

EVICAL_TEST(TestBlinkingSession)
#include "tst_blinking_session.moc"
