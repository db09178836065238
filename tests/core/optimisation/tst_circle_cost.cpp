// Derivatives of the circles' cost against numeric differences, and its residuals for known rigs.
#include "core/geometry/circle_conic.h"
#include "core/geometry/trajectory.h"
#include "tests/core/optimisation/residual_states.h"
#include "tests/support/test_program.h"

#include <Eigen/Cholesky>

namespace {

using namespace evical;
using namespace evical::test;

constexpr double kCommon_px = 0.5;

std::vector<CircleMeasurement> inTwoViews(std::vector<CircleMeasurement> circles) {
  for (std::size_t i = 0; i < circles.size(); ++i) {
    circles[i].view = static_cast<int>(i % 2);
    circles[i].common_px = kCommon_px;
  }
  return circles;
}

class TestCircleCost : public QObject {
  Q_OBJECT

 private slots:
  void circleJacobians_matchNumericDifferences_data() {
    QTest::addColumn<double>("step_rad");
    QTest::addColumn<double>("near_sigma");
    QTest::newRow("still, inliers") << 0.0 << 0.5;
    QTest::newRow("tiny rotations, inliers") << 1e-7 << 0.5;
    QTest::newRow("moving, inliers") << 0.05 << 0.5;
    QTest::newRow("fast, inliers") << 0.5 << 0.5;
    QTest::newRow("moving, outliers") << 0.05 << 30.0;
  }

  void circleJacobians_matchNumericDifferences() {
    QFETCH(double, step_rad);
    QFETCH(double, near_sigma);
    for (unsigned seed = 1; seed <= 5; ++seed) {
      States states(seed);
      const CircleModel model = circleModel();
      const Blocks blocks = circleBlocks(states, step_rad);
      const CircleCost cost(model, segmentTimes(), circlesNear(model, blocks, near_sigma, states));
      const double error = worstJacobianError(cost, blocks, 1e-5);
      QVERIFY2(error < 1e-6, qPrintable(QString::number(error)));
      QCOMPARE(worstErrorWithConstantBlocks(cost, blocks), 0.0);
    }
  }

  // Circles of two views, each with a displacement in common.
  void jacobiansWithCommonDisplacements_matchNumericDifferences() {
    for (const double near_sigma : {0.5, 30.0}) {
      States states(7);
      const CircleModel model = circleModel();
      const Blocks blocks = circleBlocks(states, 0.05);
      const CircleCost cost(model, segmentTimes(),
                            inTwoViews(circlesNear(model, blocks, near_sigma, states)));
      const double error = worstJacobianError(cost, blocks, 1e-5);
      QVERIFY2(error < 1e-6, qPrintable(QString::number(error)));
    }
  }

  // The squared residuals of a view are r^T (I + B B^T)^-1 r.
  void commonDisplacement_isMarginalised() {
    States states(8);
    CircleModel model = circleModel();
    model.huber_sigma = 1e9;
    const Blocks blocks = circleBlocks(states, 0.05);
    std::vector<CircleMeasurement> circles = inTwoViews(circlesNear(model, blocks, 2.0, states));
    const Eigen::VectorXd whitened = residualsAt(CircleCost(model, segmentTimes(), circles), blocks);
    for (CircleMeasurement& circle : circles) circle.common_px = 0.0;
    const Eigen::VectorXd apart = residualsAt(CircleCost(model, segmentTimes(), circles), blocks);
    const auto count = static_cast<Eigen::Index>(circles.size());
    for (const int view : {0, 1}) {
      Eigen::MatrixXd roots = Eigen::MatrixXd::Zero(2 * count, 2);
      Eigen::VectorXd of_view = Eigen::VectorXd::Zero(2 * count);
      double squares = 0.0;
      for (Eigen::Index i = 0; i < count; ++i) {
        const CircleMeasurement& circle = circles[static_cast<std::size_t>(i)];
        if (circle.view != view) continue;
        roots.middleRows<2>(2 * i) = kCommon_px * circle.whitening_px;
        of_view.segment<2>(2 * i) = apart.segment<2>(2 * i);
        squares += whitened.segment<2>(2 * i).squaredNorm();
      }
      const Eigen::MatrixXd covariance =
          Eigen::MatrixXd::Identity(2 * count, 2 * count) + roots * roots.transpose();
      const double expected = of_view.dot(covariance.llt().solve(of_view));
      QVERIFY(expected < 0.95 * of_view.squaredNorm());
      QVERIFY(std::abs(squares - expected) < 1e-9 * expected);
    }
  }

  void freeIntrinsicsJacobians_matchNumericDifferences_data() {
    QTest::addColumn<int>("lens");
    QTest::addColumn<double>("near_sigma");
    for (const double near_sigma : {0.5, 30.0}) {
      QTest::addRow("radtan, %g sigma", near_sigma)
          << static_cast<int>(CameraModel::PinholeRadtan) << near_sigma;
      QTest::addRow("equidistant, %g sigma", near_sigma)
          << static_cast<int>(CameraModel::PinholeEquidistant) << near_sigma;
    }
  }

  void freeIntrinsicsJacobians_matchNumericDifferences() {
    QFETCH(int, lens);
    QFETCH(double, near_sigma);
    for (unsigned seed = 1; seed <= 5; ++seed) {
      States states(seed);
      const CircleModel model = freeModel(static_cast<CameraModel>(lens));
      Blocks blocks = circleBlocks(states, 0.05);
      const CircleModel held = heldModel(model);
      const std::vector<CircleMeasurement> circles = circlesNear(held, blocks, near_sigma, states);
      blocks.push_back(intrinsicsNumbers(otherLens(model.camera, states)));
      const CircleCost cost(model, segmentTimes(), circles);
      const double error = worstJacobianError(cost, blocks, 1e-5);
      QVERIFY2(error < 1e-6, qPrintable(QString::number(error)));
      QCOMPARE(worstErrorWithConstantBlocks(cost, blocks), 0.0);
    }
  }

  // If the intrinsics are those of the front end, it must not matter whether they are free or fixed.
  void freeIntrinsics_ofTheCameraSeenWith_giveTheSameResiduals() {
    for (const CameraModel lens : {CameraModel::PinholeRadtan, CameraModel::PinholeEquidistant}) {
      States states(5);
      const CircleModel model = freeModel(lens), held = heldModel(model);
      Blocks blocks = circleBlocks(states, 0.05);
      const std::vector<CircleMeasurement> circles = circlesNear(held, blocks, 0.5, states);
      const Eigen::VectorXd expected = residualsAt(CircleCost(held, segmentTimes(), circles), blocks);
      blocks.push_back(intrinsicsNumbers(model.camera));
      const Eigen::VectorXd residuals = residualsAt(CircleCost(model, segmentTimes(), circles), blocks);
      QVERIFY(expected.norm() > 0.3);
      QVERIFY2((residuals - expected).norm() < 5e-3 * expected.norm(),
               qPrintable(QString::number((residuals - expected).norm())));
    }
  }

  // A centre at a pixel of the true lens, in the ideal pixels of another.
  void freeIntrinsics_ofTheTrueCamera_leaveNoResidual() {
    for (const CameraModel lens : {CameraModel::PinholeRadtan, CameraModel::PinholeEquidistant}) {
      States states(6);
      const CircleModel model = freeModel(lens);
      const CameraIntrinsics truth = otherLens(model.camera, states);
      Blocks blocks = circleBlocks(states, 0.05);
      CircleModel linear = heldModel(model);
      linear.camera = truth;
      linear.huber_sigma = 1e9;
      CircleMeasurement circle;
      circle.time_s = 1.006;
      circle.on_board_m = {0.1, 0.05};
      circle.centre_px.setZero();
      circle.whitening_px.setIdentity();
      circle.lead = {{0.0, 0.0}, {0.0, 0.0}};
      const Eigen::Vector2d ideal = residualsAt(CircleCost(linear, segmentTimes(), {circle}), blocks);
      circle.centre_px = *idealPixel(model.camera, pixelFromIdeal(truth, ideal));
      QVERIFY((circle.centre_px - ideal).norm() > 0.1);
      blocks.push_back(intrinsicsNumbers(truth));
      const double residual = residualsAt(CircleCost(model, segmentTimes(), {circle}), blocks).norm();
      QVERIFY2(residual < 1e-8, qPrintable(QString::number(residual)));
    }
  }

  void circleResidual_isZeroForTheTrueRig() {
    States states(3);
    const CircleModel model = circleModel();
    const Blocks blocks = circleBlocks(states, 0.05);
    So3Spline rotation{1.0, kSpacing_s, {}};
    VectorSpline position{0.99, 1.5 * kSpacing_s, {}};
    for (std::size_t k = 0; k < 4; ++k) {
      rotation.control_points.emplace_back(blocks[k].data());
      position.control_points.emplace_back(blocks[4 + k].data());
    }
    const RigidTransform reference_from_camera = {Eigen::Quaterniond(blocks[8].data()),
                                                  Vector3d(blocks[9].data())};
    const RigidTransform camera_from_world = cameraFromWorld(
        rotation, position, reference_from_camera,
        blocks[10][0] + 0.003 * blocks[11][0] - 8e-5 * blocks[12][0] + 2e-3 * blocks[20][0], 1.006);
    CircleMeasurement circle;
    circle.time_s = 1.006;
    circle.on_board_m = {0.1, 0.05};
    circle.whitening_px.setIdentity();
    circle.by_drift_s = 0.003;
    circle.by_line_s = -8e-5;
    circle.by_exposure_s = 2e-3;
    circle.lead = {{0.8, 0.6}, {0.4, 0.3}};
    const BoardState board{
        blocks[15][0], blocks[16][0], blocks[17][0],
        blocks[18][0], blocks[19][0], {Eigen::Quaterniond(blocks[21].data()), Vector3d(blocks[22].data())},
    };
    circle.centre_px = projectCircle(model.camera, camera_from_world * board.place_m(circle.on_board_m),
                                     camera_from_world.rotation * board.normal(), model.radius_m)
                           ->centre_px +
                       blocks[13][0] * circle.lead.of_lead + blocks[14][0] * circle.lead.of_slow;
    QVERIFY(residualsAt(CircleCost(model, segmentTimes(), {circle}), blocks).norm() < 1e-9);
  }

  void circle_behindTheCamera_isFiniteAndFarOff() {
    States states(3);
    const CircleModel model = circleModel();
    Blocks blocks = circleBlocks(states, 0.0);
    const CircleCost cost(model, segmentTimes(), circlesNear(model, blocks, 0.5, states));
    for (std::size_t k = 4; k < 8; ++k) blocks[k][2] = 2.0;
    QVERIFY(residualsAt(cost, blocks).allFinite());
    QVERIFY(residualsAt(cost, blocks).norm() > 100.0);
    QCOMPARE(worstJacobianError(cost, blocks), 0.0);
  }

  void huber_squareIsTheLoss() {
    for (const double length : {0.1, 2.4, 2.6, 40.0}) {
      Eigen::Vector2d residual = length * Eigen::Vector2d(0.6, -0.8);
      shortenByHuber(2.5, residual);
      const double loss = length <= 2.5 ? length * length : 2.0 * 2.5 * length - 2.5 * 2.5;
      QVERIFY(std::abs(residual.squaredNorm() - loss) < 1e-12 * (1.0 + loss));
    }
  }
};

}  // namespace

EVICAL_TEST(TestCircleCost)
#include "tst_circle_cost.moc"
