// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/calibration_job.h"

#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/simulated_session.h"
#include "tests/ui/slowdown.h"

#include <QSignalSpy>

using namespace evical;
using namespace evical::ui;

namespace {

constexpr int kCalibrationJobPatience_ms = 120'000 * kSlowdown;

struct CalibrationJobWatched {
  JobRunner runner;
  CalibrationJob job{runner};
  QSignalSpy finished{&runner, &JobRunner::finished};
  QSignalSpy failed{&runner, &JobRunner::failed};
  std::shared_ptr<const CalibrationRun> run;
  std::vector<std::shared_ptr<const LiveDetections>> detections;
  std::shared_ptr<const LiveIterations> iterations;
  QStringList notes;
  std::size_t inputs = 0;

  CalibrationJobWatched() {
    QObject::connect(&job, &CalibrationJob::calibrated, &job,
                     [this](std::shared_ptr<const CalibrationRun> made) { run = std::move(made); });
    QObject::connect(&job, &CalibrationJob::detectionsChanged, &job,
                     [this](auto snapshot) { detections.push_back(std::move(snapshot)); });
    QObject::connect(&job, &CalibrationJob::iterationsChanged, &job,
                     [this](auto snapshot) { iterations = std::move(snapshot); });
    QObject::connect(&job, &CalibrationJob::initialisationStepDone, &job,
                     [this](const InitialisationNote& note) { notes << note.step; });
    QObject::connect(&job, &CalibrationJob::detectionDone, &job, [this] { ++inputs; });
  }
  JobOutcome outcome() {
    if (finished.isEmpty()) finished.wait(kCalibrationJobPatience_ms);
    return finished.isEmpty() ? JobOutcome::Failed : finished.last().at(0).value<JobOutcome>();
  }
};

}  // namespace

class TestCalibrationJob : public QObject {
  Q_OBJECT

  Session session_;

 private slots:
  void initTestCase() { session_ = readSession(evical::ui::test::simulatedSession().toStdString()); }

  void job_showsItsWorkAndDeliversTheRun() {
    CalibrationJobWatched test;
    QVERIFY(test.job.start(session_));
    QVERIFY(test.job.running());
    QCOMPARE(test.outcome(), JobOutcome::Done);
    QVERIFY(test.run);
    QVERIFY(!test.job.running());
    QCOMPARE(test.inputs, std::size_t{1});
    QCOMPARE(test.notes.size(), 7);
    QVERIFY(!test.detections.empty());
    for (std::size_t i = 1; i < test.detections.size(); ++i) {
      QVERIFY(test.detections[i]->at(0).windows > test.detections[i - 1]->at(0).windows);
    }
    QCOMPARE(test.iterations->records.size(), test.run->result.iterations.size());
  }

  void cancel_isAnsweredWithinHalfASecond_data() {
    QTest::addColumn<QString>("stage");
    QTest::newRow("while detecting") << "detect";
    QTest::newRow("while optimising") << "optimise";
    for (const char* const share : {"0.15", "0.4", "0.6", "0.75", "0.9"}) QTest::newRow(share) << share;
  }
  void cancel_isAnsweredWithinHalfASecond() {
    QFETCH(QString, stage);
    CalibrationJobWatched test;
    std::optional<evical::ui::test::ComputedTime> since_cancel;
    const auto cancel = [&] {
      if (since_cancel) return;
      since_cancel.emplace();
      test.runner.cancel();
    };
    connect(&test.runner, &JobRunner::stageStarted, &test.runner, [&](const QString& started) {
      if (started == stage) cancel();
    });
    bool is_share = false;
    const double share = stage.toDouble(&is_share);
    connect(&test.runner, &JobRunner::progressed, &test.runner, [&](const JobProgress& progress) {
      if (is_share && progress.fraction >= share) cancel();
    });
    test.job.start(session_);
    QCOMPARE(test.outcome(), JobOutcome::Cancelled);
    QVERIFY(since_cancel);
    QVERIFY2(since_cancel->elapsed_ms() < evical::ui::test::maxAfterCancel_ms(),
             qPrintable(QString::number(since_cancel->elapsed_ms())));
    QVERIFY(!test.run);
    QVERIFY(test.failed.isEmpty());
  }

  void job_canRunAgainAfterCancelling() {
    CalibrationJobWatched test;
    test.job.start(session_);
    test.runner.cancel();
    QCOMPARE(test.outcome(), JobOutcome::Cancelled);
    test.finished.clear();
    QVERIFY(test.job.start(session_));
    QCOMPARE(test.outcome(), JobOutcome::Done);
    QVERIFY(test.run);
  }

  void recordingThatIsGone_isAnErrorWithAdvice() {
    Session gone = session_;
    gone.recording = "/nowhere/recording.bag";
    CalibrationJobWatched test;
    test.job.start(gone);
    QCOMPARE(test.outcome(), JobOutcome::Failed);
    const auto error = test.failed.at(0).at(0).value<JobError>();
    QVERIFY(error.bad_input);
    QVERIFY(error.text().contains("/nowhere/recording.bag"));
  }

  void anotherJob_isNotTakenForACalibration() {
    CalibrationJobWatched test;
    QSignalSpy calibrated(&test.job, &CalibrationJob::calibrated);
    test.runner.start("Other", {}, [](const RunContext&) {});
    QVERIFY(!test.job.start(session_));
    QCOMPARE(test.outcome(), JobOutcome::Done);
    QVERIFY(calibrated.isEmpty());
  }
};

EVICAL_TEST(TestCalibrationJob)
#include "tst_calibration_job.moc"
