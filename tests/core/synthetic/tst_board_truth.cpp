#include "core/synthetic/board_truth.h"
#include "tests/core/synthetic/scenarios.h"
#include "tests/support/test_program.h"

#include <Eigen/Dense>

#include <numbers>

using namespace evical;

namespace {

// Centre of the conic through the projections of many points of a circle.
Eigen::Vector2d centreByPoints(const RigidTransform& world_from_camera, const CameraIntrinsics& camera,
                               const CircleBoard& board, int circle) {
  constexpr int kPoints = 60;
  const Eigen::Vector2d middle = board.centre_m(circle);
  Eigen::Matrix<double, kPoints, 6> rows;
  for (int k = 0; k < kPoints; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kPoints;
    const Eigen::Vector3d point(middle.x() + board.radius_m * std::cos(angle),
                                middle.y() + board.radius_m * std::sin(angle), 0.0);
    const Eigen::Vector2d p = (inverse(world_from_camera) * point).hnormalized();
    rows.row(k) << p.x() * p.x(), p.x() * p.y(), p.y() * p.y(), p.x(), p.y(), 1.0;
  }
  const Eigen::Matrix<double, 6, 1> c =
      Eigen::JacobiSVD<Eigen::MatrixXd>(rows, Eigen::ComputeFullV).matrixV().col(5);
  Eigen::Matrix2d a;
  a << 2.0 * c(0), c(1), c(1), 2.0 * c(2);
  const Eigen::Vector2d centre = -a.inverse() * Eigen::Vector2d(c(3), c(4));
  return centre.cwiseProduct(camera.focal_length_px) + camera.principal_point_px;
}

}  // namespace

class TestBoardTruth : public QObject {
  Q_OBJECT
 private slots:
  void centre_isThatOfTheProjectedConic() {
    Scenario scenario = test::wavedScenario();
    scenario.cameras[0].time_offset_s = 0.02;
    const SinusoidMotion motion(scenario);
    const double stamp_s = 0.7;
    const double world_s = stamp_s + 0.02 - scenario.cameras[0].pixel.delay_s();
    const std::vector<TrueCircle> circles = trueBoardView(motion, scenario, 0, stamp_s);
    QCOMPARE(circles.size(), std::size_t{6});
    for (const TrueCircle& circle : circles) {
      const Eigen::Vector2d expected = centreByPoints(
          motion.worldFromCamera(0, world_s), scenario.cameras[0].intrinsics, scenario.board, circle.circle);
      QVERIFY((circle.centre_px - expected).norm() < 1e-6);
    }
  }
  void velocity_isTheCentresDerivative() {
    const Scenario scenario = test::wavedScenario();
    const SinusoidMotion motion(scenario);
    const double t = 0.4, h = 1e-3;
    const auto before = trueBoardView(motion, scenario, 0, t - h),
               now = trueBoardView(motion, scenario, 0, t), after = trueBoardView(motion, scenario, 0, t + h);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Eigen::Vector2d numeric = (after[i].centre_px - before[i].centre_px) / (2.0 * h);
      QVERIFY((numeric - now[i].velocity_px_s).norm() < 0.05);  // px/s; the step is large
      QVERIFY(now[i].velocity_px_s.norm() > 1.0);
    }
  }
  void inside_meansTheWholeCircle() {
    // Fronto-parallel, 400 px/m: the board's 3x2 circles of 8 px radius lie 20 px
    // apart around the image's middle.
    Scenario scenario = test::stillScenario();
    QCOMPARE(circlesInView(SinusoidMotion(scenario), scenario, 0, 0.5), 6);
    QVERIFY(boardInView(SinusoidMotion(scenario), scenario, 0, 0.5));
    // Columns at x = c + {-30, 10} and, in the middle row, {-10, 30}: 37.5 px left of the
    // middle cuts into the first.
    scenario.cameras[0].intrinsics.principal_point_px.x() = 37.5;
    QCOMPARE(circlesInView(SinusoidMotion(scenario), scenario, 0, 0.5), 4);
    scenario.cameras[0].intrinsics.principal_point_px.x() = 38.5;
    QCOMPARE(circlesInView(SinusoidMotion(scenario), scenario, 0, 0.5), 6);
    scenario.cameras[0].intrinsics.principal_point_px.x() = -2.0;
    QVERIFY(!boardInView(SinusoidMotion(scenario), scenario, 0, 0.5));
  }
  void observations_scatterAsTheirCovarianceSays() {
    Scenario scenario = test::wavedScenario();
    scenario.duration_s = 10.0;
    const SinusoidMotion motion(scenario);
    const BoardObservations observations = simulateObservations(scenario, 0, 0.1, 0.02);
    QVERIFY(observations.views.size() > 400);
    double squares = 0.0;
    int count = 0;
    for (const BoardView& view : observations.views) {
      const std::vector<TrueCircle> truth = trueBoardView(motion, scenario, 0, view.time_s);
      for (const CircleObservation& circle : view.circles) {
        const TrueCircle& actual = truth[static_cast<std::size_t>(circle.circle)];
        QVERIFY(actual.inside);
        const Eigen::Vector2d error = circle.centre_px - actual.centre_px;
        squares += error.dot(circle.covariance_px2.inverse() * error);
        count += 2;
      }
    }
    QVERIFY(std::abs(squares / count - 1.0) < 0.1);
  }
};

EVICAL_TEST(TestBoardTruth)
#include "tst_board_truth.moc"
