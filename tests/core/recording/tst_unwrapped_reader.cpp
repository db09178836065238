// Counters that wrap, in formats that do not state their width.
#include "core/base/time.h"
#include "core/recording/inspection.h"
#include "core/recording/unwrapped_reader.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

using namespace evical;
using namespace evical::test;

class TestUnwrappedReader : public QObject {
  Q_OBJECT

 private slots:
  void wraps_areContinued_data() {
    QTest::addColumn<QString>("header");  // of the time
    QTest::addColumn<qint64>("range");    // of the counter, in its unit
    QTest::addColumn<qint64>("step");     // from sample to sample
    QTest::addColumn<qint64>("begin");    // before the wrap
    QTest::addColumn<qint64>("lowest");   // number that the counter starts again with
    QTest::addColumn<int>("wraps");
    constexpr qint64 k32 = qint64{1} << 32;
    QTest::newRow("us, 32 bits") << "t_us" << k32 << qint64{5003} << qint64{4'000'000} << qint64{0} << 1;
    QTest::newRow("us, 32 bits with sign")
        << "t_us" << k32 << qint64{5003} << qint64{4'000'000} << -k32 / 2 << 1;
    QTest::newRow("us, 24 bits") << "t_us" << (qint64{1} << 24) << qint64{5003} << qint64{4'000'000}
                                 << qint64{0} << 1;
    QTest::newRow("ns, 32 bits, twice")
        << "t_ns" << k32 << qint64{5'000'003} << qint64{2'000'000'000} << qint64{0} << 2;
    QTest::newRow("ms, 16 bits") << "t_ms" << qint64{1 << 16} << qint64{5} << qint64{4000} << qint64{0} << 1;
    QTest::newRow("us, 32 bits, with an offset")
        << "t_us" << k32 << qint64{5003} << qint64{4'000'000} << qint64{1'700'000'000'000'000} << 1;
  }
  void wraps_areContinued() {
    QFETCH(QString, header);
    QFETCH(qint64, range);
    QFETCH(qint64, step);
    QFETCH(qint64, begin);
    QFETCH(qint64, lowest);
    QFETCH(int, wraps);
    constexpr int kCount = 1500;
    const qint64 unit_ns = header == "t_us" ? 1000 : header == "t_ms" ? 1'000'000 : 1;
    std::string imu = header.toStdString() + ",ax,ay,az,gx,gy,gz\n",
                events = header.toStdString() + ",x,y,p\n";
    for (int i = 0; i < kCount; ++i) {
      const qint64 count = lowest + (range - begin + step * i) % range;
      imu += fmt::format("{},{:.4f},0,9.8,{:.4f},0.2,0.3\n", count, 0.01 * std::sin(i), std::cos(i));
      events += fmt::format("{},{},{},{}\n", count, i % 300, i % 200, i % 2);
    }
    const ScratchFolder folder;
    folder.write("imu.csv", imu);
    folder.write("events.csv", events);
    const Contents contents = readAll(folder.path());
    std::size_t streams = 0;
    const auto check = [&](const auto& items) {
      QCOMPARE(items.size(), std::size_t{kCount});
      for (std::size_t i = 1; i < items.size(); ++i)
        QCOMPARE(qint64(items[i].time_ns - items[i - 1].time_ns), step * unit_ns);
      ++streams;
    };
    for (const auto& [stream, items] : contents.events)
      if (!items.empty()) check(items);
    for (const auto& [stream, items] : contents.imu)
      if (!items.empty()) check(items);
    QCOMPARE(streams, std::size_t{2});
    const auto said = std::ranges::count_if(contents.faults, [&](const RecordingFault& fault) {
      return fault.kind == FaultKind::TimeWrap &&
             fault.text.find(wraps == 1 ? "wraps once" : "wraps 2 times") != std::string::npos;
    });
    QCOMPARE(said, std::ptrdiff_t{2});
    const Inspection inspection = inspectRecording(*openRecording(folder.path()));
    for (const RecordingFault& fault : inspection.faults)
      QVERIFY2(fault.kind != FaultKind::BackwardTime && fault.kind != FaultKind::Gap, fault.text.c_str());
  }

  // Late items around the wrap keep their own time.
  void disorderAtTheWrap_isKept() {
    constexpr std::int64_t kRange_ns = (std::int64_t{1} << 32) * kMicrosecond_ns;
    WrapDetector detector;
    detector.unwrap(kRange_ns - 3'000'000);
    QCOMPARE(qint64(detector.unwrap(1'000'000)), qint64(kRange_ns + 1'000'000));
    QCOMPARE(qint64(detector.unwrap(kRange_ns - 1'000'000)), qint64(kRange_ns - 1'000'000));
    QCOMPARE(qint64(detector.unwrap(3'000'000)), qint64(kRange_ns + 3'000'000));
    QCOMPARE(detector.wraps(), 1);
  }

  // A clock that is set, a driver that starts again, strays.
  void otherSteps_areNoWraps_data() {
    QTest::addColumn<double>("before_s");
    QTest::addColumn<double>("after_s");
    QTest::newRow("restart") << 1234.5 << 0.0;
    QTest::newRow("restart after a similar time") << 4200.0 << 0.0;
    QTest::newRow("clock set back by an hour") << 1.7e9 << 1.7e9 - 3600.0;
    QTest::newRow("a second back") << 100.0 << 99.0;
    QTest::newRow("stray in the future") << 1.7e9 << 1.7e9 - 4290.0;
    QTest::newRow("short range with an offset") << 1.7e9 << 1.7e9 - 4.294967;
    QTest::newRow("from 1970 to 0") << 1.7e9 << 0.0;
  }
  void otherSteps_areNoWraps() {
    QFETCH(double, before_s);
    QFETCH(double, after_s);
    WrapDetector detector;
    detector.unwrap(nanosecondsFrom(before_s));
    QCOMPARE(qint64(detector.unwrap(nanosecondsFrom(after_s))), qint64(nanosecondsFrom(after_s)));
  }
};

EVICAL_TEST(TestUnwrappedReader)
#include "tst_unwrapped_reader.moc"
