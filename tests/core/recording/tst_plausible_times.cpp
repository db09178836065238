// Rates that no camera and no IMU has: they are named, with the unit that would make them true.
#include "core/recording/inspection.h"
#include "core/recording/plausible_times.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <fmt/format.h>

using namespace evical;
using namespace evical::test;

namespace {

// A table of events whose times are written in `written` and stated to be in another unit.
std::string plausibleEvents(const char* header, double step) {
  std::string text = std::string(header) + ",x,y,p\n";
  for (int i = 0; i < 4000; ++i)
    text += fmt::format("{:.0f},{},{},{}\n", step * i, i * 7 % 346, i * 11 % 260, i % 2);
  return text;
}

}  // namespace

class TestPlausibleTimes : public QObject {
  Q_OBJECT

 private slots:
  void rates_areJudged_data() {
    QTest::addColumn<StreamType>("type");
    QTest::addColumn<double>("rate_hz");
    QTest::addColumn<QString>("said");
    const auto row = [](const char* name, StreamType type, double rate_hz, const char* said) {
      QTest::newRow(name) << type << rate_hz << QString(said);
    };
    row("an IMU", StreamType::Imu, 200.0, "");
    row("the fastest IMUs", StreamType::Imu, 32'000.0, "");
    row("slow IMU", StreamType::Imu, 1.0, "");
    row("IMU, us as ns", StreamType::Imu, 2e5, "1000 times too small (us read as ns");
    row("IMU, ms as ns", StreamType::Imu, 2e8, "1e+06 times too small (ms read as ns");
    row("IMU, s as ns", StreamType::Imu, 2e11, "1e+09 times too small (s read as ns");
    row("IMU, ns as us", StreamType::Imu, 0.2, "1000 times too large (ns read as us");
    row("IMU, ns as s", StreamType::Imu, 2e-7, "1e+09 times too large (ns read as s");
    row("a camera", StreamType::Frames, 20.0, "");
    row("a fast camera", StreamType::Frames, 5000.0, "");
    row("pictures by hand", StreamType::Frames, 0.02, "");
    row("frames, a count", StreamType::Frames, 1e9, "no camera is this fast");
    row("frames, days apart", StreamType::Frames, 1e-5, "no camera is this slow");
    row("views, a count", StreamType::Points, 1e9, "no camera is this fast");
    row("busy events", StreamType::Events, 3e6, "");
    row("calm events", StreamType::Events, 2000.0, "");
    row("events, ms as s", StreamType::Events, 4.0, "1000 times too large");
    row("events, us as ns", StreamType::Events, 4e9, "1000 times too small");
  }
  void rates_areJudged() {
    QFETCH(StreamType, type);
    QFETCH(double, rate_hz);
    QFETCH(QString, said);
    SeenTimes seen;
    seen.reach({0, 345, 259, false});
    constexpr int kCount = 4000;
    for (int i = 0; i < kCount; ++i) seen.add(std::llround(1e9 * i / rate_hz));
    if (type == StreamType::Events && rate_hz > 1e5) {  // events of the same us
      seen = {};
      seen.reach({0, 345, 259, false});
      for (int i = 0; i < kCount; ++i) seen.add(std::llround(1e12 * i / rate_hz), 1000);
    }
    const std::optional<std::string> why = whyImplausible(type, seen);
    QCOMPARE(why.has_value(), !said.isEmpty());
    if (why) QVERIFY2(why->find(said.toStdString()) != std::string::npos, why->c_str());
  }

  // Drivers stamp the first sample 0, publish in batches, and pause.
  void strays_batchesAndGaps_arePlausible() {
    SeenTimes stray, batches, gap;
    stray.add(0);
    for (int i = 0; i < 200; ++i) {
      stray.add(1'700'000'000'000'000'000 + i * std::int64_t{5'000'000});
      batches.add(i / 20 * std::int64_t{100'000'000} + i % 20);
      gap.add(i * std::int64_t{5'000'000} + (i < 100 ? 0 : 100'000'000'000'000));
    }
    for (const SeenTimes* seen : {&stray, &batches, &gap}) QVERIFY(!whyImplausible(StreamType::Imu, *seen));
  }

  void equalTimes_areSaid() {
    SeenTimes seen;
    for (int i = 0; i < 2000; ++i) seen.add(1'700'000'000'000'000'000);
    for (const StreamType type : {StreamType::Events, StreamType::Frames})
      QVERIFY(whyImplausible(type, seen)->starts_with("All 2000 "));
  }

  void inspection_saysItFirst_data() {
    QTest::addColumn<QString>("header");
    QTest::addColumn<double>("step");
    QTest::addColumn<bool>("right");
    QTest::newRow("us as ns") << "t_ns" << 250.0 << false;
    QTest::newRow("us as ms") << "t_ms" << 250.0 << false;
    QTest::newRow("us") << "t_us" << 250.0 << true;
  }
  void inspection_saysItFirst() {
    QFETCH(QString, header);
    QFETCH(double, step);
    QFETCH(bool, right);
    const ScratchFolder folder;
    const auto path = folder.write("events.csv", plausibleEvents(header.toStdString().c_str(), step));
    const auto reader = openRecording(path);
    const Inspection inspection = inspectRecording(*reader);
    const bool said = !inspection.faults.empty() && inspection.faults.front().kind == FaultKind::Unit &&
                      inspection.faults.front().text.find("1000 times") != std::string::npos;
    QCOMPARE(said, !right);
  }
};

EVICAL_TEST(TestPlausibleTimes)
#include "tst_plausible_times.moc"
