// Every derivative of the batch's cost functions against numeric differences, and what the residuals say of
// known motions.
#include "core/geometry/circle_conic.h"
#include "core/geometry/so3.h"
#include "core/geometry/trajectory.h"
#include "core/optimisation/bias_knots.h"
#include "core/optimisation/circle_cost.h"
#include "core/optimisation/inertial_cost.h"
#include "core/optimisation/prior_cost.h"
#include "core/optimisation/smoothness_cost.h"
#include "tests/core/optimisation/cost_check.h"
#include "tests/support/test_program.h"

#include <random>

namespace {

using namespace evical;
using Eigen::Vector3d;

constexpr double kSpacing_s = 0.02;

class States {
 public:
  explicit States(unsigned seed) : random_(seed) {}
  double uniform(double size) { return std::uniform_real_distribution<double>(-size, size)(random_); }
  Vector3d vector(double size) { return {uniform(size), uniform(size), uniform(size)}; }

  void appendRotations(double step_rad, test::Blocks& blocks) {
    Eigen::Quaterniond rotation = quaternionExp(vector(0.4));
    for (int k = 0; k < 4; ++k) {
      blocks.push_back(numbers(rotation));
      rotation = (rotation * quaternionExp(step_rad * vector(1.0).normalized())).normalized();
    }
  }
  void appendPositions(test::Blocks& blocks) {
    Vector3d position = Vector3d(0.1, 0.2, -0.7) + vector(0.1);
    for (int k = 0; k < 4; ++k) {
      blocks.push_back({position.x(), position.y(), position.z()});
      position += vector(0.02);
    }
  }
  static std::vector<double> numbers(const Eigen::Quaterniond& q) { return {q.x(), q.y(), q.z(), q.w()}; }
  static std::vector<double> numbers(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

 private:
  std::mt19937_64 random_;
};

CircleModel circleModel() {
  CircleModel model;
  model.camera = {CameraModel::PinholeRadtan, {346, 260}, {260.0, 255.0}, {170.0, 131.0}, {}};
  model.radius_m = 0.02;
  model.huber_sigma = 2.5;
  return model;
}

SegmentTimes segmentTimes() {
  SegmentTimes segment;
  segment.rotation_start_s = 1.0;
  segment.position_start_s = 0.99;  // splines need not share their knots
  segment.rotation_spacing_s = kSpacing_s;
  segment.position_spacing_s = 1.5 * kSpacing_s;
  return segment;
}

std::vector<double> mappingNumbers(States& states) {
  return {1.0 + states.uniform(0.05), states.uniform(0.05), states.uniform(0.05),
          1.0 + states.uniform(0.05), states.uniform(0.05), 1.0 + states.uniform(0.05)};
}

test::Blocks circleBlocks(States& states, double step_rad) {
  test::Blocks blocks;
  states.appendRotations(step_rad, blocks);
  states.appendPositions(blocks);
  blocks.push_back(States::numbers(quaternionExp(states.vector(0.2))));
  blocks.push_back(States::numbers(states.vector(0.05)));
  blocks.push_back({states.uniform(0.004)});
  blocks.push_back({states.uniform(0.3)});
  blocks.push_back({states.uniform(0.3)});
  return blocks;
}

// `near_sigma`: about how far the measured centres lie from the predicted ones.
std::vector<CircleMeasurement> circlesNear(const CircleModel& model, const test::Blocks& blocks,
                                           double near_sigma, States& states) {
  std::vector<CircleMeasurement> circles(3);
  for (std::size_t i = 0; i < circles.size(); ++i) {
    circles[i].time_s = 1.004 + 0.005 * static_cast<double>(i);
    circles[i].on_board_m = {0.1 * static_cast<double>(i), 0.05 * static_cast<double>(i)};
    circles[i].centre_px.setZero();
    circles[i].whitening_px.setIdentity();
    circles[i].lead = {{0.6, -0.5}, {-0.3, 0.25}};
  }
  CircleModel linear = model;
  linear.huber_sigma = 1e9;
  const Eigen::VectorXd centres = test::residualsAt(CircleCost(linear, segmentTimes(), circles), blocks);
  for (std::size_t i = 0; i < circles.size(); ++i) {
    circles[i].whitening_px << 12.0, 0.0, -3.0, 9.0;
    circles[i].centre_px = centres.segment<2>(static_cast<Eigen::Index>(2 * i)) +
                           near_sigma / 10.0 * states.vector(1.0).normalized().head<2>();
  }
  return circles;
}

// The same circles as seen through a lens that is not quite the one in the block of intrinsics.
CircleModel freeModel(CameraModel lens) {
  CircleModel model = circleModel();
  model.camera.model = lens;
  model.camera.distortion = lens == CameraModel::PinholeRadtan ? std::array{-0.31, 0.11, 2e-3, -1e-3, 0.02}
                                                               : std::array{-0.04, 0.02, -0.01, 3e-3, 0.0};
  model.free_intrinsics = true;
  return model;
}

CircleModel heldModel(CircleModel model) {
  model.free_intrinsics = false;
  return model;
}

std::vector<double> intrinsicsNumbers(const CameraIntrinsics& camera) {
  std::vector<double> numbers(9);
  writeIntrinsics(camera, numbers.data());
  return numbers;
}

CameraIntrinsics otherLens(const CameraIntrinsics& camera, States& states) {
  CameraIntrinsics other = camera;
  other.focal_length_px += states.vector(2.0).head<2>();
  other.principal_point_px += states.vector(2.0).head<2>();
  for (std::size_t k = 0; k < 4; ++k) other.distortion[k] += states.uniform(2e-3);
  return other;
}

class TestResiduals : public QObject {
  Q_OBJECT

 private slots:
  void manifold_plusAndMinusAreInverse() {
    States states(1);
    const auto x = States::numbers(quaternionExp(states.vector(2.0)));
    const Vector3d delta = states.vector(0.5);
    double y[4];
    Vector3d back;
    So3Manifold().Plus(x.data(), delta.data(), y);
    So3Manifold().Minus(y, x.data(), back.data());
    QVERIFY((back - delta).norm() < 1e-12);
  }

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
      const test::Blocks blocks = circleBlocks(states, step_rad);
      const CircleCost cost(model, segmentTimes(), circlesNear(model, blocks, near_sigma, states));
      const double error = test::worstJacobianError(cost, blocks, 1e-5);
      QVERIFY2(error < 1e-6, qPrintable(QString::number(error)));
      QCOMPARE(test::worstErrorWithConstantBlocks(cost, blocks), 0.0);
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
      test::Blocks blocks = circleBlocks(states, 0.05);
      const CircleModel held = heldModel(model);
      const std::vector<CircleMeasurement> circles = circlesNear(held, blocks, near_sigma, states);
      blocks.push_back(intrinsicsNumbers(otherLens(model.camera, states)));
      const CircleCost cost(model, segmentTimes(), circles);
      const double error = test::worstJacobianError(cost, blocks, 1e-5);
      QVERIFY2(error < 1e-6, qPrintable(QString::number(error)));
      QCOMPARE(test::worstErrorWithConstantBlocks(cost, blocks), 0.0);
    }
  }

  // Where the intrinsics are those seen with, what is free or held must not matter.
  void freeIntrinsics_ofTheCameraSeenWith_giveTheSameResiduals() {
    for (const CameraModel lens : {CameraModel::PinholeRadtan, CameraModel::PinholeEquidistant}) {
      States states(5);
      const CircleModel model = freeModel(lens), held = heldModel(model);
      test::Blocks blocks = circleBlocks(states, 0.05);
      const std::vector<CircleMeasurement> circles = circlesNear(held, blocks, 0.5, states);
      const Eigen::VectorXd expected = test::residualsAt(CircleCost(held, segmentTimes(), circles), blocks);
      blocks.push_back(intrinsicsNumbers(model.camera));
      const Eigen::VectorXd residuals = test::residualsAt(CircleCost(model, segmentTimes(), circles), blocks);
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
      test::Blocks blocks = circleBlocks(states, 0.05);
      CircleModel linear = heldModel(model);
      linear.camera = truth;
      linear.huber_sigma = 1e9;
      CircleMeasurement circle;
      circle.time_s = 1.006;
      circle.on_board_m = {0.1, 0.05};
      circle.centre_px.setZero();
      circle.whitening_px.setIdentity();
      circle.lead = {{0.0, 0.0}, {0.0, 0.0}};
      const Eigen::Vector2d ideal = test::residualsAt(CircleCost(linear, segmentTimes(), {circle}), blocks);
      circle.centre_px = *idealPixel(model.camera, pixelFromIdeal(truth, ideal));
      QVERIFY((circle.centre_px - ideal).norm() > 0.1);
      blocks.push_back(intrinsicsNumbers(truth));
      const double residual = test::residualsAt(CircleCost(model, segmentTimes(), {circle}), blocks).norm();
      QVERIFY2(residual < 1e-8, qPrintable(QString::number(residual)));
    }
  }

  void circleResidual_isZeroForTheTrueRig() {
    States states(3);
    const CircleModel model = circleModel();
    const test::Blocks blocks = circleBlocks(states, 0.05);
    So3Spline rotation{1.0, kSpacing_s, {}};
    VectorSpline position{0.99, 1.5 * kSpacing_s, {}};
    for (std::size_t k = 0; k < 4; ++k) {
      rotation.control_points.emplace_back(blocks[k].data());
      position.control_points.emplace_back(blocks[4 + k].data());
    }
    const RigidTransform reference_from_camera = {Eigen::Quaterniond(blocks[8].data()),
                                                  Vector3d(blocks[9].data())};
    const RigidTransform camera_from_world =
        cameraFromWorld(rotation, position, reference_from_camera, blocks[10][0], 1.006);
    CircleMeasurement circle;
    circle.time_s = 1.006;
    circle.on_board_m = {0.1, 0.05};
    circle.whitening_px.setIdentity();
    circle.lead = {{0.8, 0.6}, {0.4, 0.3}};
    circle.centre_px =
        *projectedCircleCentre(model.camera, camera_from_world, circle.on_board_m, model.radius_m) +
        blocks[11][0] * circle.lead.of_lead + blocks[12][0] * circle.lead.of_growth;
    QVERIFY(test::residualsAt(CircleCost(model, segmentTimes(), {circle}), blocks).norm() < 1e-9);
  }

  void circle_behindTheCamera_isFiniteAndFarOff() {
    States states(3);
    const CircleModel model = circleModel();
    test::Blocks blocks = circleBlocks(states, 0.0);
    const CircleCost cost(model, segmentTimes(), circlesNear(model, blocks, 0.5, states));
    for (std::size_t k = 4; k < 8; ++k) blocks[k][2] = 2.0;
    QVERIFY(test::residualsAt(cost, blocks).allFinite());
    QVERIFY(test::residualsAt(cost, blocks).norm() > 100.0);
    QCOMPARE(test::worstJacobianError(cost, blocks), 0.0);
  }

  void huber_squareIsTheLoss() {
    for (const double length : {0.1, 2.4, 2.6, 40.0}) {
      Eigen::Vector2d residual = length * Eigen::Vector2d(0.6, -0.8);
      shortenByHuber(2.5, residual);
      const double loss = length <= 2.5 ? length * length : 2.0 * 2.5 * length - 2.5 * 2.5;
      QVERIFY(std::abs(residual.squaredNorm() - loss) < 1e-12 * (1.0 + loss));
    }
  }

  void gyroscopeJacobians_matchNumericDifferences_data() {
    QTest::addColumn<bool>("further");
    QTest::addColumn<double>("step_rad");
    for (const bool further : {false, true}) {
      for (const double step : {0.0, 1e-7, 0.05, 1.0}) {
        QTest::addRow("%s imu, step %g", further ? "further" : "reference", step) << further << step;
      }
    }
  }

  void gyroscopeJacobians_matchNumericDifferences() {
    QFETCH(bool, further);
    QFETCH(double, step_rad);
    States states(5);
    test::Blocks blocks;
    states.appendRotations(step_rad, blocks);
    blocks.push_back(States::numbers(states.vector(0.1)));
    blocks.push_back(mappingNumbers(states));
    blocks.push_back(States::numbers(quaternionExp(states.vector(0.1))));
    if (further) {
      blocks.push_back(States::numbers(quaternionExp(states.vector(1.0))));
      blocks.push_back({states.uniform(0.002)});
    }
    const GyroscopeCost cost(
        further ? ImuRole::Further : ImuRole::Reference, 0.1, segmentTimes(),
        {{1.001, states.vector(1.0)}, {1.0, states.vector(1.0)}, {1.0199, states.vector(1.0)}});
    const double error = test::worstJacobianError(cost, blocks, 1e-3);
    QVERIFY2(error < 1e-7, qPrintable(QString::number(error)));
    QCOMPARE(test::worstErrorWithConstantBlocks(cost, blocks), 0.0);
  }

  void accelerometerJacobians_matchNumericDifferences_data() {
    gyroscopeJacobians_matchNumericDifferences_data();
  }

  void accelerometerJacobians_matchNumericDifferences() {
    QFETCH(bool, further);
    QFETCH(double, step_rad);
    States states(6);
    test::Blocks blocks;
    states.appendRotations(step_rad, blocks);
    states.appendPositions(blocks);
    blocks.push_back({0.3, 9.7, -0.5});
    blocks.push_back(States::numbers(states.vector(0.1)));
    blocks.push_back(mappingNumbers(states));
    if (further) {
      blocks.push_back(States::numbers(quaternionExp(states.vector(1.0))));
      blocks.push_back(States::numbers(states.vector(0.1)));
      blocks.push_back({states.uniform(0.002)});
    }
    const AccelerometerCost cost(further ? ImuRole::Further : ImuRole::Reference, 0.5, segmentTimes(),
                                 {{1.002, states.vector(10.0)}, {1.01, states.vector(10.0)}});
    const double error = test::worstJacobianError(cost, blocks, 1e-3);
    QVERIFY2(error < 1e-6, qPrintable(QString::number(error)));
    QCOMPARE(test::worstErrorWithConstantBlocks(cost, blocks), 0.0);
  }

  void driftJacobians_matchNumericDifferences() {
    const DriftTimes drift{0.99, 0.1};
    for (const bool further : {false, true}) {
      States states(7);
      test::Blocks blocks;
      states.appendRotations(0.05, blocks);
      const test::Blocks rotations = blocks;
      const ImuRole role = further ? ImuRole::Further : ImuRole::Reference;
      blocks.insert(blocks.end(), {States::numbers(states.vector(0.1)), mappingNumbers(states),
                                   States::numbers(quaternionExp(states.vector(0.1)))});
      if (further) blocks.insert(blocks.end(), {States::numbers(quaternionExp(states.vector(1.0))), {0.001}});
      blocks.insert(blocks.end(), {States::numbers(states.vector(0.1)), States::numbers(states.vector(0.1))});
      const GyroscopeCost gyroscope(role, 0.1, segmentTimes(),
                                    {{1.001, states.vector(1.0)}, {1.0199, states.vector(1.0)}}, drift);
      QVERIFY(test::worstJacobianError(gyroscope, blocks, 1e-3) < 1e-7);
      QCOMPARE(test::worstErrorWithConstantBlocks(gyroscope, blocks), 0.0);

      blocks = rotations;
      states.appendPositions(blocks);
      blocks.insert(blocks.end(),
                    {{0.3, 9.7, -0.5}, States::numbers(states.vector(0.1)), mappingNumbers(states)});
      if (further)
        blocks.insert(blocks.end(), {States::numbers(quaternionExp(states.vector(1.0))),
                                     States::numbers(states.vector(0.1)),
                                     {0.001}});
      blocks.insert(blocks.end(), {States::numbers(states.vector(0.1)), States::numbers(states.vector(0.1))});
      const AccelerometerCost accelerometer(
          role, 0.5, segmentTimes(), {{1.002, states.vector(10.0)}, {1.01, states.vector(10.0)}}, drift);
      QVERIFY(test::worstJacobianError(accelerometer, blocks, 1e-3) < 1e-6);
      QCOMPARE(test::worstErrorWithConstantBlocks(accelerometer, blocks), 0.0);
    }
  }

  void driftPriors_areZeroWithoutDrift() {
    BiasDrift drift{0.0, 2.0, std::vector<Vector3d>(4, Vector3d::Zero()), {}};
    const BiasStepCost step(0.1);
    QCOMPARE(test::residualsAt(step, {{1.0, 2.0, 3.0}, {1.0, 2.0, 3.0}}).norm(), 0.0);
    QVERIFY(std::abs(test::residualsAt(step, {{1.0, 2.0, 3.0}, {1.0, 2.2, 3.0}})[1] - 2.0) < 1e-12);
    QVERIFY(test::worstJacobianError(step, {{1.0, 2.0, 3.0}, {1.1, 2.2, 3.1}}) < 1e-9);
    // Outer knots stand for half as much time.
    const BiasMeanCost mean(drift, 0.1);
    const test::Blocks balanced = {{2.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, {-1.0, 0.0, 0.0}};
    QVERIFY(test::residualsAt(mean, balanced).norm() < 1e-12);
    QVERIFY(test::residualsAt(mean, {{3.0, 0, 0}, {3.0, 0, 0}, {3.0, 0, 0}, {3.0, 0, 0}}).norm() > 29.0);
    QVERIFY(test::worstJacobianError(mean, balanced) < 1e-9);
  }

  // Turning about a fixed axis at a constant rate, an IMU off the axis feels the centripetal acceleration.
  void accelerometer_onALeverArm_feelsCentripetalAcceleration() {
    const double rate_rad_s = 3.0, lever_m = 0.1;
    test::Blocks blocks;
    for (int k = 0; k < 4; ++k) {
      blocks.push_back(States::numbers(quaternionExp(Vector3d(0.0, 0.0, rate_rad_s * kSpacing_s * (k - 1)))));
    }
    for (int k = 0; k < 4; ++k) blocks.push_back({0.0, 0.0, 0.0});
    blocks.push_back({0.0, 0.0, -9.81});
    blocks.push_back({0.0, 0.0, 0.0});
    blocks.push_back({1.0, 0.0, 0.0, 1.0, 0.0, 1.0});
    blocks.push_back({0.0, 0.0, 0.0, 1.0});
    blocks.push_back({lever_m, 0.0, 0.0});
    blocks.push_back({0.0});
    const Vector3d measured(-rate_rad_s * rate_rad_s * lever_m, 0.0, 9.81);
    const AccelerometerCost cost(ImuRole::Further, 1.0, segmentTimes(), {{1.007, measured}});
    QVERIFY(test::residualsAt(cost, blocks).norm() < 1e-9);
  }

  void mapping_roundTrip() {
    Eigen::Matrix3d mapping;
    mapping << 1.0, 2.0, 3.0, 0.0, 4.0, 5.0, 0.0, 0.0, 6.0;
    double numbers[6];
    parametersFromMapping(mapping, numbers);
    QVERIFY(mappingFromParameters(numbers) == mapping);
  }

  void prior_isZeroAtItsMean() {
    const double mean[3] = {1.0, 2.0, 3.0};
    const PriorCost cost(mean, 3, 0.5);
    QCOMPARE(test::residualsAt(cost, {{1.0, 2.0, 3.0}}).norm(), 0.0);
    QVERIFY(test::worstJacobianError(cost, {{1.5, 2.5, 2.0}}) < 1e-9);
  }

  void priors_countTheirSigmasAxisByAxis() {
    const PriorCost cost(Vector3d(1.0, 2.0, 3.0), Vector3d(0.1, 0.2, 0.5));
    QVERIFY((test::residualsAt(cost, {{1.1, 2.2, 3.5}}) - Vector3d::Ones()).norm() < 1e-12);
    QVERIFY(test::worstJacobianError(cost, {{1.5, 2.5, 2.0}}) < 1e-9);
    const NormCost norm(9.79, 0.05);
    QVERIFY(std::abs(test::residualsAt(norm, {{0.0, 5.904, 7.872}})[0] - 1.0) < 1e-9);
    QVERIFY(test::worstJacobianError(norm, {{0.3, 5.9, 7.8}}) < 1e-7);
  }

  // About the axes of the frame into which the rotation turns, as sigmas are reported.
  void rotationPrior_countsTurnsAboutTheReferencesAxes() {
    const Eigen::Quaterniond mean = quaternionExp({1.2, -1.1, 0.9});
    const RotationPriorCost cost(mean, Vector3d(0.01, 0.02, 0.04));
    QVERIFY(test::residualsAt(cost, {States::numbers(mean)}).norm() < 1e-12);
    const Eigen::Quaterniond turned = quaternionExp({0.01, 0.02, 0.04}) * mean;
    QVERIFY((test::residualsAt(cost, {States::numbers(turned)}) - Vector3d::Ones()).norm() < 1e-9);
    const Eigen::Quaterniond far = quaternionExp({0.4, -0.6, 0.3}) * mean;
    QVERIFY(test::worstJacobianError(cost, {States::numbers(far)}) < 1e-6);
  }

  void heldAxes_stayAtTheirPriors() {
    Eigen::Matrix3d mapping = Eigen::Matrix3d::Identity();
    mapping(1, 2) = 0.02;
    const HeldAxisCost held(Vector3d::UnitZ(), mapping, 0.1);
    QCOMPARE(test::residualsAt(held, {{1.3, 0.2, 0.0, 1.1, 0.02, 1.0}}).norm(), 0.0);
    const HeldTranslationCost translation(Vector3d::UnitZ(), Vector3d(9.0, 9.0, 0.05), 0.01);
    QVERIFY(std::abs(test::residualsAt(translation, {{0.3, 0.8, 0.06}})[0] - 1.0) < 1e-12);
  }

  void rotationPrior_isItsAngleInSigmas() {
    const RotationPriorCost cost(Eigen::Quaterniond::Identity(), Vector3d::Constant(0.02));
    const Vector3d turn(0.006, -0.01, 0.004);
    const test::Blocks blocks = {States::numbers(quaternionExp(turn))};
    QVERIFY((test::residualsAt(cost, blocks) - turn / 0.02).norm() < 1e-4);
    QVERIFY(test::worstJacobianError(cost, blocks) < 1e-7);
    Eigen::Quaterniond same = quaternionExp(turn);
    same.coeffs() = -same.coeffs();
    QVERIFY((test::residualsAt(cost, {States::numbers(same)}) - turn / 0.02).norm() < 1e-4);
    QVERIFY(test::worstJacobianError(cost, {States::numbers(same)}) < 1e-7);
  }

  void heldMapping_isZeroWhereItsAxisStays() {
    const Vector3d axis(0.0, 0.6, 0.8);
    const HeldAxisCost cost(axis, Eigen::Matrix3d::Identity(), 0.1);
    QCOMPARE(test::residualsAt(cost, {{1.0, 0.0, 0.0, 1.0, 0.0, 1.0}}).norm(), 0.0);
    QVERIFY(test::residualsAt(cost, {{2.0, 0.8, -0.6, 1.0, 0.0, 1.0}}).norm() < 1e-12);
    QVERIFY(std::abs(test::residualsAt(cost, {{1.0, 0.0, 0.0, 1.0, 0.0, 1.1}}).norm() - 0.8) < 1e-12);
    QVERIFY(test::worstJacobianError(cost, {{1.1, 0.2, -0.1, 0.9, 0.05, 1.2}}) < 1e-9);
  }

  void heldTranslation_isZeroAcrossItsAxis() {
    const HeldTranslationCost cost(Vector3d(0.0, 0.6, 0.8), Vector3d::Zero(), 0.01);
    QVERIFY(test::residualsAt(cost, {{0.3, 0.8, -0.6}}).norm() < 1e-12);
    QVERIFY(std::abs(test::residualsAt(cost, {{0.3, 0.006, 0.008}})[0] - 1.0) < 1e-12);
    QVERIFY(test::worstJacobianError(cost, {{0.3, 0.1, 0.2}}) < 1e-9);
  }

  void smoothness_isZeroAtConstantVelocity() {
    const SmoothPositionCost position(kSpacing_s, 30.0);
    QVERIFY(test::residualsAt(position, {{1.0, 2.0, 3.0}, {1.1, 2.0, 2.9}, {1.2, 2.0, 2.8}}).norm() < 1e-9);
    QVERIFY(std::abs(test::residualsAt(position, {{0, 0, 0}, {0, 0, 0}, {0, 0.012, 0}})[1] - 1.0) < 1e-9);
    QVERIFY(test::worstJacobianError(position, {{1.0, 2.0, 3.0}, {1.3, 2.2, 2.9}, {1.2, 2.1, 2.8}}) < 1e-7);
    const SmoothRotationCost rotation(kSpacing_s, 200.0);
    const auto block = [](const Vector3d& angle) {
      const Eigen::Vector4d xyzw = quaternionExp(angle).coeffs();
      return std::vector<double>(xyzw.data(), xyzw.data() + 4);
    };
    const Vector3d step(0.05, -0.1, 0.2);
    QVERIFY(test::residualsAt(rotation, {block(step), block(2.0 * step), block(3.0 * step)}).norm() < 1e-9);
    const Vector3d bent(0.0, 0.0, 0.08);  // 200 rad/s^2
    QVERIFY(std::abs(test::residualsAt(rotation, {block({0, 0, 0}), block({0, 0, 0}), block(bent)})[2] -
                     1.0) < 1e-9);
    QVERIFY(test::worstJacobianError(rotation,
                                     {block(step), block({0.3, 0.2, 0.1}), block({-0.1, 0.4, 0.3})}) < 1e-6);
  }
};

}  // namespace

EVICAL_TEST(TestResiduals)
#include "tst_residuals.moc"
