// Derivatives of the IMUs' costs against numeric differences, and their residuals for known motions.
#include "core/optimisation/inertial_cost.h"
#include "tests/core/optimisation/residual_states.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using namespace evical::test;

class TestInertialCost : public QObject {
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
    Blocks blocks;
    states.appendRotations(step_rad, blocks);
    blocks.push_back(States::numbers(states.vector(0.1)));
    blocks.push_back(mappingNumbers(states));
    blocks.push_back(States::numbers(quaternionExp(states.vector(0.1))));
    if (further) {
      blocks.push_back(States::numbers(quaternionExp(states.vector(1.0))));
      blocks.push_back({states.uniform(0.002)});
      blocks.push_back({states.uniform(0.5)});
    }
    const GyroscopeCost cost(further ? ImuRole::Further : ImuRole::Reference, 0.1, segmentTimes(),
                             {{1.001, states.vector(1.0), -0.002},
                              {1.0, states.vector(1.0), 0.001},
                              {1.0199, states.vector(1.0), 0.002}});
    const double error = worstJacobianError(cost, blocks, 1e-3);
    QVERIFY2(error < 1e-7, qPrintable(QString::number(error)));
    QCOMPARE(worstErrorWithConstantBlocks(cost, blocks), 0.0);
  }

  void accelerometerJacobians_matchNumericDifferences_data() {
    gyroscopeJacobians_matchNumericDifferences_data();
  }

  void accelerometerJacobians_matchNumericDifferences() {
    QFETCH(bool, further);
    QFETCH(double, step_rad);
    States states(6);
    Blocks blocks;
    states.appendRotations(step_rad, blocks);
    states.appendPositions(blocks);
    blocks.push_back({0.3, 9.7, -0.5});
    blocks.push_back(States::numbers(states.vector(0.1)));
    blocks.push_back(mappingNumbers(states));
    blocks.push_back({states.uniform(0.002)});
    if (further) {
      blocks.push_back(States::numbers(quaternionExp(states.vector(1.0))));
      blocks.push_back(States::numbers(states.vector(0.1)));
      blocks.push_back({states.uniform(0.002)});
      blocks.push_back({states.uniform(0.5)});
    }
    const AccelerometerCost cost(further ? ImuRole::Further : ImuRole::Reference, 0.5, segmentTimes(),
                                 {{1.002, states.vector(10.0), -0.002}, {1.01, states.vector(10.0), 0.002}});
    const double error = worstJacobianError(cost, blocks, 1e-3);
    QVERIFY2(error < 1e-6, qPrintable(QString::number(error)));
    QCOMPARE(worstErrorWithConstantBlocks(cost, blocks), 0.0);
  }

  void driftJacobians_matchNumericDifferences() {
    const DriftTimes drift{0.99, 0.1};
    for (const bool further : {false, true}) {
      States states(7);
      Blocks blocks;
      states.appendRotations(0.05, blocks);
      const Blocks rotations = blocks;
      const ImuRole role = further ? ImuRole::Further : ImuRole::Reference;
      blocks.insert(blocks.end(), {States::numbers(states.vector(0.1)), mappingNumbers(states),
                                   States::numbers(quaternionExp(states.vector(0.1)))});
      if (further)
        blocks.insert(blocks.end(), {States::numbers(quaternionExp(states.vector(1.0))), {0.001}, {0.0}});
      blocks.insert(blocks.end(), {States::numbers(states.vector(0.1)), States::numbers(states.vector(0.1))});
      const GyroscopeCost gyroscope(role, 0.1, segmentTimes(),
                                    {{1.001, states.vector(1.0)}, {1.0199, states.vector(1.0)}}, drift);
      QVERIFY(worstJacobianError(gyroscope, blocks, 1e-3) < 1e-7);
      QCOMPARE(worstErrorWithConstantBlocks(gyroscope, blocks), 0.0);

      blocks = rotations;
      states.appendPositions(blocks);
      blocks.insert(blocks.end(),
                    {{0.3, 9.7, -0.5}, States::numbers(states.vector(0.1)), mappingNumbers(states), {0.001}});
      if (further)
        blocks.insert(blocks.end(), {States::numbers(quaternionExp(states.vector(1.0))),
                                     States::numbers(states.vector(0.1)),
                                     {0.001},
                                     {0.0}});
      blocks.insert(blocks.end(), {States::numbers(states.vector(0.1)), States::numbers(states.vector(0.1))});
      const AccelerometerCost accelerometer(
          role, 0.5, segmentTimes(), {{1.002, states.vector(10.0)}, {1.01, states.vector(10.0)}}, drift);
      QVERIFY(worstJacobianError(accelerometer, blocks, 1e-3) < 1e-6);
      QCOMPARE(worstErrorWithConstantBlocks(accelerometer, blocks), 0.0);
    }
  }

  // Rotating about a fixed axis at a constant rate, an IMU away from the axis measures the centripetal
  // acceleration.
  void accelerometer_onALeverArm_feelsCentripetalAcceleration() {
    const double rate_rad_s = 3.0, lever_m = 0.1;
    Blocks blocks;
    for (int k = 0; k < 4; ++k) {
      blocks.push_back(States::numbers(quaternionExp(Vector3d(0.0, 0.0, rate_rad_s * kSpacing_s * (k - 1)))));
    }
    for (int k = 0; k < 4; ++k) blocks.push_back({0.0, 0.0, 0.0});
    blocks.push_back({0.0, 0.0, -9.81});
    blocks.push_back({0.0, 0.0, 0.0});
    blocks.push_back({1.0, 0.0, 0.0, 1.0, 0.0, 1.0});
    blocks.push_back({0.0});
    blocks.push_back({0.0, 0.0, 0.0, 1.0});
    blocks.push_back({lever_m, 0.0, 0.0});
    blocks.push_back({0.0});
    blocks.push_back({0.0});
    const Vector3d measured(-rate_rad_s * rate_rad_s * lever_m, 0.0, 9.81);
    const AccelerometerCost cost(ImuRole::Further, 1.0, segmentTimes(), {{1.007, measured}});
    QVERIFY(residualsAt(cost, blocks).norm() < 1e-9);
  }

  // An accelerometer with a delay measures at t what one without a delay measures that much earlier.
  void accelerometer_thatIsLate_measuresWhatWas() {
    constexpr double kDelay_s = 0.003;
    States states(8);
    Blocks blocks;
    states.appendRotations(0.05, blocks);
    states.appendPositions(blocks);
    blocks.insert(blocks.end(),
                  {{0.3, 9.7, -0.5}, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 1.0, 0.0, 1.0}, {kDelay_s}});
    Blocks prompt = blocks;
    prompt.back() = {0.0};
    const auto cost = [](double time_s) {
      return AccelerometerCost(ImuRole::Reference, 1.0, segmentTimes(), {{time_s, Vector3d::Zero()}});
    };
    const Eigen::VectorXd late = residualsAt(cost(1.012), blocks);
    QVERIFY((late - residualsAt(cost(1.012 - kDelay_s), prompt)).norm() < 1e-9);
    QVERIFY((late - residualsAt(cost(1.012), prompt)).norm() > 1e-3);
  }

  void mapping_roundTrip() {
    Eigen::Matrix3d mapping;
    mapping << 1.0, 2.0, 3.0, 0.0, 4.0, 5.0, 0.0, 0.0, 6.0;
    double numbers[6];
    parametersFromMapping(mapping, numbers);
    QVERIFY(mappingFromParameters(numbers) == mapping);
  }
};

}  // namespace

EVICAL_TEST(TestInertialCost)
#include "tst_inertial_cost.moc"
