#include "core/frontend/edge_crossings.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <random>

namespace {

using namespace evical;

constexpr Resolution kSize_px = {8, 6};
constexpr std::int64_t kMs = 1'000'000;

std::vector<Event> eventsAt(int x_px, int y_px, bool brighter, const std::vector<std::int64_t>& times_ns) {
  std::vector<Event> events;
  for (const std::int64_t time_ns : times_ns)
    events.push_back({time_ns, static_cast<std::uint16_t>(x_px), static_cast<std::uint16_t>(y_px), brighter});
  return events;
}

std::vector<EdgeCrossing> allBursts(const std::vector<Event>& events, const BurstOptions& options = {}) {
  BurstExtractor extractor(kSize_px, options);
  std::vector<EdgeCrossing> bursts;
  extractor.add(events, bursts);
  extractor.finish(bursts);
  return bursts;
}

class TestEdgeBursts : public QObject {
  Q_OBJECT
 private slots:
  void time_isMedianOfEvents();
  void otherPolarity_endsBurst();
  void pause_endsBurst_data();
  void pause_endsBurst();
  void singleEvents_areDropped();
  void longBurst_keepsMedianAndCount();
  void steadyFlicker_isCut();
  void silentPixel_isHandedOutWithoutNewEvents();
  void completeUntil_isKept();
  void packets_doNotMatter();
};

void TestEdgeBursts::time_isMedianOfEvents() {
  const std::vector<EdgeCrossing> odd = allBursts(eventsAt(3, 2, true, {100, 200, 900}));
  QCOMPARE(odd.size(), 1u);
  QCOMPARE(odd[0].time_ns, 200);
  QCOMPARE(odd[0].duration_ns, 800);
  QCOMPARE(odd[0].x_px, 3);
  QCOMPARE(odd[0].y_px, 2);
  QCOMPARE(odd[0].events, 3);
  QVERIFY(odd[0].brighter);
  const std::vector<EdgeCrossing> even = allBursts(eventsAt(3, 2, false, {100, 200, 400, 900}));
  QCOMPARE(even[0].time_ns, 300);
  QVERIFY(!even[0].brighter);
}

void TestEdgeBursts::otherPolarity_endsBurst() {
  std::vector<Event> events = eventsAt(1, 1, true, {0, kMs, 2 * kMs});
  for (const Event& event : eventsAt(1, 1, false, {3 * kMs, 4 * kMs})) events.push_back(event);
  const std::vector<EdgeCrossing> bursts = allBursts(events);
  QCOMPARE(bursts.size(), 2u);
  QCOMPARE(bursts[0].time_ns, kMs);
  QVERIFY(bursts[0].brighter);
  QCOMPARE(bursts[1].time_ns, 3 * kMs + kMs / 2);
}

void TestEdgeBursts::pause_endsBurst_data() {
  QTest::addColumn<double>("pace_ms");
  QTest::addColumn<double>("pause_ms");
  QTest::addColumn<int>("bursts");
  const BurstOptions options;
  const double longest_ms = 1e3 * options.max_gap_s, shortest_ms = 1e3 * options.min_gap_s;
  QTest::newRow("longer than any") << 15.0 << 1.1 * longest_ms << 2;
  QTest::newRow("slow edge, ordinary pause") << 30.0 << 0.9 * longest_ms << 1;
  QTest::newRow("fast edge, long for its pace") << 1.0 << 1.5 * options.gap_to_pace << 2;
  QTest::newRow("fast edge, not long for its pace") << 1.0 << 0.8 * options.gap_to_pace << 1;
  QTest::newRow("shorter than any that ends") << 0.1 << 0.9 * shortest_ms << 1;
}

void TestEdgeBursts::pause_endsBurst() {
  QFETCH(double, pace_ms);
  QFETCH(double, pause_ms);
  const auto pace_ns = static_cast<std::int64_t>(pace_ms * kMs),
             pause_ns = static_cast<std::int64_t>(pause_ms * kMs);
  std::vector<std::int64_t> times_ns = {0, pace_ns, 2 * pace_ns};
  for (int k = 0; k < 3; ++k) times_ns.push_back(2 * pace_ns + pause_ns + k * pace_ns);
  QTEST(static_cast<int>(allBursts(eventsAt(0, 0, true, times_ns)).size()), "bursts");
}

void TestEdgeBursts::singleEvents_areDropped() {
  BurstOptions options;
  options.min_events = 3;
  QVERIFY(allBursts(eventsAt(0, 0, true, {0, kMs}), options).empty());
  QCOMPARE(allBursts(eventsAt(0, 0, true, {0, kMs, 2 * kMs}), options).size(), 1u);
}

void TestEdgeBursts::longBurst_keepsMedianAndCount() {
  // More events than a pixel stores times of: thinning keeps 8 to 16, so the median is accurate to 1/8.
  for (const int count : {16, 17, 33, 100, 700}) {
    std::vector<std::int64_t> times_ns;
    for (int k = 0; k < count; ++k) times_ns.push_back(k * kMs / 10);
    const std::vector<EdgeCrossing> bursts = allBursts(eventsAt(7, 5, true, times_ns));
    QCOMPARE(bursts.size(), 1u);
    QCOMPARE(static_cast<int>(bursts[0].events), count);
    const auto middle_ns = static_cast<double>(times_ns.back()) / 2.0;
    QVERIFY2(std::abs(static_cast<double>(bursts[0].time_ns) - middle_ns) <= middle_ns / 8.0,
             qPrintable(QString::number(count)));
    QCOMPARE(static_cast<std::int64_t>(bursts[0].duration_ns), times_ns.back());
  }
}

void TestEdgeBursts::steadyFlicker_isCut() {
  std::vector<std::int64_t> times_ns;
  for (int k = 0; k < 1000; ++k) times_ns.push_back(k * kMs);
  const BurstOptions options;
  for (const EdgeCrossing& burst : allBursts(eventsAt(0, 0, true, times_ns)))
    QVERIFY(burst.duration_ns <= static_cast<std::int64_t>(options.max_burst_s * 1e9));
}

void TestEdgeBursts::silentPixel_isHandedOutWithoutNewEvents() {
  BurstExtractor extractor(kSize_px, BurstOptions{});
  std::vector<EdgeCrossing> bursts;
  extractor.add(eventsAt(0, 0, true, {0, kMs, 2 * kMs}), bursts);
  QVERIFY(bursts.empty());
  for (int k = 1; k <= 30; ++k) extractor.add(eventsAt(5, 5, k % 2, {k * 10 * kMs}), bursts);
  QCOMPARE(bursts.size(), 1u);
  QCOMPARE(bursts[0].time_ns, kMs);
}

// Events in time order at random pixels, in clumps.
std::vector<Event> randomEvents(int count, std::mt19937& random) {
  std::uniform_int_distribution<int> x(0, kSize_px.width_px - 1), y(0, kSize_px.height_px - 1), bit(0, 9);
  std::exponential_distribution<double> wait(1.0 / 20e3);
  std::vector<Event> events;
  double time_ns = 0.0;
  for (int i = 0; i < count; ++i) {
    const double wait_ns = wait(random);
    time_ns += wait_ns * (bit(random) == 0 ? 30.0 : 1.0);
    events.push_back({static_cast<std::int64_t>(time_ns), static_cast<std::uint16_t>(x(random)),
                      static_cast<std::uint16_t>(y(random)), bit(random) < 8});
  }
  return events;
}

void TestEdgeBursts::completeUntil_isKept() {
  std::mt19937 random(1);
  const std::vector<Event> events = randomEvents(40000, random);
  BurstExtractor extractor(kSize_px, BurstOptions{});
  std::vector<EdgeCrossing> bursts;
  std::int64_t promised_ns = extractor.completeUntil_ns();
  for (std::size_t i = 0; i < events.size(); i += 100) {
    bursts.clear();
    extractor.add(EventSpan(events.data() + i, 100), bursts);
    for (const EdgeCrossing& burst : bursts) QVERIFY(burst.time_ns >= promised_ns);
    QVERIFY(extractor.completeUntil_ns() >= promised_ns);
    promised_ns = extractor.completeUntil_ns();
  }
  bursts.clear();
  extractor.finish(bursts);
  for (const EdgeCrossing& burst : bursts) QVERIFY(burst.time_ns >= promised_ns);
  QCOMPARE(extractor.eventCount(), static_cast<std::uint64_t>(events.size()));
}

void TestEdgeBursts::packets_doNotMatter() {
  std::mt19937 random(2);
  const std::vector<Event> events = randomEvents(20000, random);
  const auto sorted = [](std::vector<EdgeCrossing> bursts) {
    std::sort(bursts.begin(), bursts.end(), [](const EdgeCrossing& a, const EdgeCrossing& b) {
      return std::tie(a.time_ns, a.x_px, a.y_px, a.brighter) <
             std::tie(b.time_ns, b.x_px, b.y_px, b.brighter);
    });
    return bursts;
  };
  const std::vector<EdgeCrossing> whole = sorted(allBursts(events));
  BurstExtractor extractor(kSize_px, BurstOptions{});
  std::vector<EdgeCrossing> parts;
  for (std::size_t i = 0; i < events.size(); i += 7)
    extractor.add(EventSpan(events.data() + i, std::min<std::size_t>(7, events.size() - i)), parts);
  extractor.finish(parts);
  parts = sorted(parts);
  QCOMPARE(parts.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i) QCOMPARE(parts[i].time_ns, whole[i].time_ns);
}

}  // namespace

EVICAL_TEST(TestEdgeBursts)
#include "tst_edge_crossings.moc"
