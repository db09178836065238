// SPDX-License-Identifier: GPL-3.0-or-later
// A recording that another program is still writing: its card is updated, and detects the end.
#include "core/pipeline/simulate/simulation.h"
#include "core/synthetic/event_simulator.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/file_content.h"
#include "tests/support/packed_events.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/window_fixture.h"
#include "ui/detection/detection_screen.h"
#include "ui/detection/timeline.h"
#include "ui/jobs/growing_recording.h"
#include "ui/screens/recording/check_card.h"
#include "ui/screens/recording/recording_screen.h"
#include "ui/screens/verdict_labels.h"
#include "ui/window/session_files.h"

#include <QCheckBox>
#include <QFile>
#include <QLabel>

using namespace evical;
using namespace evical::ui;
using namespace evical::ui::test;

namespace {

// Writes like a recorder: increasing parts of the bytes, in pieces that end anywhere.
class Recorder : public QObject {
 public:
  Recorder(const QString& path, QByteArray bytes) : file_(path), bytes_(std::move(bytes)) {
    opened_ = file_.open(QIODevice::WriteOnly);
    timer_.setInterval(500);
    connect(&timer_, &QTimer::timeout, this, [this] { write(0.05); });
  }
  void write(double share) {
    const auto piece = static_cast<qsizetype>(share * static_cast<double>(bytes_.size()));
    const QByteArray next = bytes_.mid(written_, piece);
    opened_ = opened_ && file_.write(next) == next.size() && file_.flush();
    written_ += next.size();
    if (written_ == bytes_.size()) timer_.stop();
  }
  void goOn() { timer_.start(); }
  bool isDone() const { return opened_ && written_ == bytes_.size(); }

 private:
  QFile file_;
  QByteArray bytes_;
  qsizetype written_ = 0;
  bool opened_ = false;
  QTimer timer_;
};

struct GrowingFixture : WindowFixture {
  RecordingCheckJob& check = window.workbench().check;
  GrowingRecording& growing = window.workbench().growing;
  QSignalSpy checked{&check, &RecordingCheckJob::checkedAnew}, ended{&growing, &GrowingRecording::endReached};

  GrowingFixture() { check.setAutomatic(true); }
  CheckCard* card() { return child<RecordingScreen>()->checkCard(); }
  QCheckBox* follow() { return child<QCheckBox>("follow_recording"); }
  static std::shared_ptr<const CheckedRecording> look(const QSignalSpy& looks, qsizetype index) {
    return looks.at(index).at(0).value<std::shared_ptr<const CheckedRecording>>();
  }
};

double duration_s(const RecordingAssessment& assessment) {
  return QString::fromStdString(assessment.all.at(0).measured).section(' ', 0, 0).toDouble();
}

double shareOfImage(const RecordingAssessment& assessment) {
  for (const Assessed& one : assessment.all)
    if (one.thing == AssessedThing::Coverage)
      return QString::fromStdString(one.measured).section(' ', 0, 0).toDouble();
  return 0.0;
}

}  // namespace

class TestGrowingRecording : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

  Scenario scenario() const {
    Scenario read = readScenario(evical::test::scenarioPath("davis346"));
    read.duration_s = 4.0;
    return read;
  }

  // Complete recordings, and sessions for them.
  std::filesystem::path folderOf(const QString& format) const {
    return scratch_.filePath(format).toStdString();
  }
  Session sessionOf(const QString& format) {
    if (format == "bag") return readSession(simulatedSession().toStdString());
    const std::filesystem::path folder = folderOf(format);
    std::filesystem::create_directories(folder);
    if (format == "aedat4") {
      simulate(scenario(), folder, {}, "aedat4");
      Session session = readSession(folder / "session.yaml");
      session.imus[0].acceleration_unit.reset();  // the format states it
      session.imus[0].angular_rate_unit.reset();
      return session;
    }
    Session session = readSession(simulatedSession().toStdString());
    session.recording = folder / "whole.raw";
    session.imus.clear();
    session.cameras[0].stream = "events";
    session.reference = session.cameras[0].name;
    std::vector<Event> events;
    simulateEvents(scenario(), 0,
                   [&](EventSpan packet) { events.insert(events.end(), packet.begin(), packet.end()); });
    const std::int64_t start_ns = events.front().time_ns;
    for (Event& event : events) event.time_ns -= start_ns;
    QFile file(QString::fromStdString(session.recording.string()));
    if (!file.open(QIODevice::WriteOnly)) return {};
    file.write("% evt 3.0\n% geometry 346x260\n% end\n");
    file.write(QByteArray::fromStdString(evical::test::encodeEvt3(events)));
    return session;
  }

 private slots:
  void initTestCase() {
    usePrivateFolders(scratch_);
    simulatedSession();
  }
  void init() { QSettings().clear(); }

  void card_goesAlongWithTheFile_toItsEnd_data() {
    QTest::addColumn<QString>("suffix");
    for (const char* const format : {"bag", "aedat4", "raw"}) QTest::newRow(format) << QString(format);
  }
  void card_goesAlongWithTheFile_toItsEnd() {
    QFETCH(const QString, suffix);
    Session session = sessionOf(suffix);
    const QByteArray whole = evical::test::fileContent(session.recording);
    QVERIFY(whole.size() > 100000);
    const QString path = scratch_.filePath("growing." + suffix);
    Recorder recorder(path, whole);
    recorder.write(0.3);
    session.recording = path.toStdString();
    writeSession(session, scratch_.filePath("session.yaml").toStdString());

    readSession(scratch_.filePath("session.yaml").toStdString());  // it is one

    GrowingFixture test;
    test.window.files().open(scratch_.filePath("session.yaml"));
    test.window.showScreen("recording");
    QTRY_VERIFY2_WITH_TIMEOUT(test.checked.size() == 1, qPrintable(test.card()->text()), kPatience_ms / 4);
    QVERIFY(!test.follow()->isVisible());
    recorder.goOn();
    QTRY_VERIFY_WITH_TIMEOUT(test.follow()->isVisible(), 5000 * kSlowdown);
    for (const QLabel* const label : test.child<RecordingScreen>()->findChildren<QLabel*>())
      if (label->property("role") == "problem") QVERIFY2(!label->isVisible(), qPrintable(label->text()));
    QTest::mouseClick(test.follow(), Qt::LeftButton, {}, {8, test.follow()->height() / 2});
    QVERIFY(test.growing.following());
    QVERIFY2(test.card()->text().contains("so far"), qPrintable(test.card()->text()));
    QTRY_VERIFY_WITH_TIMEOUT(test.ended.size() == 1, kPatience_ms);
    QVERIFY(recorder.isDone() && !test.growing.following());
    QVERIFY2(!test.card()->text().contains("so far"), qPrintable(test.card()->text()));

    QVERIFY2(test.checked.size() >= 3, qPrintable(QString::number(test.checked.size())));
    double before_s = 0.0;
    for (qsizetype k = 0; k < test.checked.size(); ++k) {
      const double now_s = duration_s(test.look(test.checked, k)->assessment);
      QVERIFY2(now_s >= before_s, qPrintable(QString("%1 after %2").arg(now_s).arg(before_s)));
      before_s = now_s;
    }
    const RecordingAssessment& first = test.look(test.checked, 0)->assessment;
    const RecordingAssessment& last = test.look(test.checked, test.checked.size() - 1)->assessment;
    QVERIFY(duration_s(first) < 2.0);
    QVERIFY2(duration_s(last) > 3.7, qPrintable(QString::number(duration_s(last))));
    QVERIFY(shareOfImage(last) > shareOfImage(first));
    QVERIFY2(last.light <= first.light, qPrintable(test.card()->text()));
    const QString missing_first = stillMissing(first), missing_last = stillMissing(last);
    QVERIFY2(missing_last.size() < missing_first.size(), qPrintable(missing_first + '\n' + missing_last));
    QVERIFY2(last.can_be_calibrated, qPrintable(test.card()->text()));
    // Other pages have all of its data as well.
    DetectionScreen& detection = *test.child<DetectionScreen>();
    QTRY_VERIFY_WITH_TIMEOUT(detection.timeline().end_s() > 3.7, kPatience_ms);
    QVERIFY(test.window.close());
  }

  void fileThatDoesNotGrow_isNotOfferedToBeFollowed() {
    GrowingFixture test;
    test.window.files().open(copyWithRecording(scratch_.path()));
    test.window.showScreen("recording");
    QTRY_VERIFY_WITH_TIMEOUT(test.checked.size() == 1, kPatience_ms);
    spin(2500);
    QVERIFY(!test.follow()->isVisible());
    QCOMPARE(test.checked.size(), 1);
    QVERIFY(test.window.close());
  }

  void sizes_areOfFilesAndOfAllInFolders() {
    const std::filesystem::path folder = scratch_.filePath("sizes").toStdString();
    std::filesystem::create_directories(folder / "deeper");
    const auto write = [](const std::filesystem::path& path, int size) {
      QFile file(QString::fromStdString(path.string()));
      QVERIFY(file.open(QIODevice::WriteOnly));
      file.write(QByteArray(size, 'x'));
    };
    write(folder / "events.txt", 100);
    write(folder / "deeper" / "imu.txt", 20);
    QCOMPARE(bytesOf({folder}), std::uintmax_t{120});
    QCOMPARE(bytesOf({folder / "events.txt", folder / "not_there"}), std::uintmax_t{100});
    // The session next to it is saved, and results are written: the recording does not grow by that.
    std::filesystem::create_directories(folder / "2026-11-27");
    write(folder / "session.yaml", 7);
    write(folder / "2026-11-27" / "result.yaml", 11);
    write(folder / "2026-11-27" / "report.html", 13);
    QCOMPARE(bytesOf({folder}), std::uintmax_t{120});
  }
};

EVICAL_TEST(TestGrowingRecording)
#include "tst_growing_recording.moc"
