#include "core/geometry/so3.h"

#include "tests/support/numeric_jacobian.h"
#include "tests/support/test_program.h"

#include <Eigen/Dense>

#include <numbers>

namespace {

using namespace evical;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using std::numbers::pi;

const Vector3d kAxis = Vector3d(1.0, -2.0, 2.0) / 3.0;

// The definition: sum of skew(v)^n / n!. Thirty terms are exact to double precision up to a half turn.
Matrix3d exponentialSeries(const Vector3d& v) {
  Matrix3d sum = Matrix3d::Identity(), term = Matrix3d::Identity();
  for (int n = 1; n <= 30; ++n) {
    term = (term * skew(v) / n).eval();
    sum += term;
  }
  return sum;
}

// Angles on both sides of every threshold below which a function uses its series.
void angleRows() {
  QTest::addColumn<double>("angle_rad");
  for (const double angle : {0.0, 1e-12, 1e-8, 0.99e-7, 1.01e-7, 0.99e-4, 1.01e-4, 0.99e-3, 1.01e-3, 0.0099,
                             0.0101, 0.3, 1.0, 2.0, 3.0, 3.14})
    QTest::addRow("%g rad", angle) << angle;
}

}  // namespace

class TestSo3 : public QObject {
  Q_OBJECT

 private slots:
  void skew_isTheCrossProduct() {
    Matrix3d by_hand;
    by_hand << 0.0, -3.0, 2.0, 3.0, 0.0, -1.0, -2.0, 1.0, 0.0;
    QCOMPARE(skew({1.0, 2.0, 3.0}), by_hand);
    const Vector3d w(0.5, -0.7, 1.1);
    QVERIFY((skew(kAxis) * w - kAxis.cross(w)).norm() < 1e-15);
  }

  void exponential_ofQuarterAndHalfTurns_isKnown() {
    Matrix3d quarter_about_z, half_about_x;
    quarter_about_z << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
    half_about_x << 1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0;
    QVERIFY((so3Exp({0.0, 0.0, pi / 2.0}) - quarter_about_z).norm() < 1e-15);
    QVERIFY((so3Exp({pi, 0.0, 0.0}) - half_about_x).norm() < 1e-15);
    QCOMPARE(so3Exp(Vector3d::Zero()), Matrix3d::Identity().eval());
  }

  void exponential_isItsSeries_data() { angleRows(); }
  void exponential_isItsSeries() {
    QFETCH(double, angle_rad);
    const Matrix3d rotation = so3Exp(angle_rad * kAxis);
    QVERIFY((rotation - exponentialSeries(angle_rad * kAxis)).norm() < 1e-14);
    QVERIFY((rotation.transpose() * rotation - Matrix3d::Identity()).norm() < 1e-14);
    QVERIFY((quaternionExp(angle_rad * kAxis).toRotationMatrix() - rotation).norm() < 1e-14);
    QVERIFY(std::abs(quaternionExp(angle_rad * kAxis).norm() - 1.0) < 1e-15);
  }

  void logarithm_isTheExponentialsInverse_data() { angleRows(); }
  void logarithm_isTheExponentialsInverse() {
    QFETCH(double, angle_rad);
    const Vector3d v = angle_rad * kAxis;
    QVERIFY((quaternionLog(quaternionExp(v)) - v).norm() < 1e-15 * (1.0 + 4.0 * angle_rad));
    // A matrix determines small angles by differences from one, and angles near a half turn by their cosine.
    QVERIFY((so3Log(so3Exp(v)) - v).norm() < 1e-13);
  }

  void logarithm_takesTheShorterWay() {
    const Vector3d v = 1.2 * kAxis;
    Eigen::Quaterniond other_sign = quaternionExp(v);
    other_sign.coeffs() *= -1.0;
    QVERIFY((quaternionLog(other_sign) - v).norm() < 1e-15);
    QVERIFY((quaternionLog(quaternionExp(4.0 * kAxis)) + (2.0 * pi - 4.0) * kAxis).norm() < 1e-14);
  }

  void logarithm_atAHalfTurn_isAHalfTurn() {
    for (const Vector3d& axis : {kAxis, Vector3d::UnitX().eval(), Vector3d::UnitZ().eval()}) {
      const Matrix3d rotation = 2.0 * axis * axis.transpose() - Matrix3d::Identity();
      const Vector3d v = so3Log(rotation);
      QVERIFY(std::abs(v.norm() - pi) < 1e-14);
      QVERIFY((so3Exp(v) - rotation).norm() < 1e-14);
    }
  }

  void rightJacobian_isThatOfItsDefinition_data() { angleRows(); }
  void rightJacobian_isThatOfItsDefinition() {
    QFETCH(double, angle_rad);
    const Vector3d v = angle_rad * kAxis;
    const auto change = [&](const Eigen::VectorXd& d) -> Eigen::VectorXd {
      return quaternionLog(quaternionExp(v).conjugate() * quaternionExp(v + d));
    };
    const Eigen::MatrixXd numeric = test::numericJacobian(change, 3, 1e-3);
    QVERIFY(test::relativeDifference(so3RightJacobian(v), numeric) < 1e-11);
  }

  void rightJacobian_ofAQuarterTurn_isKnown() {
    // Perpendicular to the axis: sin(x)/x along, (1 - cos x)/x sideways; the axis itself is unchanged.
    const double x = pi / 2.0;
    Matrix3d by_hand;
    by_hand << std::sin(x) / x, 1.0 / x, 0.0, -1.0 / x, std::sin(x) / x, 0.0, 0.0, 0.0, 1.0;
    QVERIFY((so3RightJacobian({0.0, 0.0, x}) - by_hand).norm() < 1e-15);
  }

  void inverseJacobian_isTheInverse_data() { angleRows(); }
  void inverseJacobian_isTheInverse() {
    QFETCH(double, angle_rad);
    const Vector3d v = angle_rad * kAxis;
    QVERIFY((so3RightJacobianInverse(v) * so3RightJacobian(v) - Matrix3d::Identity()).norm() < 1e-12);
  }

  void exponentialAndJacobian_areThoseThatAreComputedApart_data() { angleRows(); }
  void exponentialAndJacobian_areThoseThatAreComputedApart() {
    QFETCH(double, angle_rad);
    const Vector3d v = angle_rad * kAxis;
    Matrix3d exponential, right_jacobian;
    so3ExpAndRightJacobian(v, exponential, right_jacobian);
    QVERIFY((exponential - so3Exp(v)).norm() < 1e-15);
    QVERIFY((right_jacobian - so3RightJacobian(v)).norm() < 1e-15);
  }
};

EVICAL_TEST(TestSo3)
#include "tst_so3.moc"
