// Rotated directions, and mirrored ones.
#include "core/geometry/so3.h"
#include "tests/support/test_program.h"

using namespace evical;

class TestBestRotation : public QObject {
  Q_OBJECT

  static Eigen::Matrix3d products(const Eigen::Matrix3d& turned) {
    const Eigen::Matrix3d sources =
        (Eigen::Matrix3d() << 2.0, 0.1, 0.3, -0.2, 1.0, 0.1, 0.0, 0.4, 0.5).finished();
    return turned * sources * sources.transpose();
  }

 private slots:
  void rotation_isFound() {
    const Eigen::Matrix3d turn = so3Exp(Eigen::Vector3d(0.4, -1.1, 2.0));
    const BestRotation best = bestRotation(products(turn));
    QVERIFY((best.matrix - turn).norm() < 1e-12);
    QVERIFY(best.strengths[0] >= best.strengths[1] && best.strengths[1] >= best.strengths[2]);
    // Most of the rotated directions are along it.
    QVERIFY(std::abs(best.main_axis.dot(turn * Eigen::Vector3d::UnitX())) > 0.9);
  }

  void mirrored_staysARotation_unlessAskedFor() {
    const Eigen::Matrix3d mirror = Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal();
    QVERIFY(bestRotation(products(mirror)).matrix.determinant() > 0.999);
    QVERIFY((bestRotation(products(mirror), -1.0).matrix - mirror).norm() < 1e-12);
  }
};

EVICAL_TEST(TestBestRotation)
#include "tst_best_rotation.moc"
