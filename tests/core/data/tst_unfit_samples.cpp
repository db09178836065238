#include "core/data/second_clock.h"
#include "core/data/unfit_samples.h"

#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace {

using namespace evical;

using Samples = std::vector<ImuSample>;
using Indices = std::vector<std::size_t>;

// Fast rotations at 2 Hz and shakes at 7 Hz, with the noise of a typical sensor.
Samples moved(double rate_hz, std::size_t count = 4000) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.01);
  Samples samples(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i) / rate_hz, turn = 2.0 * std::numbers::pi * t;
    samples[i].time_ns = static_cast<std::int64_t>(1e9 * t);
    for (int axis = 0; axis < 3; ++axis) {
      samples[i].angular_rate_rad_s[axis] =
          3.0 * std::sin(2.0 * turn + axis) + std::sin(7.0 * turn) + noise(random);
      samples[i].specific_force_m_s2[axis] =
          5.0 + 8.0 * std::sin(2.0 * turn + axis) + 4.0 * std::sin(7.0 * turn) + noise(random);
    }
  }
  return samples;
}

std::size_t leftOut(const UnfitSamples& unfit) {
  std::size_t count = unfit.gyroscope_spikes.size() + unfit.accelerometer_spikes.size();
  for (const Indices& along : unfit.saturated) count += along.size();
  return count;
}

class TestUnfitSamples : public QObject {
  Q_OBJECT
 private slots:
  void motion_isNoFault_data();
  void motion_isNoFault();
  void isolatedErrors_areFound();
  void neighbouringErrors_areFound();
  void firstAndLastSample_areLeftToTheBatch();
  void frequentJumps_areTheSensorsWay();
  void gap_isNoJump();
  void saturation_isLeftOutWithItsNeighbours();
  void saturation_ofOnePeak_isFound();
  void extremesOfMotion_areNoLimit();
  void impossibleValues_areNotMeasurable();
  void heldSamples_countOnce_data();
  void heldSamples_countOnce();
  void coarseSensorAtRest_isNotHeld();
  void secondClock_isFound();
};

// A sensor of 62.5 Hz in a stream of 200 Hz: its samples repeat three or four times.
void TestUnfitSamples::heldSamples_countOnce_data() {
  QTest::addColumn<double>("own_hz");
  for (const double own_hz : {62.5, 100.0, 50.0}) QTest::addRow("%g Hz", own_hz) << own_hz;
}

void TestUnfitSamples::heldSamples_countOnce() {
  QFETCH(double, own_hz);
  const Samples fine = moved(200.0);
  Samples held = fine;
  std::size_t own_samples = 0, last = fine.size();
  for (std::size_t i = 0; i < held.size(); ++i) {
    const auto taken =
        static_cast<std::size_t>(std::floor(static_cast<double>(i) * own_hz / 200.0) * 200.0 / own_hz);
    if (taken != last) ++own_samples;
    last = taken;
    held[i].specific_force_m_s2 = fine[taken].specific_force_m_s2;
  }
  const UnfitSamples unfit = findUnfitSamples(held);
  QCOMPARE(unfit.accelerometer_repeats.size(), held.size() - own_samples);
  QVERIFY(unfit.gyroscope_repeats.empty());
  QCOMPARE(leftOut(unfit), std::size_t{0});  // neither limits nor spikes
  const SampleSelection fit = fitSamples(held);
  QCOMPARE(static_cast<std::size_t>(std::count(fit.accelerometer.begin(), fit.accelerometer.end(), 1)),
           own_samples);
  const auto faults = heldFaults("imu", held, unfit);
  QCOMPARE(faults.size(), std::size_t{1});
  QVERIFY2(
      faults[0].text.starts_with("The accelerometer measures at " + std::string(own_hz == 62.5    ? "62.5"
                                                                                : own_hz == 100.0 ? "100.0"
                                                                                                  : "50.0")),
      faults[0].text.c_str());
}

void TestUnfitSamples::coarseSensorAtRest_isNotHeld() {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.3);
  Samples samples(4000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].time_ns = static_cast<std::int64_t>(i) * 5'000'000;
    for (int axis = 0; axis < 3; ++axis) samples[i].specific_force_m_s2[axis] = std::round(noise(random));
  }
  QVERIFY(findUnfitSamples(samples).accelerometer_repeats.empty());
}

void TestUnfitSamples::secondClock_isFound() {
  Samples samples = moved(200.0, 2000);
  QVERIFY(findSecondClocks(samples).empty());
  for (std::size_t i = 800; i < 1200; ++i) samples[i].time_ns *= 2;
  const std::vector<SecondClock> clocks = findSecondClocks(samples);
  QCOMPARE(clocks.size(), std::size_t{1});
  QVERIFY(clocks[0].begin == 800 && clocks[0].end == 1200 && std::abs(clocks[0].rate - 2.0) < 1e-9);
  // A clock that was set back permanently, and lost samples.
  Samples reset = moved(200.0, 2000);
  for (std::size_t i = 1000; i < 2000; ++i) reset[i].time_ns -= 3'000'000'000;
  QVERIFY(findSecondClocks(reset).empty());
  Samples gap = moved(200.0, 2000);
  gap.erase(gap.begin() + 500, gap.begin() + 700);
  QVERIFY(findSecondClocks(gap).empty());
}

void TestUnfitSamples::motion_isNoFault_data() {
  QTest::addColumn<double>("rate_hz");
  for (const double rate_hz : {50.0, 100.0, 200.0, 1000.0}) QTest::addRow("%g Hz", rate_hz) << rate_hz;
}

void TestUnfitSamples::motion_isNoFault() {
  QFETCH(double, rate_hz);
  QCOMPARE(leftOut(findUnfitSamples(moved(rate_hz))), std::size_t{0});
}

void TestUnfitSamples::isolatedErrors_areFound() {
  Samples samples = moved(200.0);
  samples[700].specific_force_m_s2.y() += 3.0;  // less than the motion itself
  samples[1500].angular_rate_rad_s.x() = 30.0;
  samples[3000].angular_rate_rad_s.z() = -4.5;
  samples[3000].specific_force_m_s2.z() = 150.0;
  const UnfitSamples unfit = findUnfitSamples(samples);
  QCOMPARE(unfit.accelerometer_spikes, (Indices{700, 3000}));
  QCOMPARE(unfit.gyroscope_spikes, (Indices{1500, 3000}));
  const SampleSelection fit = fitSamples(samples);
  QVERIFY(fit.gyroscope[700] && !fit.accelerometer[700]);
  QVERIFY(!fit.gyroscope[1500] && fit.accelerometer[1500]);
  QVERIFY(fit.accelerometer[701] && fit.accelerometer[699]);
  QCOMPARE(withoutRateSpikes(samples).size(), samples.size() - 2);
  QCOMPARE(withFitForces(samples)[700].time_ns, samples[701].time_ns);
}

// A good sample or two between them may be removed, too, but nothing further away.
void TestUnfitSamples::neighbouringErrors_areFound() {
  Samples samples = moved(200.0);
  samples[1000].specific_force_m_s2.x() += 50.0;
  samples[1001].specific_force_m_s2.x() += 40.0;
  const SampleSelection fit = fitSamples(samples);
  QVERIFY(!fit.accelerometer[1000] && !fit.accelerometer[1001]);
  for (std::size_t i = 0; i < samples.size(); ++i)
    QVERIFY2(fit.accelerometer[i] || (i > 996 && i < 1005), qPrintable(QString::number(i)));
}

void TestUnfitSamples::firstAndLastSample_areLeftToTheBatch() {
  Samples samples = moved(200.0, 50);
  samples.front().angular_rate_rad_s.x() = 100.0;
  QVERIFY(leftOut(findUnfitSamples(samples)) <= 4);
  QCOMPARE(leftOut(findUnfitSamples(Samples(3))), std::size_t{0});
  QCOMPARE(leftOut(findUnfitSamples(Samples{})), std::size_t{0});
}

// A sensor that repeats each value for ten samples has steps all the time.
void TestUnfitSamples::frequentJumps_areTheSensorsWay() {
  Samples samples = moved(1000.0);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i].specific_force_m_s2 = samples[i - i % 10].specific_force_m_s2;
  QCOMPARE(findUnfitSamples(samples).accelerometer_spikes, Indices{});
}

// Gaps as between the blocks of one half of a recording.
void TestUnfitSamples::gap_isNoJump() {
  Samples samples = moved(200.0);
  for (std::size_t i = samples.size() / 2; i < samples.size(); ++i) samples[i].time_ns += 2'300'000'000;
  samples.erase(samples.begin() + 500, samples.begin() + 1100);
  QCOMPARE(leftOut(findUnfitSamples(samples)), std::size_t{0});
}

void TestUnfitSamples::saturation_isLeftOutWithItsNeighbours() {
  Samples samples = moved(200.0);
  constexpr double kLimit = 2.0;  // rad/s: at half of the motion
  std::vector<bool> clipped;
  for (ImuSample& sample : samples) {
    clipped.push_back(sample.angular_rate_rad_s.x() > kLimit);
    sample.angular_rate_rad_s.x() = std::min(sample.angular_rate_rad_s.x(), kLimit);
  }
  QCOMPARE(findUnfitSamples(samples).gyroscope_spikes, Indices{});
  QCOMPARE(withoutRateSpikes(samples).size(), samples.size());
  const SampleSelection fit = fitSamples(samples);
  for (std::size_t i = 1; i + 1 < samples.size(); ++i) {
    QCOMPARE(fit.gyroscope[i] != 0, !(clipped[i - 1] || clipped[i] || clipped[i + 1]));
    QVERIFY(fit.accelerometer[i]);
  }
}

// Also below the full scale of any sensor.
void TestUnfitSamples::saturation_ofOnePeak_isFound() {
  Samples samples = moved(200.0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = static_cast<double>(i) / 20.0 - 100.0;
    samples[i].angular_rate_rad_s.x() =
        std::min(1.2 * std::exp(-0.01 * t * t) + 1e-4 * std::sin(37.0 * t), 1.0);
  }
  QVERIFY(findUnfitSamples(samples).saturated[0].size() > 100);
}

// With coarse quantisation the largest value appears twice in a row by chance.
void TestUnfitSamples::extremesOfMotion_areNoLimit() {
  Samples samples = moved(200.0);
  for (ImuSample& sample : samples)
    sample.angular_rate_rad_s = (sample.angular_rate_rad_s * 1000.0).array().round() / 1000.0;
  QCOMPARE(leftOut(findUnfitSamples(samples)), std::size_t{0});
}

void TestUnfitSamples::impossibleValues_areNotMeasurable() {
  const ImuSample good{0, {35.0, -35.0, 0.0}, {160.0, 0.0, 0.0}};
  QVERIFY(isMeasurable(good));
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e22, 1e308}) {
    ImuSample rate = good, force = good;
    rate.angular_rate_rad_s.y() = wrong;
    force.specific_force_m_s2.z() = wrong;
    QVERIFY(!isMeasurable(rate));
    QVERIFY(!isMeasurable(force));
  }
}

}  // namespace

EVICAL_TEST(TestUnfitSamples)
#include "tst_unfit_samples.moc"
