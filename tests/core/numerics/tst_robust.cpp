#include "core/numerics/robust.h"

#include "tests/support/test_program.h"

#include <array>

using namespace evical;

class TestRobust : public QObject {
  Q_OBJECT

 private slots:
  void medianOf_anOddCount_isTheMiddle() {
    QCOMPARE(medianOf(std::vector<double>{3.0, 1.0, 2.0}), 2.0);
    QCOMPARE(medianOf(std::vector<double>{7.0}), 7.0);
  }

  void medianOf_anEvenCount_isTheLargerOfTwo() {
    QCOMPARE(medianOf(std::vector<double>{4.0, 1.0, 3.0, 2.0}), 3.0);
    QCOMPARE(medianOf(std::vector<float>{2.0f, 1.0f}), 2.0f);
  }

  void medianOf_nothing_isWhatTheCallerSays() {
    QCOMPARE(medianOf(std::vector<double>{}), 0.0);
    QCOMPARE(medianOf(std::vector<double>{}, 0.02), 0.02);
  }

  void medianOf_aPartOfARange_ignoresTheRest() {
    std::array<int, 5> values = {9, 5, 7, -100, -100};
    QCOMPARE(medianOf(values.begin(), values.begin() + 3), 7);
    QCOMPARE(values[3], -100);
  }

  void medianOf_oneWildValue_staysWhereItWas() {
    QCOMPARE(medianOf(std::vector<double>{1.0, 2.0, 3.0, 4.0, 1e9}), 3.0);
  }

  void cauchyWeight_fallsWithTheSquare() {
    QCOMPARE(cauchyWeight(0.0), 1.0);
    QCOMPARE(cauchyWeight(1.0), 0.5);  // at the scale
    QCOMPARE(cauchyWeight(3.0), 0.25);
  }

  // The distribution of chi^2 with 2 degrees of freedom is 1 - exp(-x / 2).
  void medianOfChi2With2_halvesTheDistribution() { QCOMPARE(1.0 - std::exp(-0.5 * kMedianOfChi2With2), 0.5); }

  void scaleOfPoints_isOneWhereErrorsAreAsSaid_twoWhereTwice() {
    const double median = 2.0 * std::log(2.0);
    QCOMPARE(scaleOfPoints({0.1, median, 50.0}), 1.0);
    QCOMPARE(scaleOfPoints({0.1, 4.0 * median, 50.0}), 2.0);
    QCOMPARE(scaleOfPoints({}), 1.0);
  }
};

EVICAL_TEST(TestRobust)
#include "tst_robust.moc"
