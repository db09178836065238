#include "core/geometry/circle_conic.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/so3.h"
#include "tests/support/numeric_jacobian.h"
#include "tests/support/random_vector.h"
#include "tests/support/test_program.h"

#include <Eigen/Dense>

#include <random>

namespace {

using namespace evical;

CameraIntrinsics camera() {
  CameraIntrinsics c;
  c.resolution_px = {346, 260};
  c.focal_length_px = {260.0, 255.0};
  c.principal_point_px = {170.0, 131.0};
  return c;
}

RigidTransform randomPose(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto vector = [&] { return test::randomVector<3>([&] { return uniform(random); }); };
  return {quaternionExp(0.8 * vector()), Eigen::Vector3d(0.0, 0.0, 0.45) + 0.2 * vector()};
}

// Centre of the conic through the images of points on the circle, by linear least squares.
Eigen::Vector2d centreOfImagedPoints(const RigidTransform& pose, const Eigen::Vector2d& centre_m,
                                     double radius_m) {
  Eigen::MatrixXd design(40, 5);
  for (int i = 0; i < 40; ++i) {
    const double angle = i * 2.0 * M_PI / 40.0;
    const Eigen::Vector2d on_board = centre_m + radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d px =
        *project(camera(), pose * Eigen::Vector3d(on_board.x(), on_board.y(), 0.0)) / 100.0;
    design.row(i) << px.x() * px.x(), px.x() * px.y(), px.y() * px.y(), px.x(), px.y();
  }
  const Eigen::VectorXd q = design.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(40));
  Eigen::Matrix2d a;
  a << 2.0 * q[0], q[1], q[1], 2.0 * q[2];
  return -100.0 * a.inverse() * q.tail<2>();
}

class TestCircleConic : public QObject {
  Q_OBJECT

 private slots:
  void centre_isThatOfTheImagedCircle() {
    std::mt19937 random(1);
    double largest_shift_px = 0.0;
    for (int i = 0; i < 50; ++i) {
      const RigidTransform pose = randomPose(random);
      const Eigen::Vector2d centre_m(0.05, 0.02);
      const auto centre_px = projectedCircleCentre(camera(), pose, centre_m, 0.02);
      QVERIFY(centre_px);
      QVERIFY((*centre_px - centreOfImagedPoints(pose, centre_m, 0.02)).norm() < 1e-6);
      const Eigen::Vector2d point_px = *project(camera(), pose * Eigen::Vector3d(0.05, 0.02, 0.0));
      largest_shift_px = std::max(largest_shift_px, (point_px - *centre_px).norm());
    }
    QVERIFY2(largest_shift_px > 0.1, "the poses do not separate the conic's centre from the projected point");
  }

  void jacobian_matchesNumericDifferences() {
    std::mt19937 random(2);
    for (int i = 0; i < 20; ++i) {
      const RigidTransform pose = randomPose(random);
      const Eigen::Vector2d centre_m(0.05, 0.02);
      Eigen::Matrix<double, 2, 6> jacobian;
      QVERIFY(projectedCircleCentre(camera(), pose, centre_m, 0.02, &jacobian));
      const auto centre = [&](const Eigen::VectorXd& delta) -> Eigen::VectorXd {
        const RigidTransform moved = {pose.rotation * quaternionExp(delta.head<3>()),
                                      pose.translation_m + delta.tail<3>()};
        return *projectedCircleCentre(camera(), moved, centre_m, 0.02);
      };
      QVERIFY(test::relativeDifference(jacobian, test::numericJacobian(centre, 6, 1e-4)) < 1e-8);
    }
  }

  void circle_notWhollyInFront_isNothing() {
    const Eigen::Vector2d centre_m(0.0, 0.0);
    const Eigen::Quaterniond edge_on = quaternionExp({0.0, M_PI / 2.0, 0.0});
    QVERIFY(
        !projectedCircleCentre(camera(), {Eigen::Quaterniond::Identity(), {0.0, 0.0, -0.5}}, centre_m, 0.02));
    QVERIFY(!projectedCircleCentre(camera(), {edge_on, {0.0, 0.0, 0.019}}, centre_m, 0.02));
    QVERIFY(projectedCircleCentre(camera(), {edge_on, {0.0, 0.0, 0.021}}, centre_m, 0.02));
  }
};

}  // namespace

EVICAL_TEST(TestCircleConic)
#include "tst_circle_conic.moc"
