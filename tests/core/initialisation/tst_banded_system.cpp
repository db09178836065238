#include "core/initialisation/banded_system.h"
#include "tests/support/test_program.h"

#include <Eigen/LU>

#include <random>

using namespace evical;

class TestBandedSystem : public QObject {
  Q_OBJECT

 private slots:
  void solve_matchesDenseSolver() {
    constexpr int kSize = 17;
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    BandedMatrix banded(kSize);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(kSize, kSize);
    for (int k = 0; k < 60; ++k) {
      const int first = k % (kSize - 3);
      const Eigen::Vector4d weights(normal(random), normal(random), normal(random), normal(random));
      banded.addOuter(first, weights, 0.5);
      dense.block<4, 4>(first, first) += 0.5 * weights * weights.transpose();
    }
    Eigen::MatrixXd right = Eigen::MatrixXd::NullaryExpr(kSize, 5, [&] { return normal(random); });
    const Eigen::MatrixXd expected = dense.fullPivLu().solve(right);
    QVERIFY(banded.factorise());
    banded.solveInPlace(right);
    QVERIFY((right - expected).norm() < 1e-9 * expected.norm());
  }

  void factorise_refusesSingularMatrix() {
    BandedMatrix banded(6);
    banded.addOuter(0, {1.0, 1.0, 1.0, 1.0}, 1.0);
    QVERIFY(!banded.factorise());
  }
};

EVICAL_TEST(TestBandedSystem)
#include "tst_banded_system.moc"
