// A batch file, and the outcomes of its jobs, which decide what runs again.
#include "core/base/error.h"
#include "core/pipeline/batch/batch_jobs.h"
#include "core/pipeline/batch/batch_run.h"
#include "tests/support/test_program.h"

#include <QFile>
#include <QTemporaryDir>

using namespace evical;

class TestBatchOutcome : public QObject {
  Q_OBJECT

 private slots:
  void init() {
    folder_ = std::make_unique<QTemporaryDir>();
    write("one.yaml", "evical_session: 1\n");
    write("batch.yaml",
          "evical_batch: 1\nthreads: 1\nset: {optimisation.solver.threads: 1}\njobs:\n"
          "  - one.yaml\n  - {name: second, session: one.yaml, set: {detection.method: ring_vote}}\n");
    batch_ = readBatch(path("batch.yaml"));
    makeBatchFolder(results());
  }

  void jobs_haveNamesPathsAndSettings() {
    QCOMPARE(batch_.jobs.size(), std::size_t{2});
    QCOMPARE(batch_.jobs[0].session, path("one.yaml"));
    QCOMPARE(batch_.jobs[1].name, std::string("second"));
    const std::vector<std::string> expected{"optimisation.solver.threads=1", "detection.method=ring_vote"};
    QCOMPARE(batch_.jobs[1].settings, expected);
  }

  void outcome_readsBack() {
    const JobOutcome outcome{JobEnd::Failed, "the board: \"was\" never found", 12.5, 321.0,
                             inputsOf(batch_.jobs[0])};
    writeOutcome(results(), batch_.jobs[0], outcome);
    const std::optional<JobOutcome> read = readOutcome(results(), batch_.jobs[0]);
    QVERIFY(read);
    QVERIFY(read->end == JobEnd::Failed);
    QCOMPARE(read->reason, outcome.reason);
    QCOMPARE(read->wall_s, 12.5);
    QCOMPARE(read->inputs, outcome.inputs);
    QVERIFY(!readOutcome(results(), batch_.jobs[1]));
  }

  // A job that failed runs again only if its inputs change, one that was killed in any case.
  void settledJob_doesNotRunAgain() {
    const BatchJob& job = batch_.jobs[0];
    JobOutcome outcome{JobEnd::Failed, "a reason", 1.0, 2.0, inputsOf(job)};
    QVERIFY(isSettled(results(), job, outcome));
    outcome.end = JobEnd::Killed;
    QVERIFY(!isSettled(results(), job, outcome));
    outcome.end = JobEnd::Failed;
    write("one.yaml", "evical_session: 1\nrecording: another\n");
    QVERIFY(!isSettled(results(), job, outcome));
  }

  void damagedOutcome_countsAsNone() {
    writeOutcome(results(), batch_.jobs[0], {JobEnd::Failed, "a reason", 1.0, 2.0, {}});
    QFile file(QString::fromStdString(jobFile(results(), batch_.jobs[0], ".yaml").string()));
    QVERIFY(file.open(QIODevice::WriteOnly) && file.write("end: [") > 0);
    file.close();
    QVERIFY(!readOutcome(results(), batch_.jobs[0]));
    QVERIFY(collectBatch(batch_, results())[0].end == JobEnd::NotRun);
  }

 private:
  std::filesystem::path path(const char* name) const { return folder_->filePath(name).toStdString(); }
  std::filesystem::path results() const { return path("results"); }
  void write(const char* name, const char* text) const {
    QFile file(folder_->filePath(name));
    if (file.open(QIODevice::WriteOnly)) file.write(text);
  }

  std::unique_ptr<QTemporaryDir> folder_;
  Batch batch_;
};

EVICAL_TEST(TestBatchOutcome)
#include "tst_batch_outcome.moc"
