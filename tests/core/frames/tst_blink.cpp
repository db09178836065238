// A blinking light: detected by its rhythm, split into half periods, distinguished from weak flicker.
#include "core/frames/blink.h"
#include "core/frames/flash_gathering.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace {

using namespace evical;

constexpr Resolution kSize{40, 30};

// Brightening and darkening bursts of 3 ms that begin half a period apart, in bins of 1 ms.
std::vector<float> bursts(double rate_hz, double duration_s, double noise) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal(0.0f, static_cast<float>(noise));
  std::vector<float> balance;
  for (double t = 0.0; t < duration_s; t += 1e-3) {
    const double phase_s = std::fmod(t, 1.0 / rate_hz), half_s = 0.5 / rate_hz;
    const double within_s = phase_s < half_s ? phase_s : phase_s - half_s;
    const float height = within_s < std::min(3e-3, half_s) ? 1.0f : 0.0f;
    balance.push_back((phase_s < half_s ? height : -height) + normal(random));
  }
  return balance;
}

// Pixels left of `columns` brighten and darken alternately, the others fire occasionally.
std::vector<Event> blinkingScene(int columns, double rate_hz, double duration_s, double background_hz) {
  std::mt19937 random(2);
  std::vector<Event> events;
  std::uniform_real_distribution<double> jitter_s(0.0, 2e-3);
  for (int half = 0; half < static_cast<int>(2.0 * rate_hz * duration_s); ++half)
    for (int y = 0; y < kSize.height_px; ++y)
      for (int x = 0; x < columns; ++x)
        for (int n = 0; n < 2; ++n)
          events.push_back({static_cast<std::int64_t>(1e9 * (0.5 * half / rate_hz + jitter_s(random))),
                            static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), half % 2 == 0});
  std::uniform_real_distribution<double> place(0.0, 1.0);
  for (int n = 0; n < background_hz * duration_s; ++n)
    events.push_back({static_cast<std::int64_t>(1e9 * duration_s * place(random)),
                      static_cast<std::uint16_t>(place(random) * kSize.width_px),
                      static_cast<std::uint16_t>(place(random) * kSize.height_px), place(random) < 0.5});
  std::sort(events.begin(), events.end(),
            [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; });
  return events;
}

class TestBlink : public QObject {
  Q_OBJECT
 private slots:
  void rhythm_isFoundInNoise_data();
  void rhythm_isFoundInNoise();
  void noiseAndSlowChanges_haveNoRhythm();
  void share_isThatOfTheEventsInBlinkingPixels();
  void blink_isNoticedWhereItBegins();
  void blinkOfMorePixelsThanCanBeKept_isNoticedByAPartOfThem();
  void lampThatMakesFewEvents_isNotNoticed();
  void halfPeriods_beginWithTheirBursts_data();
  void halfPeriods_beginWithTheirBursts();
};

void TestBlink::rhythm_isFoundInNoise_data() {
  QTest::addColumn<double>("rate_hz");
  QTest::newRow("5 Hz") << 5.0;
  QTest::newRow("15 Hz") << 15.0;
  QTest::newRow("30 Hz") << 30.0;
  QTest::newRow("72 Hz") << 72.0;
  QTest::newRow("200 Hz") << 200.0;
  QTest::newRow("500 Hz") << 500.0;
}

void TestBlink::rhythm_isFoundInNoise() {
  QFETCH(const double, rate_hz);
  const std::optional<Blink> blink = findBlink(bursts(rate_hz, 1.0, 0.1), BlinkOptions{});
  QVERIFY(blink);
  // A bin is 1 ms; the parabola locates the top of a narrow peak to some tenths of a bin.
  QVERIFY2(std::abs(blink->period_s - 1.0 / rate_hz) < 4e-4, QByteArray::number(1.0 / blink->period_s));
  QVERIFY(blink->peak > BlinkOptions{}.min_peak);
}

void TestBlink::noiseAndSlowChanges_haveNoRhythm() {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  std::vector<float> noise(1000), walk(1000);
  for (float& value : noise) value = normal(random);
  std::partial_sum(noise.begin(), noise.end(), walk.begin());
  for (const auto& signal : {noise, walk}) {
    const std::optional<Blink> blink = findBlink(signal, BlinkOptions{});
    QVERIFY(!blink || blink->peak < BlinkOptions{}.min_peak);
  }
  QVERIFY(!findBlink({}, BlinkOptions{}));
}

void TestBlink::share_isThatOfTheEventsInBlinkingPixels() {
  const std::vector<Event> events = blinkingScene(10, 30.0, 1.0, 36000.0);  // half of the events
  const double share = shareOfBlinkingPixels(events, kSize, 1.0 / 30.0);
  // A quarter of the others are on blinking pixels.
  QVERIFY2(std::abs(share - 0.625) < 0.03, QByteArray::number(share));
  QCOMPARE(shareOfBlinkingPixels({}, kSize, 1.0 / 30.0), 0.0);
  QVERIFY(shareOfBlinkingPixels(blinkingScene(0, 30.0, 1.0, 36000.0), kSize, 1.0 / 30.0) < 0.01);
}

void TestBlink::blink_isNoticedWhereItBegins() {
  std::vector<Event> events = blinkingScene(0, 30.0, 5.0, 2000.0);
  for (Event event : blinkingScene(20, 30.0, 1.0, 0.0)) {
    event.time_ns += 5'000'000'000;
    events.push_back(event);
  }
  BlinkNotice notice(kSize, BlinkOptions{});
  std::size_t fed = 0;
  for (; fed < events.size() && !notice.blink(); fed += 500)
    notice.add(EventSpan(events).subspan(fed, std::min<std::size_t>(500, events.size() - fed)));
  if (!notice.blink()) notice.finish();
  QVERIFY(notice.blink());
  QVERIFY(std::abs(1.0 / notice.blink()->period_s - 30.0) < 0.5);
  const std::vector<Event> kept = notice.takeEvents();
  QVERIFY(!kept.empty());
  QVERIFY(std::is_sorted(kept.begin(), kept.end(),
                         [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; }));
  QVERIFY(kept.back().time_ns > 5'000'000'000);
}

void TestBlink::blinkOfMorePixelsThanCanBeKept_isNoticedByAPartOfThem() {
  BlinkNotice notice(kSize, BlinkOptions{}, 3000);  // a period makes 2400 events
  notice.add(blinkingScene(20, 30.0, 1.0, 2000.0));
  notice.finish();
  QVERIFY(notice.blink());
  QVERIFY2(std::abs(notice.blink()->share - 0.97) < 0.03, QByteArray::number(notice.blink()->share));
  QVERIFY(notice.takeEvents().empty());  // they would make pictures with gaps
}

void TestBlink::lampThatMakesFewEvents_isNotNoticed() {
  BlinkNotice notice(kSize, BlinkOptions{});
  notice.add(blinkingScene(1, 100.0, 1.0, 60000.0));  // 6000 of 66000 events
  notice.finish();
  QVERIFY(!notice.blink());
  QVERIFY(notice.clearest().share < BlinkOptions{}.min_share);
}

void TestBlink::halfPeriods_beginWithTheirBursts_data() {
  QTest::addColumn<int>("length");  // of a burst, in bins
  QTest::newRow("short bursts") << 2;
  QTest::newRow("until the light turns") << 8;
}

void TestBlink::halfPeriods_beginWithTheirBursts() {
  QFETCH(const int, length);
  HalfPeriods halves;
  int turns = 0;
  for (int bin = 0; bin < 20 * HalfPeriods::kBinsPerPeriod; ++bin) {
    const int within = bin % (HalfPeriods::kBinsPerPeriod / 2);
    const bool brightens = bin / (HalfPeriods::kBinsPerPeriod / 2) % 2 == 0;
    if (!halves.add(within < length ? (brightens ? 100.0 : -100.0) : 1.0)) continue;
    ++turns;
    // The bin at which the new half period begins must not be later than the burst's beginning.
    const int begin = bin + 1 - HalfPeriods::kTurn_bins;
    const int nearest = (begin + 4) / 8 * 8;
    QVERIFY2(begin <= nearest && nearest - begin <= 2, QByteArray::number(begin - nearest));
  }
  QCOMPARE(turns, 39);
}

}  // namespace

EVICAL_TEST(TestBlink)
#include "tst_blink.moc"
