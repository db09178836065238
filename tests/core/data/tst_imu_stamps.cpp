#include "core/data/imu_stamps.h"

#include "core/base/time.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>

namespace {

using namespace evical;

using Samples = std::vector<ImuSample>;
using Stamp = std::function<double(double time_s)>;

Stamp rounded(double step_s) {
  return [step_s](double time_s) { return std::round(time_s / step_s) * step_s; };
}
Stamp down(double step_s) {
  return [step_s](double time_s) { return std::floor(time_s / step_s) * step_s; };
}
Stamp up(double step_s) {
  return [step_s](double time_s) { return std::ceil(time_s / step_s) * step_s; };
}
double asFloat(double time_s) {
  return static_cast<double>(static_cast<float>(time_s));
}
double withFiveDigits(double time_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", time_s);
  return std::atof(text);
}
double exact(double time_s) {
  return time_s;
}

// The sensor's times, and how a recording has them.
struct Stamped {
  double rate_hz = 200.0, jitter_s = 0.0, lost = 0.0;  // lost: share of samples
  Stamp stamp = exact;
  std::size_t group = 1;  // samples that are stamped when the last one arrives
  double from_s = 100.0, duration_s = 15.0;

  Samples samples(std::vector<double>& times_s) const {
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0.0, 1.0);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (int i = 0; i < rate_hz * duration_s; ++i) {
      const double time_s = from_s + 0.00123 + i / rate_hz + jitter_s * normal(random);
      if (uniform(random) >= lost) times_s.push_back(time_s);
    }
    std::ranges::sort(times_s);
    Samples samples(times_s.size());
    double late_s = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i % group == 0) late_s = 1e-4 * std::abs(normal(random));
      const std::size_t last = std::min(samples.size(), i - i % group + group) - 1;
      samples[i].time_ns = std::llround(1e9 * stamp(group > 1 ? times_s[last] + late_s : times_s[i]));
      samples[i].angular_rate_rad_s.x() = normal(random);
    }
    return samples;
  }
};

// RMS about the mean, which is a time offset.
double scatter_ms(const Samples& samples, const std::vector<double>& times_s) {
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double error_ms = 1e3 * (1e-9 * static_cast<double>(samples[i].time_ns) - times_s[i]);
    sum += error_ms;
    squares += error_ms * error_ms;
  }
  const double count = static_cast<double>(samples.size());
  return std::sqrt(std::max(0.0, squares / count - sum * sum / count / count));
}

class TestImuStamps : public QObject {
  Q_OBJECT

 private slots:
  void coarseStamps_becomeSteadyTimes_data();
  void coarseStamps_becomeSteadyTimes();
  void finestStep_isAnOption();
  void otherStamps_areKept_data();
  void otherStamps_areKept();
  void regularLossesAndUnsetClocks_areNoBeat();
  void scatteringSamples_keepTheirStamps();
  void separateSensors_haveTheirOwnTimes();
  void fewEqualStamps_areLeftOutAndNamed();
  void log_thatWasWrittenTwice_isReadOnce();
  void disorderAndSecondClocks_areRemoved();
};

}  // namespace

Q_DECLARE_METATYPE(Stamped)

namespace {

void TestImuStamps::coarseStamps_becomeSteadyTimes_data() {
  QTest::addColumn<Stamped>("stamped");
  QTest::addColumn<double>("step_ms");
  QTest::addColumn<double>("max_ms");  // scatter that is left; that of stamps is 0.29 steps
  const auto row = [](const char* name, const Stamped& stamped, double step_ms, double max_ms) {
    QTest::newRow(name) << stamped << step_ms << max_ms;
  };
  row("10 ms at 200 Hz", {.stamp = rounded(0.01)}, 10.0, 0.1);
  row("10 ms, down", {.stamp = down(0.01)}, 10.0, 0.1);
  row("10 ms, up", {.stamp = up(0.01)}, 10.0, 0.1);
  row("10 ms, rate not quite 200 Hz", {.rate_hz = 200.3, .stamp = rounded(0.01)}, 10.0, 0.4);
  row("10 ms, jitter", {.jitter_s = 3e-4, .stamp = rounded(0.01)}, 10.0, 0.4);
  row("10 ms, some lost", {.lost = 0.001, .stamp = rounded(0.01)}, 10.0, 0.4);
  row("10 ms, many lost", {.lost = 0.01, .stamp = rounded(0.01)}, 10.0, 1.6);
  row("10 ms at 1 kHz", {.rate_hz = 1000.0, .stamp = rounded(0.01)}, 10.0, 0.1);
  row("10 ms at 1 kHz, many lost", {.rate_hz = 1000.0, .lost = 0.01, .stamp = rounded(0.01)}, 10.0, 0.5);
  row("1 ms at 1 kHz", {.rate_hz = 1000.3, .stamp = rounded(0.001)}, 1.0, 0.12);
  row("1 ms at 1 kHz, slower", {.rate_hz = 999.7, .stamp = rounded(0.001), .duration_s = 30.0}, 1.0, 0.12);
  row("1 ms at 208 Hz", {.rate_hz = 208.0, .stamp = down(0.001)}, 1.0, 0.05);
  row("ticks of 4 ms", {.stamp = down(0.004)}, 4.0, 0.1);
  row("ticks of 4 ms, many lost", {.lost = 0.02, .stamp = down(0.004)}, 4.0, 0.6);
  row("ticks of 1/60 s", {.stamp = down(1.0 / 60.0)}, 16.667, 0.2);
  row("ticks of 1/64 s at 100 Hz", {.rate_hz = 100.0, .stamp = down(1.0 / 64.0)}, 15.625, 0.2);
  row("single precision, a day after power-on", {.stamp = asFloat, .from_s = 1e5}, 7.8125, 0.2);
  row("single precision, steps that double", {.stamp = asFloat, .from_s = 65530.0}, 7.8125, 0.2);
  row("five digits, across 100 s", {.stamp = withFiveDigits, .from_s = 95.0}, 10.0, 0.8);
  row("pairs", {.group = 2}, 10.0, 0.1);
  row("groups of 10", {.group = 10}, 50.0, 0.6);
  row("groups of 10 in ms", {.stamp = down(0.001), .group = 10}, 50.0, 0.6);
}

void TestImuStamps::coarseStamps_becomeSteadyTimes() {
  QFETCH(Stamped, stamped);
  QFETCH(double, step_ms);
  QFETCH(double, max_ms);
  std::vector<double> times_s;
  Samples samples = stamped.samples(times_s);
  const Samples before = samples;
  const CoarseStamps found = reconstructStamps(samples);
  QVERIFY2(std::abs(1e3 * found.step_s - step_ms) < 0.01 * step_ms,
           qPrintable(QString::number(found.step_s)));
  QVERIFY(found.reconstructed);
  const double left_ms = scatter_ms(samples, times_s);
  QVERIFY2(left_ms < max_ms, qPrintable(QString("%1, was %2").arg(left_ms).arg(scatter_ms(before, times_s))));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    QVERIFY(std::abs(secondsSince(before[i].time_ns, samples[i].time_ns)) < 0.51 * found.step_s);
    QVERIFY(i == 0 || samples[i].time_ns > samples[i - 1].time_ns);
  }
}

void TestImuStamps::finestStep_isAnOption() {
  std::vector<double> times_s;
  Samples samples = Stamped{.rate_hz = 200.3, .stamp = down(0.001)}.samples(times_s);
  StampOptions options;
  options.finest_step_ms = 2.0;
  QCOMPARE(reconstructStamps(samples, options).step_s, 0.0);
  QVERIFY(reconstructStamps(samples).reconstructed);
}

void TestImuStamps::otherStamps_areKept_data() {
  QTest::addColumn<Stamped>("stamped");
  const auto row = [](const char* name, const Stamped& stamped) { QTest::newRow(name) << stamped; };
  row("ns", {});
  row("us, 1 kHz", {.rate_hz = 1000.0, .stamp = rounded(1e-6)});
  row("us, jitter", {.jitter_s = 5e-4, .stamp = rounded(1e-6)});
  row("us, some lost", {.rate_hz = 1000.0, .jitter_s = 2e-5, .lost = 0.01, .stamp = rounded(1e-6)});
  row("double precision since 1970", {.stamp = rounded(2.4e-7)});
  row("a counter of periods", {.stamp = rounded(0.005)});
  row("a counter of periods, few lost", {.lost = 0.003, .stamp = rounded(0.005), .duration_s = 30.0});
  row("a counter of periods, many lost", {.lost = 0.25, .stamp = rounded(0.005)});
  row("a counter of ms at 1 kHz, many lost", {.rate_hz = 1000.0, .lost = 0.1, .stamp = rounded(0.001)});
  row("steps of 0.1 ms", {.rate_hz = 200.3, .stamp = rounded(1e-4)});
}

void TestImuStamps::regularLossesAndUnsetClocks_areNoBeat() {
  std::vector<double> times_s;
  Samples samples = Stamped{.rate_hz = 1000.0, .stamp = rounded(0.001)}.samples(times_s), left;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (i % 50 != 7) left.push_back(samples[i]);
  QCOMPARE(reconstructStamps(left).step_s, 0.0);
  Samples doubled = samples;
  for (std::size_t i = 1; i < doubled.size(); ++i) {
    const std::int64_t step_ns = i > 9'000 && i < 12'000 ? 2'000'000 : 1'000'000;
    doubled[i].time_ns = doubled[i - 1].time_ns + step_ns;
  }
  QCOMPARE(reconstructStamps(doubled).step_s, 0.0);
  for (std::size_t i = 0; i < 5; ++i) samples[i].time_ns = 0;  // the driver's clock was not set yet
  QCOMPARE(reconstructStamps(samples).step_s, 0.0);
}

void TestImuStamps::otherStamps_areKept() {
  QFETCH(Stamped, stamped);
  std::vector<double> times_s;
  Samples samples = stamped.samples(times_s);
  const Samples before = samples;
  std::vector<RecordingFault> faults;
  QCOMPARE(putInOrder("/imu", 0, samples, faults), 0.0);
  QVERIFY2(faults.empty(), faults.empty() ? "" : faults.front().text.c_str());
  QVERIFY(std::ranges::equal(samples, before, {}, &ImuSample::time_ns, &ImuSample::time_ns));
}

// Their own times scatter by more than a step: a steady rate would be further from them than the stamps are.
void TestImuStamps::scatteringSamples_keepTheirStamps() {
  const Stamped stamped{.jitter_s = 1e-3, .stamp = down(0.001)};
  std::vector<double> times_s;
  Samples samples = stamped.samples(times_s);
  const CoarseStamps found = reconstructStamps(samples);
  QVERIFY(std::abs(found.step_s - 1e-3) < 1e-6);
  QVERIFY(!found.reconstructed);
  QVERIFY(scatter_ms(samples, times_s) < 0.3);
}

// Equal stamps do not join a rate and a force that were measured at different times.
void TestImuStamps::separateSensors_haveTheirOwnTimes() {
  std::vector<double> rates_s, forces_s;
  Samples rates = Stamped{.stamp = rounded(0.01)}.samples(rates_s);
  Samples forces = Stamped{.rate_hz = 100.7, .stamp = rounded(0.01)}.samples(forces_s);
  Samples joined;
  for (std::size_t i = 0, k = 0; i < rates.size() || k < forces.size();) {
    const bool rate = k == forces.size() || (i < rates.size() && rates[i].time_ns <= forces[k].time_ns);
    const bool both = rate && k < forces.size() && rates[i].time_ns == forces[k].time_ns;
    joined.push_back(rate ? rates[i] : forces[k]);
    joined.back().measured_by = both   ? MeasuredBy::Both
                                : rate ? MeasuredBy::Gyroscope
                                       : MeasuredBy::Accelerometer;
    i += rate ? 1 : 0;
    k += both || !rate ? 1 : 0;
  }
  QVERIFY(reconstructStamps(joined).reconstructed);
  Samples found_rates, found_forces;
  for (const ImuSample& sample : joined) {
    if (measuresRate(sample)) found_rates.push_back(sample);
    if (measuresForce(sample)) found_forces.push_back(sample);
  }
  QCOMPARE(found_rates.size(), rates_s.size());
  QCOMPARE(found_forces.size(), forces_s.size());
  QVERIFY(scatter_ms(found_rates, rates_s) < 0.1);
  QVERIFY(scatter_ms(found_forces, forces_s) < 0.7);  // a beat of 1.4 s
}

void TestImuStamps::fewEqualStamps_areLeftOutAndNamed() {
  std::vector<double> times_s;
  Samples samples = Stamped{.stamp = rounded(1e-6)}.samples(times_s);
  for (const std::size_t i : {std::size_t{300}, std::size_t{900}})
    samples[i].time_ns = samples[i - 1].time_ns;
  samples.insert(samples.begin() + 1500, samples[1499]);  // sent twice
  std::vector<RecordingFault> faults;
  QCOMPARE(putInOrder("/imu", samples.front().time_ns, samples, faults), 0.0);
  QCOMPARE(samples.size(), times_s.size() - 2);
  QCOMPARE(faults.size(), std::size_t{1});
  QVERIFY2(faults[0].text.find("2 samples have the stamp of the sample before") != std::string::npos,
           faults[0].text.c_str());
}

void TestImuStamps::log_thatWasWrittenTwice_isReadOnce() {
  std::vector<double> times_s;
  const Samples once = Stamped{.stamp = rounded(1e-6)}.samples(times_s);
  Samples in_a_row = once, line_by_line;
  in_a_row.insert(in_a_row.end(), once.begin(), once.end());
  for (const ImuSample& sample : once) line_by_line.insert(line_by_line.end(), 2, sample);
  for (Samples* const twice : {&in_a_row, &line_by_line}) {
    std::vector<RecordingFault> faults;
    QCOMPARE(putInOrder("/imu", once.front().time_ns, *twice, faults), 0.0);
    QCOMPARE(twice->size(), once.size());
    QVERIFY(std::ranges::equal(*twice, once, {}, &ImuSample::time_ns, &ImuSample::time_ns));
    QCOMPARE(faults.back().text,
             "/imu: 3000 samples are written twice, with the same stamp and values: excluded");
  }
}

void TestImuStamps::disorderAndSecondClocks_areRemoved() {
  std::vector<double> times_s;
  Samples samples = Stamped{}.samples(times_s);
  std::swap(samples[100], samples[101]);
  for (std::size_t i = 1000; i < 1010; ++i) samples[i].time_ns += 30 * kSecond_ns;
  std::vector<RecordingFault> faults;
  putInOrder("/imu", samples.front().time_ns, samples, faults);
  QCOMPARE(samples.size(), times_s.size() - 10);
  QVERIFY(std::ranges::is_sorted(samples, {}, &ImuSample::time_ns));
  QCOMPARE(faults.size(), std::size_t{2});
  QVERIFY(faults[0].kind == FaultKind::SecondClock && faults[1].kind == FaultKind::BackwardTime);
}

}  // namespace

EVICAL_TEST(TestImuStamps)
#include "tst_imu_stamps.moc"
