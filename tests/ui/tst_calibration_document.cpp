// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/document/calibration_document.h"

#include "core/base/error.h"
#include "core/frontend/detection_options.h"
#include "tests/support/test_program.h"
#include "tests/ui/simulated_session.h"

#include <QSignalSpy>
#include <QTemporaryDir>

using namespace evical;
using namespace evical::ui;

namespace {

Session withRows(const CalibrationDocument& document, int rows) {
  Session session = document.session();
  session.board.rows = rows;
  return session;
}

}  // namespace

class TestCalibrationDocument : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

 private slots:
  void openAndSave_roundTrip() {
    const QString file = evical::ui::test::copyOfSimulatedSession(scratch_.path());
    CalibrationDocument document;
    QSignalSpy replaced(&document, &CalibrationDocument::sessionReplaced);
    document.open(file);
    QCOMPARE(replaced.count(), 1);
    QVERIFY(document.hasSession() && !document.modified());
    QCOMPARE(document.title(), QFileInfo(file).dir().dirName() + "/session.yaml");

    document.edit(withRows(document, 9), "Rows");
    document.setOption("grid.min_circles", "9");
    QVERIFY(document.modified());
    const QString copy = scratch_.filePath("copy.yaml");
    document.save(copy);
    QVERIFY(!document.modified());
    QCOMPARE(document.file(), copy);

    CalibrationDocument again;
    again.open(copy);
    QCOMPARE(again.session().board.rows, 9);
    QCOMPARE(again.session().options, document.session().options);
    QCOMPARE(std::filesystem::canonical(again.session().recording),
             std::filesystem::canonical(document.session().recording));
    QCOMPARE(again.session().cameras.at(0).intrinsics, document.session().cameras.at(0).intrinsics);
  }

  // The listening window is partly destroyed by then.
  void document_saysNothingAtItsEnd() {
    int said = 0;
    {
      CalibrationDocument document;
      document.open(evical::ui::test::copyOfSimulatedSession(scratch_.path()));
      document.edit(withRows(document, 9), "Rows");
      connect(&document, &CalibrationDocument::fileChanged, [&] { ++said; });
    }
    QCOMPARE(said, 0);
  }

  void open_ofWhatIsNoSession_changesNothing() {
    CalibrationDocument document;
    document.open(evical::ui::test::simulatedSession());
    const QString broken = scratch_.filePath("broken.yaml");
    QFile file(broken);
    QVERIFY(file.open(QIODevice::WriteOnly));
    file.write("evical_session: 1\nrecordign: x.bag\n");
    file.close();
    QSignalSpy replaced(&document, &CalibrationDocument::sessionReplaced);
    QVERIFY_THROWS_EXCEPTION(CalibrationError, document.open(broken));
    QVERIFY(replaced.isEmpty());
    QCOMPARE(document.file(), evical::ui::test::simulatedSession());
  }

  void save_intoNowhere_keepsTheChanges() {
    CalibrationDocument document;
    document.open(evical::ui::test::simulatedSession());
    document.edit(withRows(document, 9), "Rows");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, document.save("/nowhere/at/all/session.yaml"));
    QVERIFY(document.modified());
    QCOMPARE(document.file(), evical::ui::test::simulatedSession());
  }

  void options_areUndoneAndRedone() {
    CalibrationDocument document;
    document.open(evical::ui::test::simulatedSession());
    QSignalSpy changed(&document, &CalibrationDocument::sessionChanged);
    document.setOption("grid.min_circles", "9");
    QCOMPARE(document.session().options.front_end->grid.min_circles, 9);
    document.undoStack().undo();
    QCOMPARE(document.session().options, CalibrationOptions{});
    QVERIFY(!document.modified());
    document.undoStack().redo();
    QCOMPARE(document.session().options.front_end->grid.min_circles, 9);
    QCOMPARE(changed.count(), 3);
    document.resetOptions();
    QCOMPARE(document.session().options, CalibrationOptions{});
    document.undoStack().undo();
    QCOMPARE(document.session().options.front_end->grid.min_circles, 9);
  }

  void stepsOfOneOption_areOneUndo() {
    CalibrationDocument document;
    document.open(evical::ui::test::simulatedSession());
    for (const char* value : {"9", "10", "11"}) document.setOption("grid.min_circles", value);
    QCOMPARE(document.undoStack().count(), 1);
    document.setOption("tuning.bursts.min_events", "3");
    QCOMPARE(document.undoStack().count(), 2);
  }

  void option_outOfRange_isRefused() {
    CalibrationDocument document;
    document.open(evical::ui::test::simulatedSession());
    QVERIFY_THROWS_EXCEPTION(CalibrationError, document.setOption("grid.min_circles", "-5"));
    QVERIFY_THROWS_EXCEPTION(CalibrationError, document.setOption("grid.no_such", "5"));
    QVERIFY(!document.modified());
  }

  void optionThatAnotherExcludes_isRefused() {
    CalibrationDocument document;
    document.open(evical::ui::test::simulatedSession());
    QVERIFY_THROWS_EXCEPTION(OptionConflict, document.setOption("detection.min_window_s", "0.1"));
    QVERIFY(!document.modified());
    document.setOption("detection.max_window_s", "0.15");
    document.setOption("detection.min_window_s", "0.1");
    QCOMPARE(document.session().options.front_end->detection.min_window_s, 0.1);
  }

  void sessionWithOptionsThatExcludeEachOther_hasAProblem() {
    Session session = readSession(evical::ui::test::simulatedSession().toStdString());
    QCOMPARE(sessionProblems(session).size(), std::size_t(0));
    session.options.front_end.edit().tracking.min_polarity_cosine = 0.9;
    const std::vector<SessionProblem> problems = sessionProblems(session);
    QCOMPARE(problems.size(), std::size_t(1));
    QVERIFY2(problems[0].text.contains("tuning.tracking.full_polarity_cosine (0.7)"),
             qPrintable(problems[0].text));
  }

  void run_isOutdatedByAChange_andNotByItsUndo() {
    CalibrationDocument document;
    document.open(evical::ui::test::simulatedSession());
    QVERIFY(!document.runIsOutdated());
    document.addRun({std::make_shared<CalibrationRun>(), document.session(), "log"});
    QVERIFY(!document.runIsOutdated());
    document.setOption("grid.min_circles", "9");
    QVERIFY(document.runIsOutdated());
    document.undoStack().undo();
    QVERIFY(!document.runIsOutdated());
  }

  void runs_areKeptTwo_andGoWithTheSession() {
    CalibrationDocument document;
    document.open(evical::ui::test::simulatedSession());
    const auto first = std::make_shared<CalibrationRun>(), second = std::make_shared<CalibrationRun>();
    document.addRun({first, document.session(), {}});
    QVERIFY(!document.previous().run);
    document.addRun({second, document.session(), {}});
    QCOMPARE(document.last().run.get(), second.get());
    QCOMPARE(document.previous().run.get(), first.get());
    document.open(evical::ui::test::simulatedSession());
    QVERIFY(!document.last().run && !document.previous().run);
  }

  void reference_isReadFromATruth() {
    CalibrationDocument document;
    document.open(evical::ui::test::simulatedSession());
    const QString truth = QFileInfo(evical::ui::test::simulatedSession()).path() + "/truth.yaml";
    document.loadReference(truth);
    QCOMPARE(document.reference()->named.cameras.at(0).name, std::string("left"));
    QVERIFY_THROWS_EXCEPTION(CalibrationError, document.loadReference(evical::ui::test::simulatedSession()));
    QVERIFY(document.reference().has_value());
    document.forgetReference();
    QVERIFY(!document.reference().has_value());
  }

  void intrinsicsThatTheRunFound_areItsOwn_andNotOutdated() {
    CalibrationDocument document;
    Session session = readSession(evical::ui::test::simulatedSession().toStdString());
    const CameraIntrinsics known = *session.cameras[0].intrinsics;
    session.cameras[0].intrinsics.reset();
    document.startSession(session);
    const auto run = std::make_shared<CalibrationRun>();
    run->intrinsics.emplace_back(IntrinsicsResult{}).value().intrinsics = known;
    run->result.state.cameras.emplace_back().lens.detection_intrinsics = known;
    document.addRun({run, document.session(), {}});
    QVERIFY(document.last().run->result.state.cameras[0].lens.inUse() == known);
    QVERIFY(!document.last().session.cameras[0].intrinsics);
    QVERIFY(!document.session().cameras[0].intrinsics);
    QVERIFY(!document.runIsOutdated());
    session.cameras[0].intrinsics = known;
    document.edit(session, "Take them over");
    QVERIFY(document.runIsOutdated());
  }

  void problems_nameTheField_data() {
    QTest::addColumn<int>("fault");
    QTest::addColumn<QString>("field");
    QTest::newRow("none") << 0 << "";
    QTest::newRow("no recording") << 1 << "recording";
    QTest::newRow("recording gone") << 2 << "recording";
    QTest::newRow("no camera") << 3 << "cameras";
    QTest::newRow("no imu") << 4 << "imus";
    QTest::newRow("no intrinsics") << 5 << "";  // calibrated first
    QTest::newRow("no focal length") << 8 << "cameras.left.intrinsics";
    QTest::newRow("circles touch") << 6 << "board";
    QTest::newRow("wrong reference") << 7 << "reference";
  }
  void problems_nameTheField() {
    QFETCH(int, fault);
    QFETCH(QString, field);
    Session session = readSession(evical::ui::test::simulatedSession().toStdString());
    if (fault == 1) session.recording.clear();
    if (fault == 2) session.recording = "/nowhere.bag";
    if (fault == 3) session.cameras.clear();
    if (fault == 4) session.imus.clear();
    if (fault == 5) session.cameras[0].intrinsics.reset();
    if (fault == 8) session.cameras[0].intrinsics->focal_length_px.x() = 0.0;
    if (fault == 6) session.board.radius_m = 1.0;
    if (fault == 7) session.reference = "nobody";
    const std::vector<SessionProblem> problems = sessionProblems(session);
    if (field.isEmpty()) {
      QVERIFY(problems.empty());
      return;
    }
    QCOMPARE(problems.size(), std::size_t{1});
    QCOMPARE(problems[0].field, field);
    QVERIFY(!problems[0].text.isEmpty());
  }
};

EVICAL_TEST(TestCalibrationDocument)
#include "tst_calibration_document.moc"
