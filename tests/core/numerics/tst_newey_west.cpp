#include "core/numerics/robust.h"

#include "tests/support/test_program.h"

#include <array>

using namespace evical;

namespace {

std::vector<Eigen::VectorXd> numbers(const std::vector<double>& values) {
  std::vector<Eigen::VectorXd> scores;
  for (const double value : values) scores.push_back(Eigen::VectorXd::Constant(1, value));
  return scores;
}

double byLag(const std::vector<double>& values, std::size_t lags) {
  return neweyWestByLag(numbers(values), 1, lags)(0, 0);
}

double byTime(const std::vector<double>& times_s, const std::vector<double>& values, double bound_s) {
  return neweyWestByTime(times_s, numbers(values), 1, bound_s)(0, 0);
}

}  // namespace

class TestNeweyWest : public QObject {
  Q_OBJECT

 private slots:
  void byLag_withoutLags_isTheSumOfSquares() { QCOMPARE(byLag({1.0, 2.0, 3.0}, 0), 14.0); }

  // Squares 14, neighbours 2 (1 x 2 + 2 x 3) at half weight.
  void byLag_countsNeighboursTwiceAtTheirWeight() { QCOMPARE(byLag({1.0, 2.0, 3.0}, 1), 22.0); }

  // Weights 2/3 and 1/3: 14 + 2 (2/3 x 8 + 1/3 x 3).
  void byLag_weightsFallEvenly() { QCOMPARE(byLag({1.0, 2.0, 3.0}, 2), 14.0 + 32.0 / 3.0 + 2.0); }

  void byLag_ofVectors_isSymmetric() {
    const std::vector<Eigen::Vector2d> scores = {{1.0, 0.0}, {0.0, 1.0}};
    const Eigen::Matrix2d expected = (Eigen::Matrix2d() << 1.0, 0.5, 0.5, 1.0).finished();
    QVERIFY(neweyWestByLag(scores, 2, 1) == expected);
  }

  void byLag_ofNothing_isZero() { QCOMPARE(byLag({}, 3), 0.0); }

  // 0 and 1 s have half weight, 1 and 3 s at the bound have none: 14 + 2 x 1/2 x 2.
  void byTime_weightsFallToZeroAtTheBound() { QCOMPARE(byTime({0.0, 1.0, 3.0}, {1.0, 2.0, 3.0}, 2.0), 16.0); }

  // (1 + 2)^2 + 3^2.
  void byTime_withABoundOfZero_joinsWhatIsAtOneTime() {
    QCOMPARE(byTime({0.0, 0.0, 1.0}, {1.0, 2.0, 3.0}, 0.0), 18.0);
  }

  void byTime_atEvenSteps_isByLag() {
    const std::vector<double> values = {0.5, -1.0, 2.0, 3.0, -0.25};
    QCOMPARE(byTime({0.0, 1.0, 2.0, 3.0, 4.0}, values, 3.0), byLag(values, 2));
  }
};

EVICAL_TEST(TestNeweyWest)
#include "tst_newey_west.moc"
