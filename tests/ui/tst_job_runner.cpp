// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/job_runner.h"

#include "core/base/error.h"
#include "tests/support/test_program.h"
#include "tests/ui/other_load.h"
#include "tests/ui/slowdown.h"
#include "ui/window/job_status.h"

#include <QSignalSpy>

#include <atomic>
#include <stdexcept>

using namespace evical;
using namespace evical::ui;

namespace {

constexpr int kJobRunnerPatience_ms = 5000 * kSlowdown;

// Works until a stop is requested.
void workUntilStopped(const RunContext& context) {
  while (true) {
    context.throwIfStopped();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

struct JobRunnerWatched {
  JobRunner runner;
  QSignalSpy finished{&runner, &JobRunner::finished};
  QSignalSpy failed{&runner, &JobRunner::failed};
  QSignalSpy progressed{&runner, &JobRunner::progressed};

  JobOutcome outcome() {
    if (finished.isEmpty()) finished.wait(kJobRunnerPatience_ms);
    return finished.isEmpty() ? JobOutcome::Failed : finished.last().at(0).value<JobOutcome>();
  }
  JobError error() const { return failed.isEmpty() ? JobError{} : failed.last().at(0).value<JobError>(); }
};

}  // namespace

class TestJobRunner : public QObject {
  Q_OBJECT

 private slots:
  void status_ofAnEndedJob_isForgottenOnReset_butNotOfARunningOne() {
    JobRunnerWatched test;
    JobStatus status(test.runner);
    QVERIFY(test.runner.start("Export", {}, [](const RunContext&) {}));
    QCOMPARE(test.outcome(), JobOutcome::Done);
    QCOMPARE(status.text(), QString("Export: done"));
    status.reset();
    QCOMPARE(status.text(), QString("Ready"));
    test.finished.clear();
    QVERIFY(test.runner.start("Calibration", {}, workUntilStopped));
    status.reset();
    QVERIFY(status.text() != "Ready");
    test.runner.cancel();
    QCOMPARE(test.outcome(), JobOutcome::Cancelled);
    QCOMPARE(status.text(), QString("Calibration: cancelled"));
  }

  void work_runsInAnotherThread() {
    JobRunnerWatched test;
    std::thread::id worker;
    QVERIFY(test.runner.start("Job", {}, [&](const RunContext&) { worker = std::this_thread::get_id(); }));
    QVERIFY(test.runner.running());
    QCOMPARE(test.outcome(), JobOutcome::Done);
    QVERIFY(!test.runner.running());
    QVERIFY(worker != std::this_thread::get_id());
  }

  void secondJob_isRefusedWhileOneRuns() {
    JobRunnerWatched test;
    QVERIFY(test.runner.start("First", {}, workUntilStopped));
    QVERIFY(!test.runner.start("Second", {}, [](const RunContext&) {}));
    QCOMPARE(test.runner.title(), QString("First"));
    test.runner.cancel();
    QCOMPARE(test.outcome(), JobOutcome::Cancelled);
    QVERIFY(test.runner.start("Second", {}, [](const RunContext&) {}));
    test.finished.clear();
    QCOMPARE(test.outcome(), JobOutcome::Done);
  }

  void progress_countsStagesByTheirShares() {
    JobRunnerWatched test;
    test.runner.start("Job", {{"a", 1.0}, {"b", 3.0}}, [](const RunContext& context) {
      context.progress.stageStarted("a");
      context.progress.stageProgress(1.0);
      context.progress.stageStarted("b");
      context.progress.stageProgress(0.5);
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
    });
    QCOMPARE(test.outcome(), JobOutcome::Done);
    const auto last = test.progressed.last().at(0).value<JobProgress>();
    QCOMPARE(last.stage, QString("b"));
    QCOMPARE(last.stage_fraction, 0.5);
    QCOMPARE(last.fraction, 0.625);
    QVERIFY(last.remaining_s > 0.0);
    QVERIFY(qAbs(last.remaining_s - last.elapsed_s * 0.6) < 0.05);
  }

  void progress_neverFalls() {
    JobRunnerWatched test;
    test.runner.start("Job", {{"a", 1.0}}, [](const RunContext& context) {
      context.progress.stageStarted("a");
      for (const double fraction : {0.5, 0.2, 0.7, 2.0, -1.0}) {
        context.progress.stageProgress(fraction);
        std::this_thread::sleep_for(std::chrono::milliseconds(60));
      }
    });
    QCOMPARE(test.outcome(), JobOutcome::Done);
    double before = 0.0;
    for (const QList<QVariant>& arguments : test.progressed) {
      const double fraction = arguments.at(0).value<JobProgress>().fraction;
      QVERIFY(fraction >= before && fraction <= 1.0);
      before = fraction;
    }
    QCOMPARE(before, 1.0);
  }

  void manyReports_becomeFewSignals() {
    JobRunnerWatched test;
    QSignalSpy lines(&test.runner, &JobRunner::logged);
    test.runner.start("Job", {{"a", 1.0}}, [](const RunContext& context) {
      context.progress.stageStarted("a");
      for (int i = 0; i < 200'000; ++i) context.progress.stageProgress(i / 200'000.0);
      for (int i = 0; i < 10; ++i) context.progress.log(LogLevel::Info, std::to_string(i));
    });
    QCOMPARE(test.outcome(), JobOutcome::Done);
    QVERIFY(test.progressed.count() < 100);
    QCOMPARE(lines.count(), 10);
    QCOMPARE(lines.last().at(0).value<LogLine>().text, QString("9"));
    QVERIFY(test.runner.logText().contains("stage    a\n"));
    QVERIFY(test.runner.logText().endsWith("info     9\n"));
  }

  void cancel_isAnsweredWithinHalfASecond() {
    JobRunnerWatched test;
    test.runner.start("Job", {}, workUntilStopped);
    QTest::qWait(50);
    const evical::ui::test::ComputedTime since_cancel;
    test.runner.cancel();
    QVERIFY(test.runner.cancelling());
    QCOMPARE(test.outcome(), JobOutcome::Cancelled);
    QVERIFY(since_cancel.elapsed_ms() < evical::ui::test::maxAfterCancel_ms());
    QVERIFY(test.failed.isEmpty());
  }

  void exception_becomesAnError_data() {
    QTest::addColumn<int>("kind");
    QTest::addColumn<QString>("place");
    QTest::addColumn<bool>("bad_input");
    QTest::newRow("bad input") << 0 << "a.bag" << true;
    QTest::newRow("calibration failed") << 1 << "left" << false;
    QTest::newRow("memory") << 2 << "memory" << false;
    QTest::newRow("bug") << 3 << "internal error" << false;
    QTest::newRow("unknown") << 4 << "internal error" << false;
  }
  void exception_becomesAnError() {
    QFETCH(int, kind);
    JobRunnerWatched test;
    test.runner.start("Job", {}, [kind](const RunContext&) {
      if (kind == 0) throw badInput("a.bag", "is not a recording", "Give a bag");
      if (kind == 1) throw calibrationFailed("left", "no board", "Show it");
      if (kind == 2) throw std::bad_alloc();
      if (kind == 3) throw std::logic_error("that cannot be");
      throw 42;  // NOLINT: this must not be lost either
    });
    QCOMPARE(test.outcome(), JobOutcome::Failed);
    QTEST(test.error().place, "place");
    QTEST(test.error().bad_input, "bad_input");
    QVERIFY(!test.error().problem.isEmpty());
    QVERIFY(!test.error().advice.isEmpty());
    QVERIFY(!test.runner.running());
  }

  void error_readsAsASentence() {
    const JobError error{true, "a.bag", "is not a recording", "Give a bag"};
    QCOMPARE(error.text(), QString("a.bag: is not a recording. Give a bag"));
  }

  void deletion_whileRunning_stopsAndWaits() {
    std::atomic<bool> ended = false;
    {
      JobRunner runner;
      runner.start("Job", {}, [&](const RunContext& context) {
        try {
          workUntilStopped(context);
        } catch (...) {
          ended = true;
          throw;
        }
      });
      QTest::qWait(30);
    }
    QVERIFY(ended);
    QCoreApplication::processEvents();  // no posted event of the job may arrive now
  }

  void inputsOfTheWork_areGoneWhenItHasFinished() {
    JobRunnerWatched test;
    auto input = std::make_shared<int>(1);
    test.runner.start("Job", {}, [copy = input](const RunContext&) {});
    QCOMPARE(test.outcome(), JobOutcome::Done);
    QCOMPARE(input.use_count(), 1L);
  }
};

EVICAL_TEST(TestJobRunner)
#include "tst_job_runner.moc"
