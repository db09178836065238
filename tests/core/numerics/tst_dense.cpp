#include "core/numerics/dense.h"

#include "tests/support/test_program.h"

#include <cmath>

using namespace evical;

namespace {

Eigen::MatrixXd square(double a, double b, double c, double d) {
  return (Eigen::Matrix2d() << a, b, c, d).finished();
}

}  // namespace

class TestDense : public QObject {
  Q_OBJECT

 private slots:
  // [2 1; 1 2] stretches (1, -1) by 1 and (1, 1) by 3.
  void symmetricEigen_byHand() {
    const SymmetricEigen eigen = symmetricEigen(square(2.0, 1.0, 1.0, 2.0));
    QVERIFY((eigen.values - Eigen::Vector2d(1.0, 3.0)).norm() < 1e-15);
    const double half = std::sqrt(0.5);
    QVERIFY((eigen.vectors.cwiseAbs() - Eigen::Matrix2d::Constant(half)).norm() < 1e-15);
    QVERIFY(eigen.vectors(0, 0) * eigen.vectors(1, 0) < 0.0);
    QVERIFY(eigen.vectors(0, 1) * eigen.vectors(1, 1) > 0.0);
  }

  void symmetricEigen_readsTheLowerTriangle() {
    QVERIFY((symmetricEigen(square(2.0, 99.0, 1.0, 2.0)).values - Eigen::Vector2d(1.0, 3.0)).norm() < 1e-15);
  }

  // Determinant -2.
  void inverse_byHand() {
    QVERIFY((inverseOf(square(1.0, 2.0, 3.0, 4.0)) - square(-2.0, 1.0, 1.5, -0.5)).norm() < 1e-14);
  }

  void products_byHand() {
    const Eigen::MatrixXd a = square(1.0, 2.0, 3.0, 4.0), b = square(0.0, 1.0, 1.0, 1.0);
    QVERIFY(product(a, b) == square(2.0, 3.0, 4.0, 7.0));
    QVERIFY(productTransposed(a, square(0.0, 1.0, 2.0, 3.0)) == square(2.0, 8.0, 4.0, 18.0));
    QVERIFY(congruence(a, b) == square(8.0, 18.0, 18.0, 40.0));
  }
};

EVICAL_TEST(TestDense)
#include "tst_dense.moc"
