
#include "core/geometry/so3.h"
#include "tests/support/test_program.h"

#include <numbers>

namespace {

using namespace evical;
using Eigen::Vector3d;
using std::numbers::pi;

// A quarter turn about z: b's x axis is a's y axis, b's y axis is a's -x axis.
const RigidTransform kQuarter{quaternionExp({0.0, 0.0, pi / 2.0}), {1.0, 2.0, 3.0}};
const RigidTransform kAny{quaternionExp({0.4, -1.1, 0.7}), {-0.3, 0.2, 0.9}};

bool sameForRigidTransform(const RigidTransform& one, const RigidTransform& other) {
  return rotationAngleBetween_rad(one.rotation, other.rotation) < 1e-14 &&
         (one.translation_m - other.translation_m).norm() < 1e-14;
}

}  // namespace

class TestRigidTransform : public QObject {
  Q_OBJECT

 private slots:
  void point_isTurnedThenMoved() {
    QVERIFY((kQuarter * Vector3d(10.0, 20.0, 30.0) - Vector3d(-19.0, 12.0, 33.0)).norm() < 1e-13);
    QCOMPARE(RigidTransform{} * Vector3d(1.0, 2.0, 3.0), Vector3d(1.0, 2.0, 3.0));
  }

  void product_appliesTheRightOneFirst() {
    const Vector3d point(0.1, -0.4, 0.8);
    QVERIFY(((kQuarter * kAny) * point - kQuarter * (kAny * point)).norm() < 1e-14);
    const RigidTransform twice = kQuarter * kQuarter;
    QVERIFY((twice.translation_m - Vector3d(-1.0, 3.0, 6.0)).norm() < 1e-14);
    QVERIFY(std::abs(rotationAngleBetween_rad(twice.rotation, Eigen::Quaterniond::Identity()) - pi) < 1e-14);
  }

  void product_staysARotation() {
    RigidTransform turned;
    for (int i = 0; i < 100'000; ++i) turned = turned * kAny;
    QVERIFY(std::abs(turned.rotation.norm() - 1.0) < 1e-15);
  }

  void inverse_undoesIt() {
    QVERIFY(sameForRigidTransform(kAny * inverse(kAny), {}));
    QVERIFY(sameForRigidTransform(inverse(kAny) * kAny, {}));
    QVERIFY(sameForRigidTransform(inverse(inverse(kAny)), kAny));
    QVERIFY(sameForRigidTransform(inverse(kQuarter * kAny), inverse(kAny) * inverse(kQuarter)));
    QVERIFY((inverse(kQuarter).translation_m - Vector3d(-2.0, 1.0, -3.0)).norm() < 1e-14);
  }

  void angleBetween_isThatOfTheTurnFromOneToTheOther() {
    const Eigen::Quaterniond turned = kAny.rotation * quaternionExp(Vector3d(0.0, 0.3, 0.4));
    QVERIFY(std::abs(rotationAngleBetween_rad(kAny.rotation, turned) - 0.5) < 1e-14);
    QVERIFY(std::abs(rotationAngleBetween_rad(turned, kAny.rotation) - 0.5) < 1e-14);
    Eigen::Quaterniond other_sign = kAny.rotation;
    other_sign.coeffs() *= -1.0;
    QVERIFY(rotationAngleBetween_rad(kAny.rotation, other_sign) < 1e-15);
  }
};

EVICAL_TEST(TestRigidTransform)
#include "tst_rigid_transform.moc"
