#include "core/recording/read_out_load.h"
#include "core/recording/stray_stamps.h"

#include "core/base/time.h"
#include "core/data/event.h"
#include "core/data/imu_sample.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace evical;

using Events = std::vector<Event>;

constexpr std::int64_t kStrayStampsStart_ns = 1'600'000'000'000'000'000, kDay_ns = 86'400 * kSecond_ns;

// One event per 10 us.
Events steadyEvents(std::size_t count, std::int64_t start_ns = kStrayStampsStart_ns) {
  Events events;
  for (std::size_t i = 0; i < count; ++i)
    events.push_back(
        {start_ns + static_cast<std::int64_t>(i) * 10'000, static_cast<std::uint16_t>(i % 346), 0, true});
  return events;
}

struct Filtered {
  Events kept;
  std::uint64_t strays = 0;
  std::int64_t stray_ns = 0, from_ns = 0;
};

Filtered filtered(const Events& events, std::size_t packet) {
  StampFilter<Event> filter(kEventStamps);
  Filtered result;
  for (std::size_t i = 0; i < events.size(); i += packet) {
    Events part(events.begin() + static_cast<std::ptrdiff_t>(i),
                events.begin() + static_cast<std::ptrdiff_t>(std::min(i + packet, events.size())));
    filter.filter(part);
    result.kept.insert(result.kept.end(), part.begin(), part.end());
  }
  Events rest;
  filter.finish(rest);
  result.kept.insert(result.kept.end(), rest.begin(), rest.end());
  result.strays = filter.strays();
  result.stray_ns = filter.strayTime_ns();
  result.from_ns = filter.strayFrom_ns();
  return result;
}

bool sameTimes(const Events& a, const Events& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Event& left, const Event& right) { return left.time_ns == right.time_ns; });
}

class TestStrayStamps : public QObject {
  Q_OBJECT
 private slots:
  void readOutAtItsLimit_isTold();
  void goodEvents_areAllKept_data();
  void goodEvents_areAllKept();
  void strayStamps_areDropped_data();
  void strayStamps_areDropped();
  void packetWithAWrongStamp_isDropped();
  void pause_isNoStray();
  void clockThatGoesBackForGood_isFollowed();
  void fewEvents_countAsTheyAre();
  void firstSamplesOfAnotherClock_areDropped_data();
  void firstSamplesOfAnotherClock_areDropped();
};

// Some drivers stamp their first samples 0, or with a clock that is not set yet.
void TestStrayStamps::firstSamplesOfAnotherClock_areDropped_data() {
  QTest::addColumn<qlonglong>("step_ns");
  QTest::newRow("all zero") << qlonglong(0);
  QTest::newRow("counting from zero") << qlonglong(5'000'000);
}

void TestStrayStamps::firstSamplesOfAnotherClock_areDropped() {
  QFETCH(qlonglong, step_ns);
  std::vector<ImuSample> samples;
  for (int i = 0; i < 500; ++i)
    samples.push_back({i < 5 ? i * step_ns : kStrayStampsStart_ns + i * std::int64_t{5'000'000}, {}, {}});
  StampFilter<ImuSample> filter(kSampleStamps);
  std::vector<ImuSample> kept;
  for (const ImuSample& sample : samples) {
    std::vector<ImuSample> part{sample};
    filter.filter(part);
    kept.insert(kept.end(), part.begin(), part.end());
  }
  QCOMPARE(kept.size(), std::size_t{495});
  QCOMPARE(kept.front().time_ns, samples[5].time_ns);
  QCOMPARE(filter.strays(), std::uint64_t{5});
}

void TestStrayStamps::goodEvents_areAllKept_data() {
  QTest::addColumn<int>("packet");
  for (const int packet : {1, 7, 1000, 100'000}) QTest::addRow("%d", packet) << packet;
}

void TestStrayStamps::goodEvents_areAllKept() {
  QFETCH(int, packet);
  const Events events = steadyEvents(20'000);
  const Filtered result = filtered(events, static_cast<std::size_t>(packet));
  QVERIFY(sameTimes(result.kept, events));
  QCOMPARE(result.strays, std::uint64_t{0});
}

void TestStrayStamps::strayStamps_areDropped_data() {
  QTest::addColumn<QList<qsizetype>>("where");
  QTest::addColumn<qint64>("stamp_ns");
  const QList<qsizetype> middle = {10'000}, last = {19'999}, first = {0},
                         several = {5000, 5003, 9000, 15'000};
  QTest::newRow("20 s ahead") << middle << qint64(kStrayStampsStart_ns + 20 * kSecond_ns);
  QTest::newRow("half a second ahead") << middle << qint64(kStrayStampsStart_ns + kSecond_ns / 2);
  QTest::newRow("a day ahead") << middle << qint64(kStrayStampsStart_ns + kDay_ns);
  QTest::newRow("the last a day ahead") << last << qint64(kStrayStampsStart_ns + kDay_ns);
  QTest::newRow("the first 0") << first << qint64(0);
  QTest::newRow("the first a day ahead") << first << qint64(kStrayStampsStart_ns + kDay_ns);
  QTest::newRow("0 in between") << middle << qint64(0);
  QTest::newRow("several") << several << qint64(kStrayStampsStart_ns + kDay_ns);
}

void TestStrayStamps::strayStamps_areDropped() {
  QFETCH(QList<qsizetype>, where);
  QFETCH(qint64, stamp_ns);
  Events events = steadyEvents(20'000), good = events;
  for (qsizetype k = where.size(); k-- > 0;) {
    events[static_cast<std::size_t>(where[k])].time_ns = stamp_ns;
    good.erase(good.begin() + where[k]);
  }
  for (const std::size_t packet : {std::size_t{1}, std::size_t{512}, events.size()}) {
    const Filtered result = filtered(events, packet);
    QVERIFY(sameTimes(result.kept, good));
    QCOMPARE(result.strays, static_cast<std::uint64_t>(where.size()));
    QCOMPARE(qint64(result.stray_ns), stamp_ns);
    QVERIFY(std::abs(result.from_ns - kStrayStampsStart_ns) < kSecond_ns);
  }
}

void TestStrayStamps::packetWithAWrongStamp_isDropped() {
  Events events = steadyEvents(20'000), good = events;
  for (std::size_t i = 8000; i < 9000; ++i) events[i].time_ns += 20 * kSecond_ns;
  good.erase(good.begin() + 8000, good.begin() + 9000);
  const Filtered result = filtered(events, 1000);
  QVERIFY(sameTimes(result.kept, good));
  QCOMPARE(result.strays, std::uint64_t{1000});
}

// The lens was covered: later events are confirmed by more of the same.
void TestStrayStamps::pause_isNoStray() {
  Events events = steadyEvents(20'000);
  const Events after = steadyEvents(20'000, kStrayStampsStart_ns + 3600 * kSecond_ns);
  events.insert(events.end(), after.begin(), after.end());
  const Filtered result = filtered(events, 700);
  QVERIFY(sameTimes(result.kept, events));
  QCOMPARE(result.strays, std::uint64_t{0});
}

void TestStrayStamps::clockThatGoesBackForGood_isFollowed() {
  Events events = steadyEvents(20'000);
  const Events after = steadyEvents(20'000, kStrayStampsStart_ns - 3600 * kSecond_ns);
  events.insert(events.end(), after.begin(), after.end());
  QVERIFY(sameTimes(filtered(events, 700).kept, events));
}

void TestStrayStamps::fewEvents_countAsTheyAre() {
  const Events events = steadyEvents(5);
  QVERIFY(sameTimes(filtered(events, 2).kept, events));
  QVERIFY(filtered({}, 1).kept.empty());
}

// Three seconds at a limit of 2 million events per second, while the scene would exceed it half of the time;
// then a scene that never reaches it.
void TestStrayStamps::readOutAtItsLimit_isTold() {
  for (const bool limited : {true, false}) {
    ReadOutLoad load;
    for (int ms = 0; ms < 3000; ++ms) {
      const double wanted_per_ms = 2000.0 + 1500.0 * std::sin(0.01 * ms);
      const auto count = static_cast<std::size_t>(limited ? std::min(wanted_per_ms, 2000.0) : wanted_per_ms);
      Events events;
      for (std::size_t i = 0; i < count; ++i)
        events.push_back(
            {kStrayStampsStart_ns + ms * 1'000'000 + static_cast<std::int64_t>(i * 1'000'000 / count), 0, 0,
             true});
      load.add(events);
    }
    QCOMPARE(load.limit().share > 0.0, limited);
    if (!limited) continue;
    QVERIFY(std::abs(load.limit().rate_hz - 2e6) < 0.02e6);
    QVERIFY(std::abs(load.limit().share - 0.5) < 0.1);
  }
}

}  // namespace

EVICAL_TEST(TestStrayStamps)
#include "tst_stray_stamps.moc"
