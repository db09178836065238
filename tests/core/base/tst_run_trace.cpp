#include "core/base/run_trace.h"

#include "tests/support/test_program.h"

#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QMap>
#include <QStringList>

#include <cmath>
#include <ctime>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

using namespace evical;

namespace {

class Shown final : public ProgressSink {
 public:
  void stageStarted(const ProgressStage& stage) override { stages.push_back(stage.name); }
  void stageProgress(double fraction) override { fractions.push_back(fraction); }
  void log(LogLevel, std::string_view text) override { texts.emplace_back(text); }

  std::vector<std::string> stages, texts;
  std::vector<double> fractions;
};

QJsonArray eventsOf(RunTrace& trace) {
  const QByteArray json = QByteArray::fromStdString(trace.json());
  QJsonParseError error{};
  const QJsonDocument document = QJsonDocument::fromJson(json, &error);
  if (error.error != QJsonParseError::NoError) qWarning("%s", qPrintable(error.errorString()));
  return document.object()["traceEvents"].toArray();
}

QList<QJsonObject> ofKind(const QJsonArray& events, const char* phase) {
  QList<QJsonObject> found;
  for (const QJsonValue& event : events)
    if (event.toObject()["ph"].toString() == phase) found.append(event.toObject());
  return found;
}

double computed_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// Counts the thread's computing time only, independent of other load.
void computeFor(double seconds) {
  const double end_s = computed_s() + seconds;
  volatile double sum = 0.0;
  while (computed_s() < end_s) sum = sum + std::sqrt(sum + 1.0);
}

}  // namespace

class TestRunTrace : public QObject {
  Q_OBJECT

 private slots:
  void stages_followEachOther() {
    Shown shown;
    RunTrace trace(shown);
    trace.stageStarted("detect");
    trace.stageProgress(0.5);
    trace.log(LogLevel::Debug, "a \"quoted\" line\nand C:\\");
    computeFor(0.03);
    trace.stageStarted("optimise");
    computeFor(0.03);
    const QJsonArray events = eventsOf(trace);
    QList<QJsonObject> stages;
    for (const QJsonObject& slice : ofKind(events, "X"))
      if (slice["tid"].toInt() == 0) stages.append(slice);
    QCOMPARE(stages.size(), 2);
    QCOMPARE(stages[0]["name"].toString(), "detect");
    QCOMPARE(stages[1]["name"].toString(), "optimise");
    QVERIFY(stages[0]["dur"].toDouble() >= 3e4);
    QVERIFY(std::abs(stages[0]["ts"].toDouble() + stages[0]["dur"].toDouble() - stages[1]["ts"].toDouble()) <=
            1.0);
    QVERIFY(stages[1]["dur"].toDouble() >= 3e4);
    QCOMPARE(ofKind(events, "i").size(), 1);
    QCOMPARE(ofKind(events, "i")[0]["name"].toString(), "a \"quoted\" line\nand C:\\");
    QCOMPARE(shown.stages, (std::vector<std::string>{"detect", "optimise"}));
    QCOMPARE(shown.fractions, std::vector<double>{0.5});
    QCOMPARE(shown.texts.size(), std::size_t{1});
  }

  void threads_haveRowsAndTheirTime() {
    Shown shown;
    RunTrace trace(shown);
    if (!std::ifstream("/proc/self/schedstat"))
      QSKIP("this system does not report the computing time of threads");
    std::thread other([] { computeFor(0.05); });
    computeFor(0.05);
    other.join();
    const QJsonArray events = eventsOf(trace);
    QMap<int, double> computing_s;
    for (const QJsonObject& slice : ofKind(events, "X")) {
      QVERIFY(slice["dur"].toDouble() >= 0.0);
      computing_s[slice["tid"].toInt()] += slice["args"].toObject()["computing_s"].toDouble();
    }
    int busy = 0;  // others are the test program's own
    for (const double each : computing_s) {
      QVERIFY2(each < 0.3, qPrintable(QString::number(each)));
      busy += each > 0.01 ? 1 : 0;
    }
    QCOMPARE(busy, 2);
    QStringList rows;
    for (const QJsonObject& row : ofKind(events, "M")) rows.append(row["args"].toObject()["name"].toString());
    QCOMPARE(rows.size(), computing_s.size() + 1);
    QCOMPARE(rows[0], "stages");
    double memory_mb = 0.0;
    for (const QJsonObject& counter : ofKind(events, "C"))
      if (counter["name"].toString() == "memory [MB]")
        memory_mb = counter["args"].toObject()["value"].toDouble();
    QVERIFY(memory_mb > 1.0 && memory_mb < 10000.0);
  }
};

EVICAL_TEST(TestRunTrace)
#include "tst_run_trace.moc"
