#include "core/synthetic/board_truth.h"
#include "core/synthetic/scene_renderer.h"
#include "tests/core/synthetic/scenarios.h"
#include "tests/support/test_program.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

using namespace evical;

namespace {

// Centre of the conic through the projections of many points of a circle.
Eigen::Vector2d centreByPoints(const RigidTransform& world_from_camera, const CameraIntrinsics& camera,
                               const Board& board, int circle) {
  constexpr int kPoints = 60;
  const Eigen::Vector2d middle = board.point_m(circle);
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

// Centroid of a circle's ink as rendered for the first camera, which is the ellipse's centre.
Eigen::Vector2d inkAt(const Scenario& scenario, const RigidTransform& world_from_camera,
                      const Eigen::Vector2d& about_px, int reach_px) {
  const SceneRenderer renderer(scenario, 0);
  const SceneRenderer::Instant instant = renderer.at(world_from_camera, 0.0);
  SceneRenderer::TileView view;
  std::array<float, SceneRenderer::kTile_px * SceneRenderer::kTile_px> shades;
  double all = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int row = 0; row < renderer.tileRows(); ++row) {
    for (int column = 0; column < renderer.tileColumns(); ++column) {
      const SceneRenderer::Tile tile = renderer.tile(column, row);
      renderer.look(tile, {&instant, &instant, &instant}, view);
      renderer.render(instant, tile, view, shades.data());
      for (int k = 0; k < tile.pixelCount(); ++k) {
        const Eigen::Vector2d pixel(tile.x_px + k % tile.width_px, tile.y_px + k / tile.width_px);
        if ((pixel - about_px).norm() > reach_px) continue;
        const double ink = scenario.scene.bright_reflectance - std::exp(shades[static_cast<std::size_t>(k)]);
        all += ink;
        sum += ink * pixel;
      }
    }
  }
  return sum / all;
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
    // Fronto-parallel, 400 px/m: the board's 3x2 circles of 8 px radius are 20 px apart around the image
    // centre.
    Scenario scenario = test::stillScenario();
    QCOMPARE(circlesInView(SinusoidMotion(scenario), scenario, 0, 0.5), 6);
    QVERIFY(boardInView(SinusoidMotion(scenario), scenario, 0, 0.5));
    // Columns at x = c + {-30, 10} and, in the middle row, {-10, 30}: a border at 37.5 px left of the centre
    // cuts the first one.
    scenario.cameras[0].intrinsics.principal_point_px.x() = 37.5;
    QCOMPARE(circlesInView(SinusoidMotion(scenario), scenario, 0, 0.5), 4);
    scenario.cameras[0].intrinsics.principal_point_px.x() = 38.5;
    QCOMPARE(circlesInView(SinusoidMotion(scenario), scenario, 0, 0.5), 6);
    scenario.cameras[0].intrinsics.principal_point_px.x() = -2.0;
    QVERIFY(!boardInView(SinusoidMotion(scenario), scenario, 0, 0.5));
  }
  // Points of the bent sheet, each projected separately.
  void bentBoard_isSeenWhereItsPointsAre() {
    Scenario scenario = test::wavedScenario();
    const SinusoidMotion motion(scenario);
    scenario.board_bow = {0.001, -0.002, 0.0015};
    scenario.board.radius_m = 1e-3;  // so small that the mean of the points' images is the ellipse's centre
    const CameraIntrinsics& camera = scenario.cameras[0].intrinsics;
    const Eigen::Vector2d extent = scenario.board.extent_m();
    const double rows = 8.0 * 0.001 / (extent.x() * extent.x()),
                 columns = -8.0 * 0.002 / (extent.y() * extent.y()),
                 twist = 4.0 * 0.0015 / (extent.x() * extent.y());
    const double stamp_s = 0.7, world_s = stamp_s - scenario.cameras[0].pixel.delay_s();
    for (const TrueCircle& circle : trueBoardView(motion, scenario, 0, stamp_s)) {
      const Eigen::Vector2d middle = scenario.board.point_m(circle.circle);
      Eigen::Vector2d mean = Eigen::Vector2d::Zero();
      constexpr int kPoints = 40;
      for (int k = 0; k < kPoints; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kPoints;
        const double x = middle.x() + 1e-3 * std::cos(angle), y = middle.y() + 1e-3 * std::sin(angle);
        const Eigen::Vector3d point(x, y, 0.5 * (rows * x * x + columns * y * y) + twist * x * y);
        const Eigen::Vector2d ray = (inverse(motion.worldFromCamera(0, world_s)) * point).hnormalized();
        mean += (ray.cwiseProduct(camera.focal_length_px) + camera.principal_point_px) / kPoints;
      }
      QVERIFY2((circle.centre_px - mean).norm() < 1e-3,
               qPrintable(QString::number((circle.centre_px - mean).norm())));
    }
  }
  void bentBoard_isRenderedWhereItsTruthIs() {
    Scenario scenario = test::stillScenario();
    scenario.scene.margin_m = 0.2;  // only paper around each circle
    scenario.motion.angle_amplitude_rad = {0.3, 0.3, 0.3};
    const SinusoidMotion motion(scenario);
    const double stamp_s = 0.3;
    const RigidTransform pose = motion.worldFromCamera(0, stamp_s - scenario.cameras[0].pixel.delay_s());
    const std::vector<TrueCircle> flat = trueBoardView(motion, scenario, 0, stamp_s);
    double farthest_px = 0.0;
    for (const double height_m : {0.0, 0.001}) {
      scenario.board_bow = {height_m, -height_m, height_m};
      for (const TrueCircle& truth : trueBoardView(motion, scenario, 0, stamp_s)) {
        if (!truth.inside) continue;
        const Eigen::Vector2d ink = inkAt(scenario, pose, truth.centre_px, 12);
        QVERIFY2((ink - truth.centre_px).norm() < 0.02,
                 qPrintable(QString("%1 mm: %2 px").arg(1e3 * height_m).arg((ink - truth.centre_px).norm())));
        const Eigen::Vector2d moved =
            truth.centre_px - flat[static_cast<std::size_t>(truth.circle)].centre_px;
        farthest_px = std::max(farthest_px, moved.norm());
      }
    }
    QVERIFY2(farthest_px > 0.2, qPrintable(QString::number(farthest_px)));
  }
  // The hand hides everything behind it at any position; it comes and goes.
  void circlesBehindAHand_areHidden() {
    Scenario scenario = test::stillScenario();
    scenario.duration_s = 30.0;
    scenario.scene.hand.every_s = 3.0;
    const SinusoidMotion motion(scenario);
    int all = 0, some = 0, last = 6, changes = 0;
    for (double time_s = 0.0; time_s < scenario.duration_s; time_s += 0.05) {
      const int visible = circlesInView(motion, scenario, 0, time_s);
      all += visible == 6;
      some += visible < 6;
      changes += (visible == 6) != (last == 6);
      last = visible;
    }
    // It stays for 1 s of 3 s, and comes and goes for 1.6 s more.
    QVERIFY2(some > 150 && some < 500 && all > 100, qPrintable(QString("%1 and %2").arg(some).arg(all)));
    QVERIFY(changes >= 18);  // ten visits
    for (const BoardView& view : simulateObservations(scenario, 0, 0.05, 0.02).views)
      for (const TrueCircle& truth : trueBoardView(motion, scenario, 0, view.time_s))
        QVERIFY(!truth.hidden || std::none_of(view.circles.begin(), view.circles.end(),
                                              [&](const auto& seen) { return seen.circle == truth.circle; }));
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
