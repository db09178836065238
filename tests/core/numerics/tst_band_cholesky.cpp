#include "core/numerics/band_cholesky.h"

#include "tests/support/random_vector.h"
#include "tests/support/test_program.h"

#include <Eigen/LU>

#include <algorithm>
#include <random>

using namespace evical;

namespace {

// L = [2 . .; 1 2 .; . 1 2], so L L^T = [4 2 .; 2 5 2; . 2 5].
BandCholesky byHand() {
  BandCholesky band(3, 1);
  band.add(0, 0, 4.0);
  band.add(1, 0, 2.0);
  band.add(1, 1, 5.0);
  band.add(2, 1, 2.0);
  band.add(2, 2, 5.0);
  return band;
}

}  // namespace

class TestBandCholesky : public QObject {
  Q_OBJECT

 private slots:
  void solve_byHand() {
    BandCholesky band = byHand();
    QVERIFY(band.factorise());
    Eigen::MatrixXd right(3, 2), expected(3, 2);
    expected << 1.0, 2.0, 1.0, 0.0, 1.0, -1.0;
    right << 6.0, 8.0, 9.0, 2.0, 7.0, -5.0;
    band.solveInPlace(right);
    QVERIFY(right == expected);
  }

  // L^T (1, 1, 1) = (3, 3, 2).
  void correlate_byHand() {
    BandCholesky band = byHand();
    QVERIFY(band.factorise());
    Eigen::VectorXd white = Eigen::Vector3d(3.0, 3.0, 2.0);
    band.correlateInPlace(white);
    QVERIFY(white == Eigen::Vector3d::Ones());
  }

  void addOuter_isTheSumOfProducts() {
    BandCholesky band(3, 1), entries(3, 1);
    band.addOuter(1, Eigen::Vector2d(2.0, 3.0), 0.5);
    band.addOuter(0, Eigen::Vector2d(1.0, 0.0), 1.0);
    entries.add(0, 0, 1.0);
    entries.add(1, 1, 2.0);
    entries.add(2, 1, 3.0);
    entries.add(2, 2, 4.5);
    entries.add(2, 2, 1.0);
    band.add(2, 2, 1.0);
    QVERIFY(band.factorise() && entries.factorise());
    Eigen::MatrixXd one = Eigen::Vector3d(1.0, 2.0, 3.0), other = one;
    band.solveInPlace(one);
    entries.solveInPlace(other);
    QVERIFY(one == other);
  }

  void solve_ofOuterProducts_matchesDenseSolver() {
    constexpr int kSize = 17;
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    BandCholesky band(kSize, 3);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kSize, kSize);
    for (int k = 0; k < 60; ++k) {
      const int first = k % (kSize - 3);
      const Eigen::Vector4d weights = test::randomVector<4>([&] { return normal(random); });
      band.addOuter(first, weights, 0.5);
      dense.block<4, 4>(first, first) += 0.5 * weights * weights.transpose();
    }
    Eigen::MatrixXd right = Eigen::MatrixXd::NullaryExpr(kSize, 5, [&] { return normal(random); });
    const Eigen::MatrixXd expected = dense.fullPivLu().solve(right);
    QVERIFY(band.factorise());
    band.solveInPlace(right);
    QVERIFY((right - expected).norm() < 1e-9 * expected.norm());
  }

  void solve_ofEntries_matchesDenseProduct() {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    constexpr Eigen::Index kSize = 40, kBand = 5;
    Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(kSize, kSize);
    for (Eigen::Index i = 0; i < kSize; ++i) {
      for (Eigen::Index j = std::max<Eigen::Index>(0, i - kBand); j <= i; ++j) factor(i, j) = normal(random);
      factor(i, i) += 4.0;
    }
    const Eigen::MatrixXd matrix = factor * factor.transpose();
    BandCholesky band(kSize, kBand);
    for (Eigen::Index i = 0; i < kSize; ++i) {
      for (Eigen::Index j = std::max<Eigen::Index>(0, i - kBand); j <= i; ++j) band.add(i, j, matrix(i, j));
    }
    QVERIFY(band.factorise());
    const Eigen::MatrixXd right = Eigen::MatrixXd::Random(kSize, 3);
    Eigen::MatrixXd solution = right;
    band.solveInPlace(solution);
    QVERIFY((matrix * solution - right).norm() < 1e-10);
  }

  void factorise_refusesSingularMatrix() {
    BandCholesky band(6, 3);
    band.addOuter(0, Eigen::Vector4d(1.0, 1.0, 1.0, 1.0), 1.0);
    QVERIFY(!band.factorise());
  }

  void solve_onADirectionWithoutInformation_givesZeroThere() {
    BandCholesky band(3, 1);
    band.add(0, 0, 2.0);
    band.add(2, 2, 4.0);
    QVERIFY(!band.factorise());
    Eigen::MatrixXd solution = Eigen::Vector3d(2.0, 0.0, 4.0);
    band.solveInPlace(solution);
    QVERIFY((solution - Eigen::Vector3d(1.0, 0.0, 1.0)).norm() < 1e-12);
  }
};

EVICAL_TEST(TestBandCholesky)
#include "tst_band_cholesky.moc"
