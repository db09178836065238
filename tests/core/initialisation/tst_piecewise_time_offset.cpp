#include "core/initialisation/time_offset.h"
#include "tests/support/test_program.h"

#include <functional>
#include <random>

namespace {

using namespace evical;

// Twenty parts of 1.5 s, each known to 1 ms.
std::vector<OffsetPart> parts(const std::function<double(double)>& offsetAt_s, unsigned seed) {
  constexpr double kLength_s = 1.5, kSigma_s = 1e-3;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0.0, kSigma_s);
  std::vector<OffsetPart> all;
  for (int k = 0; k < 20; ++k) {
    const double begin_s = kLength_s * k;
    all.push_back({begin_s, begin_s + kLength_s, offsetAt_s(begin_s) + normal(generator), kSigma_s});
  }
  return all;
}

class TestOffsetByParts : public QObject {
  Q_OBJECT

 private slots:
  void step_isFoundWhereItIs() {
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const auto step = findClockStep(parts([](double time_s) { return time_s < 17.9 ? 0.02 : 0.07; }, seed));
      QVERIFY(step.has_value());
      QCOMPARE(step->at_s, 18.0);
      QVERIFY(std::abs(step->step_s - 0.05) < 0.002);
      QVERIFY(step->larger_part_first);
    }
  }

  void partsThatAreWrongByFar_areNoStep() {
    for (unsigned seed = 1; seed <= 20; ++seed) {
      std::vector<OffsetPart> all = parts([](double) { return 0.02; }, seed);
      QVERIFY(!findClockStep(all).has_value());
      all[3].time_offset_s += 0.2;
      all[15].time_offset_s -= 0.25;
      QVERIFY(!findClockStep(all).has_value());
    }
  }

  void drift_isNoStep() {
    for (unsigned seed = 1; seed <= 20; ++seed)
      QVERIFY(!findClockStep(parts([](double time_s) { return 1e-3 * time_s; }, seed)).has_value());
  }

  void tooFewParts_tellNothing() {
    std::vector<OffsetPart> all = parts([](double time_s) { return time_s < 1.4 ? 0.0 : 0.05; }, 1);
    all.resize(3);
    QVERIFY(!findClockStep(all).has_value());
    QVERIFY(!findClockStep({}).has_value());
  }
};

}  // namespace

EVICAL_TEST(TestOffsetByParts)
#include "tst_piecewise_time_offset.moc"
