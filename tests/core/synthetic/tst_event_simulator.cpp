#include "core/base/error.h"
#include "core/synthetic/board_truth.h"
#include "core/synthetic/event_simulator.h"
#include "tests/core/synthetic/scenarios.h"
#include "tests/support/test_program.h"

#include <map>
#include <numbers>

using namespace evical;

namespace {

std::vector<Event> eventsOf(const Scenario& scenario, int threads = 2) {
  std::vector<Event> events;
  simulateEvents(
      scenario, 0, [&](EventSpan span) { events.insert(events.end(), span.begin(), span.end()); }, {},
      threads);
  return events;
}

bool same(const std::vector<Event>& a, const std::vector<Event>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Event& x, const Event& y) {
    return x.time_ns == y.time_ns && x.x_px == y.x_px && x.y_px == y.y_px && x.brighter == y.brighter;
  });
}

// The board moves sideways: one slow sinusoid, about 100 px/s in the middle of its period.
Scenario slidingScenario(double blur_px, double threshold) {
  Scenario scenario = test::stillScenario();
  scenario.motion.target_amplitude_m = {0.1, 0.0};
  scenario.motion.sinusoids = 1;
  scenario.motion.lowest_frequency_hz = scenario.motion.highest_frequency_hz = 0.4;
  scenario.duration_s = 1.25;
  EventPixelModel& pixel = scenario.cameras[0].pixel;
  pixel.blur_px = blur_px;
  pixel.threshold_on = pixel.threshold_off = threshold;
  return scenario;
}

// Mean lead of the bursts relative to the true edge, in px along the motion (docs/maths.md, 4), and the
// number of events per burst.
struct Leads {
  double first = 0.0, mean = 0.0, last = 0.0, count = 0.0, speed_px_s = 0.0;
  int bursts = 0;
};

// Bursts of pixels that the edge of a circle crosses along its normal, leading and trailing edges alike.
Leads leadsOf(const Scenario& scenario) {
  const SinusoidMotion motion(scenario);
  std::map<std::pair<int, bool>, std::vector<double>> trains;  // by pixel and polarity
  const int width = scenario.cameras[0].intrinsics.resolution_px.width_px;
  for (const Event& event : eventsOf(scenario))
    trains[{event.y_px * width + event.x_px, event.brighter}].push_back(
        static_cast<double>(event.time_ns - scenario.start_ns) * 1e-9);
  // Near the middle of the period, where the speed hardly changes during an edge's passage.
  const double px_per_m = 200.0 / scenario.motion.distance_m;
  const double slowest_px_s = 0.85 * px_per_m * scenario.motion.target_amplitude_m.x() * 2.0 *
                              std::numbers::pi * scenario.motion.lowest_frequency_hz;
  const double radius_px = px_per_m * scenario.board.radius_m;
  Leads sums[2];
  for (const auto& [key, times] : trains) {
    const Eigen::Vector2d pixel(key.first % width, key.first / width);
    for (std::size_t begin = 0, end; begin < times.size(); begin = end) {
      for (end = begin + 1; end < times.size() && times[end] - times[end - 1] < 0.03;) ++end;
      const double middle = 0.5 * (times[begin] + times[end - 1]);
      for (const TrueCircle& circle : trueBoardView(motion, scenario, 0, middle)) {
        const double speed = circle.velocity_px_s.x();
        const Eigen::Vector2d away = pixel - circle.centre_px;
        if (std::abs(speed) < slowest_px_s || std::abs(away.y()) > 1.5 ||
            std::abs(away.norm() - radius_px) > 3.0)
          continue;
        const bool leading = away.x() * speed > 0.0;
        if (leading == key.second) continue;  // a dark circle: OFF leads
        // The edge reaches the pixel when this becomes zero.
        const double edge_x =
            std::sqrt(radius_px * radius_px - away.y() * away.y()) * (away.x() > 0.0 ? 1.0 : -1.0);
        const double lag_s = (away.x() - edge_x) / speed;
        Leads& sum = sums[leading ? 1 : 0];
        double mean = 0.0;
        for (std::size_t i = begin; i < end; ++i) mean += times[i] / static_cast<double>(end - begin);
        const auto lead = [&](double t) { return (middle + lag_s - t) * std::abs(speed); };
        sum.first += lead(times[begin]);
        sum.mean += lead(mean);
        sum.last += lead(times[end - 1]);
        sum.count += static_cast<double>(end - begin);
        ++sum.bursts;
      }
    }
  }
  Leads result;
  for (const Leads& s : sums) {
    if (s.bursts < 20) return {};
    result.first += 0.5 * s.first / s.bursts;
    result.mean += 0.5 * s.mean / s.bursts;
    result.last += 0.5 * s.last / s.bursts;
    result.count += 0.5 * s.count / s.bursts;
    result.bursts += s.bursts;
  }
  return result;
}

}  // namespace

class TestEventSimulator : public QObject {
  Q_OBJECT
 private slots:
  void edges_leadAsComputed_data() {
    QTest::addColumn<double>("blur_px");
    QTest::addColumn<double>("threshold");
    QTest::addColumn<double>("first");
    QTest::addColumn<double>("mean");
    QTest::addColumn<double>("last");
    // Method 4.1, for a straight edge.
    QTest::newRow("0.4, 0.3") << 0.4 << 0.3 << 0.61 << -0.05 << -0.76;
    QTest::newRow("0.6, 0.15") << 0.6 << 0.15 << 1.08 << -0.08 << -1.58;
    QTest::newRow("0.6, 0.3") << 0.6 << 0.3 << 0.83 << -0.06 << -1.03;
    QTest::newRow("0.6, 0.5") << 0.6 << 0.5 << 0.60 << -0.23 << -1.29;
    QTest::newRow("1.0, 0.3") << 1.0 << 0.3 << 1.29 << -0.10 << -1.60;
  }
  void edges_leadAsComputed() {
    QFETCH(double, blur_px);
    QFETCH(double, threshold);
    QFETCH(double, first);
    QFETCH(double, mean);
    QFETCH(double, last);
    const Leads leads = leadsOf(slidingScenario(blur_px, threshold));
    const QString said = QString("first %1 mean %2 last %3, %4 events, %5 bursts")
                             .arg(leads.first)
                             .arg(leads.mean)
                             .arg(leads.last)
                             .arg(leads.count)
                             .arg(leads.bursts);
    qInfo("%s", qPrintable(said));
    QVERIFY2(leads.bursts > 100, qPrintable(said));
    // The table is for pixels whose reference is exactly the bright level. Here the previous edge has left it
    // up to a threshold away, so that first events are later, and fewer.
    QVERIFY2(std::abs(leads.first - first) < 0.2, qPrintable(said));
    QVERIFY2(std::abs(leads.mean - mean) < 0.13, qPrintable(said));
    QVERIFY2(std::abs(leads.last - last) < 0.32, qPrintable(said));
    const double contrast = std::log(scenarioContrast());
    QVERIFY2(std::abs(leads.count - (contrast / threshold - 0.5)) < 0.1 * contrast / threshold + 0.3,
             qPrintable(said));
  }
  void edges_areLateByTheStatedDelay() {
    Scenario scenario = slidingScenario(0.6, 0.3);
    EventPixelModel& pixel = scenario.cameras[0].pixel;
    pixel.latency_s = pixel.low_pass_s = 0.0;
    const Leads prompt = leadsOf(scenario);
    pixel.latency_s = 1e-3;
    pixel.low_pass_s = 2e-3;
    const Leads slow = leadsOf(scenario);  // compared with a truth that includes the 3 ms
    QVERIFY2(std::abs(slow.mean - prompt.mean) < 0.03, qPrintable(QString::number(slow.mean - prompt.mean)));
  }
  // Pixels are slow in the dark, and slower for darkening: leading and trailing edges of dark circles move
  // apart, but the mean of both remains delayed by the time constant.
  void unevenPixels_areLateByTheSameOnTheWhole() {
    Scenario scenario = slidingScenario(0.6, 0.3);
    EventPixelModel& pixel = scenario.cameras[0].pixel;
    pixel.latency_s = 0.0;
    pixel.low_pass_s = 1e-3;
    const Leads even = leadsOf(scenario);
    pixel.low_pass_polarity = 0.5;
    const Leads uneven = leadsOf(scenario);
    const QString said = QString("%1 and %2 px").arg(even.mean).arg(uneven.mean);
    QVERIFY2(std::abs(uneven.mean - even.mean) < 0.03, qPrintable(said));
    const std::vector<Event> uneven_events = eventsOf(scenario);
    pixel.low_pass_polarity = 0.0;
    QVERIFY(!same(uneven_events, eventsOf(scenario)));
    pixel.low_pass_light_power = 0.5;
    const Leads by_light = leadsOf(scenario);
    QVERIFY2(std::abs(by_light.mean - even.mean) < 0.06, qPrintable(QString::number(by_light.mean)));
  }
  void leak_firesBrighteningWhereNothingChanges() {
    Scenario scenario = test::stillScenario();
    scenario.cameras[0].pixel.leak_rate_hz = 2.0;
    scenario.duration_s = 3.0;
    const std::vector<Event> events = eventsOf(scenario);
    // Initially references deviate by up to two thresholds, which decays within a second.
    const auto late = std::count_if(events.begin(), events.end(), [&](const Event& e) {
      return e.time_ns > scenario.start_ns + 1'000'000'000;
    });
    QVERIFY(std::abs(static_cast<double>(late) / (2.0 * 128 * 96 * 2.0) - 1.0) < 0.02);
    QVERIFY(std::all_of(events.begin(), events.end(), [](const Event& e) { return e.brighter; }));
  }
  // Strong enough for one threshold up and one down per period, in pixels whose reference is not in the
  // middle.
  void lamp_flickersInTime() {
    Scenario scenario = test::stillScenario();
    scenario.scene.lamp_flicker = 0.25;  // 0.51 of log intensity from top to bottom, thresholds are 0.3
    scenario.cameras[0].pixel.low_pass_s = 0.0;
    const std::vector<Event> events = eventsOf(scenario);
    const double per_period = static_cast<double>(events.size()) / (128 * 96 * 100.0 * scenario.duration_s);
    QVERIFY2(per_period > 1.2 && per_period < 2.0, qPrintable(QString::number(per_period)));
  }
  void thresholdNoise_changesEventsOfOnePixel() {
    Scenario scenario = slidingScenario(0.6, 0.3);
    const std::vector<Event> steady = eventsOf(scenario);
    scenario.cameras[0].pixel.threshold_noise = 0.05;
    const std::vector<Event> noisy = eventsOf(scenario);
    QVERIFY(!same(steady, noisy));
    QVERIFY(std::abs(static_cast<double>(noisy.size()) / static_cast<double>(steady.size()) - 1.0) < 0.05);
  }
  // No more than the limit in any interval, in order, and none later than the longest wait.
  // After each event the level moves on by the reset's length times the slope, which no further event
  // reports.
  void reset_costsEventsOfFastEdges() {
    const auto countOf = [](double frequency_hz, double reset_s) {
      Scenario scenario = slidingScenario(0.6, 0.2);
      scenario.motion.lowest_frequency_hz = scenario.motion.highest_frequency_hz = frequency_hz;
      scenario.duration_s = 0.5 / frequency_hz;
      scenario.cameras[0].pixel.reset_s = reset_s;
      return leadsOf(scenario).count;
    };
    constexpr double kReset_s = 5e-4;
    const double fast = countOf(0.8, kReset_s) / countOf(0.8, 0.0),
                 slow = countOf(0.1, kReset_s) / countOf(0.1, 0.0);
    QVERIFY2(fast < 0.8, qPrintable(QString::number(fast)));
    QVERIFY2(slow > 0.9 && slow < 1.01, qPrintable(QString::number(slow)));
  }

  void arbiter_letsThroughOneByOne() {
    Scenario scenario = test::wavedScenario();
    scenario.duration_s = 0.3;
    const std::vector<Event> free = eventsOf(scenario);
    EventPixelModel& pixel = scenario.cameras[0].pixel;
    pixel.readout_rate_hz = 0.5 * static_cast<double>(free.size()) / scenario.duration_s;
    pixel.longest_wait_s = 1e-3;
    const std::vector<Event> queued = eventsOf(scenario);
    QVERIFY(queued.size() < free.size());
    QVERIFY(static_cast<double>(queued.size()) < 0.51 * static_cast<double>(free.size()));
    QVERIFY(std::is_sorted(queued.begin(), queued.end(),
                           [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; }));
  }
  // Compared with a truth that includes the delay, a burst's mean has the same error in pixels at every
  // speed.
  void edges_leadAlikeAtEverySpeed() {
    Scenario scenario = slidingScenario(1.0, 0.3);
    scenario.duration_s = 5.0;
    const Leads slow = leadsOf(scenario);
    // 300 px/s. Equally many periods, because a pixel's reference depends on the previous edges.
    scenario.motion.lowest_frequency_hz = scenario.motion.highest_frequency_hz = 1.2;
    scenario.duration_s = 5.0 / 3.0;
    const Leads fast = leadsOf(scenario);
    const QString said = QString("mean %1 px slow, %2 px fast").arg(slow.mean).arg(fast.mean);
    qInfo("%s", qPrintable(said));
    QVERIFY2(std::abs(fast.mean - slow.mean) < 0.02, qPrintable(said));  // 0.1 ms between 100 and 300 px/s
  }
  // A static board with nothing else moving in front of it: only appearing and disappearing objects cause
  // events.
  void handsAndPeople_fireWhereNothingElseMoves() {
    Scenario scenario = test::stillScenario();
    scenario.duration_s = 2.4;
    QVERIFY(eventsOf(scenario).empty());
    scenario.scene.hand = {.every_s = 2.4, .stay_s = 0.5};
    const std::vector<Event> hand = eventsOf(scenario);
    QVERIFY2(hand.size() > 3000, qPrintable(QString::number(hand.size())));
    scenario.scene.hand.shadow = 0.0;
    const std::vector<Event> unshaded = eventsOf(scenario);
    QVERIFY(unshaded.size() < hand.size());
    scenario.scene.hand = {};
    scenario.scene.people = {.every_s = 1.0, .distance_m = 0.2};
    const std::vector<Event> people = eventsOf(scenario);
    QVERIFY2(people.size() > 300, qPrintable(QString::number(people.size())));
    QVERIFY(same(people, eventsOf(scenario, 3)));
    // Behind the board, which hides their middle.
    QVERIFY(std::none_of(people.begin(), people.end(), [](const Event& e) {
      return std::abs(e.x_px - 63) < 20 && std::abs(e.y_px - 47) < 20;
    }));
  }
  // The lamp's reflection on a board that moves sideways stays at its place in the image, and hides ink.
  void gloss_addsLightWhereTheLampIsMirrored() {
    Scenario scenario = slidingScenario(0.6, 0.3);
    const auto eventsNear = [&](int x, int y) {
      const std::vector<Event> events = eventsOf(scenario);
      return static_cast<double>(std::count_if(events.begin(), events.end(), [&](const Event& e) {
        return std::abs(e.x_px - x) < 8 && std::abs(e.y_px - y) < 8;
      }));
    };
    const auto matt = eventsNear(63, 47), matt_aside = eventsNear(63, 80);
    scenario.scene.gloss.strength = 3.0;
    // Mirrored about the image centre if it is behind the camera.
    scenario.scene.lamp_m = {0.0, 0.0, -1.5};
    const auto glossy = eventsNear(63, 47), glossy_aside = eventsNear(63, 80);
    const QString said = QString("%1 %2 %3 %4").arg(matt).arg(glossy).arg(matt_aside).arg(glossy_aside);
    QVERIFY2(matt > 100 && glossy < 0.6 * matt, qPrintable(said));
    QVERIFY2(glossy_aside == matt_aside, qPrintable(said));
  }
  void seed_decidesEverything() {
    Scenario scenario = test::wavedScenario();
    scenario.duration_s = 0.2;
    scenario.cameras[0].pixel.background_rate_hz = 5.0;
    scenario.cameras[0].pixel.hot_pixels = 3;
    scenario.cameras[0].pixel.threshold_mismatch = 0.05;
    const std::vector<Event> events = eventsOf(scenario);
    QVERIFY(events.size() > 1000);
    QVERIFY(same(events, eventsOf(scenario)));
    scenario.seed += 1;
    QVERIFY(!same(events, eventsOf(scenario)));
  }
  void threads_changeNothing() {
    Scenario scenario = test::wavedScenario();
    scenario.duration_s = 0.2;
    scenario.cameras[0].pixel.background_rate_hz = 5.0;
    scenario.cameras[0].pixel.stamp_jitter_s = 1e-3;
    const std::vector<Event> one = eventsOf(scenario, 1);
    QVERIFY(same(one, eventsOf(scenario, 2)));
    QVERIFY(same(one, eventsOf(scenario, 3)));
  }
  void stamps_areOrderedMicrosecondsOnTheCamerasClock() {
    Scenario scenario = test::wavedScenario();
    scenario.duration_s = 0.3;
    scenario.cameras[0].time_offset_s = 0.4;
    scenario.cameras[0].pixel.stamp_jitter_s = 1e-3;  // moves events across packets
    const std::vector<Event> events = eventsOf(scenario);
    QVERIFY(std::is_sorted(events.begin(), events.end(),
                           [](const Event& a, const Event& b) { return a.time_ns < b.time_ns; }));
    QVERIFY(events.front().time_ns >= scenario.start_ns - 400'000'000);
    QVERIFY(events.back().time_ns < scenario.start_ns - 90'000'000);
    QVERIFY(std::all_of(events.begin(), events.end(), [](const Event& e) { return e.time_ns % 1000 == 0; }));
  }
  void stillScene_firesOnlyNoise() {
    Scenario scenario = test::stillScenario();
    QVERIFY(eventsOf(scenario).empty());
    scenario.cameras[0].pixel.background_rate_hz = 2.0;
    const double expected = 2.0 * 128 * 96;
    const auto count = static_cast<double>(eventsOf(scenario).size());
    QVERIFY(std::abs(count - expected) < 5.0 * std::sqrt(expected));
    scenario.cameras[0].pixel.background_rate_hz = 0.0;
    scenario.cameras[0].pixel.hot_pixels = 2;
    scenario.cameras[0].pixel.hot_pixel_rate_hz = 1000.0;
    const std::vector<Event> hot = eventsOf(scenario);
    QVERIFY(std::abs(static_cast<double>(hot.size()) - 2000.0) < 250.0);
  }
  void brightCircles_swapPolarities() {
    Scenario scenario = slidingScenario(0.6, 0.3);
    scenario.board.circles = CircleShade::Bright;
    const Leads leads = leadsOf(scenario);  // expects OFF to lead
    QVERIFY(leads.bursts == 0);
  }
  void stop_cancels() {
    std::stop_source stop;
    int packets = 0;
    const Scenario scenario = test::wavedScenario();
    const auto count = [&](EventSpan) {
      if (++packets == 3) stop.request_stop();
    };
    bool cancelled = false;
    try {
      simulateEvents(scenario, 0, count, {silentProgress(), stop.get_token()});
    } catch (const Cancelled&) {
      cancelled = true;
    }
    QVERIFY(cancelled);
    QCOMPARE(packets, 3);
  }

 private:
  static double scenarioContrast() { return SceneModel{}.bright_reflectance / SceneModel{}.dark_reflectance; }
};

EVICAL_TEST(TestEventSimulator)
#include "tst_event_simulator.moc"
