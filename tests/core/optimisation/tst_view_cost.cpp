// Derivatives of the circles' cost against numeric differences, and its residuals for known rigs.
#include "core/geometry/camera_motion.h"
#include "core/geometry/circle_conic.h"
#include "core/geometry/trajectory.h"
#include "tests/core/optimisation/residual_states.h"
#include "tests/support/test_program.h"

#include <Eigen/Cholesky>

namespace {

using namespace evical;
using namespace evical::test;

// A displacement field of two modes for circlesNear.
CircleModel displacedModel() {
  CircleModel model = circleModel();
  model.modes.resize(3, 2);
  model.modes << 1.0, 0.0, 0.8, 0.6, 0.3, 0.9;
  return model;
}

std::vector<CircleMeasurement> displaced(std::vector<CircleMeasurement> circles) {
  for (std::size_t i = 0; i < circles.size(); ++i) {
    circles[i].point = static_cast<int>(i);
    circles[i].rho = 2.0 + static_cast<double>(i);
  }
  return circles;
}

// Derivatives of all circles by control points and the camera's pose.
Eigen::MatrixXd byPoints(const ViewCost& cost, const Blocks& blocks) {
  std::vector<const double*> pointers;
  for (const std::vector<double>& block : blocks) pointers.push_back(block.data());
  std::vector<int> widths(blocks.size() - cost.controlPoints());
  widths[0] = widths[1] = 3;
  ViewRows rows;
  cost.evaluate(pointers.data(), widths, rows);
  const Eigen::MatrixXd poses =
      Eigen::Map<const ViewRows::RowMajorMatrix>(rows.values.data(), cost.num_residuals(), rows.stride)
          .leftCols(rows.poses);
  return rows.chain.size() > 0 ? poses * rows.chain : poses;
}

// With one more control point of each spline, at time offset 0.
Blocks twoSegments(States& states) {
  Blocks blocks = circleBlocks(states, 0.05);
  const Eigen::Quaterniond last(blocks[3].data());
  blocks.insert(blocks.begin() + 8, States::numbers(Vector3d(blocks[7].data()) + states.vector(0.02)));
  blocks.insert(blocks.begin() + 4,
                States::numbers((last * quaternionExp(0.05 * states.vector(1.0))).normalized()));
  for (const std::size_t of_time : {12U, 13U, 14U, 22U}) blocks[of_time] = {0.0};
  return blocks;
}

class TestViewCost : public QObject {
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
      const ViewCost cost = exactCost(model, circlesNear(model, blocks, near_sigma, states));
      const double error = worstJacobianError(cost, blocks, 2e-5);
      QVERIFY2(error < 1e-6, qPrintable(QString::number(error)));
      QCOMPARE(worstErrorWithConstantBlocks(cost, blocks), 0.0);
    }
  }

  void jacobiansWithADisplacementField_matchNumericDifferences() {
    for (const double near_sigma : {0.5, 30.0}) {
      States states(7);
      const CircleModel model = displacedModel();
      const Blocks blocks = circleBlocks(states, 0.05);
      const ViewCost cost = exactCost(model, displaced(circlesNear(model, blocks, near_sigma, states)));
      const double error = worstJacobianError(cost, blocks, 1e-5);
      QVERIFY2(error < 1e-6, qPrintable(QString::number(error)));
    }
  }

  // The squared residuals of a view are r^T (I + B B^T)^-1 r.
  void displacementField_isMarginalised() {
    States states(9);
    CircleModel model = displacedModel();
    model.huber_sigma = 1e9;
    const Blocks blocks = circleBlocks(states, 0.05);
    const std::vector<CircleMeasurement> circles = displaced(circlesNear(model, blocks, 2.0, states));
    const double squares = residualsAt(exactCost(model, circles), blocks).squaredNorm();
    CircleModel without = model;
    without.modes.resize(0, 0);
    const Eigen::VectorXd apart = residualsAt(exactCost(without, circles), blocks);
    Eigen::MatrixXd roots = Eigen::MatrixXd::Zero(apart.size(), 4);
    for (Eigen::Index i = 0; i < 3; ++i)
      for (const Eigen::Index axis : {0, 1})
        roots.block<1, 2>(2 * i + axis, 2 * axis) =
            circles[static_cast<std::size_t>(i)].rho * model.modes.row(i);
    const Eigen::MatrixXd covariance =
        Eigen::MatrixXd::Identity(apart.size(), apart.size()) + roots * roots.transpose();
    const double expected = apart.dot(covariance.llt().solve(apart));
    QVERIFY2(expected < 0.95 * apart.squaredNorm(),
             qPrintable(QString::number(expected / apart.squaredNorm())));
    QVERIFY(std::abs(squares - expected) < 1e-9 * expected);
  }

  // A step of the trajectory that moves the image by 1 px is predicted to 1e-3 px, for the longest views of
  // one, two and three times, across a knot and away from it.
  void posesAtTimes_predictSteps_data() {
    QTest::addColumn<double>("length_knots");
    QTest::addColumn<double>("middle_knots");
    const auto& longest = PoseTimes::kLongest_knots;
    for (const double length_knots : {0.0, longest[0], longest[1], longest[2]})
      for (const double middle_knots : {0.5, 0.95, 1.0})
        QTest::addRow("%g knots around %g", length_knots, middle_knots) << length_knots << middle_knots;
  }
  void posesAtTimes_predictSteps() {
    QFETCH(double, length_knots);
    QFETCH(double, middle_knots);
    for (unsigned seed = 1; seed <= 20; ++seed) {
      States states(seed);
      CircleModel model = circleModel();
      model.huber_sigma = 1e9;
      Blocks blocks = twoSegments(states);
      std::vector<CircleMeasurement> circles = circlesNear(model, circleBlocks(states, 0.05), 0.5, states);
      for (std::size_t i = 0; i < circles.size(); ++i) {
        circles[i].whitening_px.setIdentity();
        circles[i].time_s =
            1.0 + kSpacing_s * (middle_knots + 0.499999 * length_knots * (static_cast<double>(i) - 1.0));
      }
      SegmentTimes segments = segmentTimes();
      segments.position_start_s = segments.rotation_start_s;
      segments.position_spacing_s = segments.rotation_spacing_s;
      segments.rotations = segments.positions = 2;
      const auto derivatives = [&](ViewCost::PoseColumns columns) {
        return byPoints(ViewCost(model, segments, circles, columns), blocks);
      };
      const Eigen::MatrixXd exact = derivatives(ViewCost::PoseColumns::ControlPoints),
                            at_times = derivatives(ViewCost::PoseColumns::AtTimes);
      Eigen::VectorXd step(exact.cols());
      for (double& each : step) each = states.uniform(1.0);
      step /= (exact * step).cwiseAbs().maxCoeff();
      const double error_px = ((at_times - exact) * step).cwiseAbs().maxCoeff();
      QVERIFY2(error_px < 1e-3, qPrintable(QString::number(error_px)));
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
      const ViewCost cost = exactCost(model, circles);
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
      const Eigen::VectorXd expected = residualsAt(exactCost(held, circles), blocks);
      blocks.push_back(intrinsicsNumbers(model.camera));
      const Eigen::VectorXd residuals = residualsAt(exactCost(model, circles), blocks);
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
      const Eigen::Vector2d ideal = residualsAt(exactCost(linear, {circle}), blocks);
      circle.centre_px = *idealPixel(model.camera, pixelFromIdeal(truth, ideal));
      QVERIFY((circle.centre_px - ideal).norm() > 0.1);
      blocks.push_back(intrinsicsNumbers(truth));
      const double residual = residualsAt(exactCost(model, {circle}), blocks).norm();
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
    QVERIFY(residualsAt(exactCost(model, {circle}), blocks).norm() < 1e-9);
  }

  void circle_behindTheCamera_isFiniteAndFarOff() {
    States states(3);
    const CircleModel model = circleModel();
    Blocks blocks = circleBlocks(states, 0.0);
    const ViewCost cost = exactCost(model, circlesNear(model, blocks, 0.5, states));
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

EVICAL_TEST(TestViewCost)
#include "tst_view_cost.moc"
