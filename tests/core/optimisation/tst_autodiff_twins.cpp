// The batch's cost functions against twins with automatic derivatives: values and all derivatives. Numeric
// differences (tst_view_cost, tst_inertial_cost) compare a cost function with itself only.
#include "core/numerics/angles.h"
#include "core/optimisation/inertial_cost.h"
#include "tests/core/optimisation/autodiff_twins.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;
using namespace evical::test;

// Tolerances relative to the largest entry. The remaining difference is rounding: 1e-16, times 2500 / s^2
// (the inverse squared knot spacing in accelerations), times the loss in logarithms of rotations of 1e-7 rad;
// in the accelerometer's derivative by time offset it is the error of a central difference over 1e-4 knots,
// whose largest value was 4.5e-8.
constexpr double kRounding = 1e-7;

// Sequences of control points, and rotations of the sensors.
struct Turns {
  double step_rad, sensor_rad;
};

Vector3d direction(States& states) {
  return states.vector(1.0).normalized();
}

std::vector<double> turnOf(double angle_rad, States& states) {
  return States::numbers(quaternionExp(angle_rad * direction(states)));
}

void addStates() {
  QTest::addColumn<double>("step_rad");
  QTest::addColumn<double>("sensor_rad");
  QTest::newRow("identity") << 0.0 << 0.0;
  QTest::newRow("tiny turns") << 1e-7 << 1e-9;
  QTest::newRow("where series begin") << 1e-4 << 1e-4;
  QTest::newRow("moving") << 0.05 << 0.4;
  QTest::newRow("fast") << 1.0 << 2.0;
  QTest::newRow("sensors turned by almost pi") << 0.1 << kPi - 1e-6;
  QTest::newRow("steps of almost pi") << kPi - 1e-3 << 1.0;
}

Turns fetchedTurns() {
  QFETCH(double, step_rad);
  QFETCH(double, sensor_rad);
  return {step_rad, sensor_rad};
}

// At both knots of the rotation's segment, at one of the position's, and between.
std::vector<InertialMeasurement> samplesOf(double size, States& states) {
  std::vector<InertialMeasurement> samples;
  for (const double time_s : {1.0, 1.0 + kSpacing_s, 1.002, 1.0137, 0.99 + 1.5 * kSpacing_s})
    samples.push_back({time_s, states.vector(size), 0.3 * (time_s - 1.01)});
  return samples;
}

Blocks rotationsOf(const Turns& turns, States& states) {
  Blocks blocks;
  states.appendRotations(turns.step_rad, blocks);
  if (turns.step_rad == 0.0) blocks.assign(4, {0.0, 0.0, 0.0, 1.0});
  return blocks;
}

template <class Cost, class Twin>
void compareInertial(const Blocks& blocks, const Twin& twin) {
  const ImuRole role = twin.further ? ImuRole::Further : ImuRole::Reference;
  const Cost cost(role, twin.sigma, twin.segment, twin.samples, twin.drift);
  const double worst = worstDifference(cost, twin, blocks);
  QVERIFY2(worst < kRounding, qPrintable(QString::number(worst)));
}

void compareCircles(const CircleModel& model, const Blocks& blocks,
                    const std::vector<CircleMeasurement>& circles) {
  const ViewCost cost = exactCost(model, circles);
  const double worst = worstDifference(cost, CircleTwin{{}, model, segmentTimes(), circles}, blocks);
  QVERIFY2(worst < kRounding, qPrintable(QString::number(worst)));
}

class TestAutodiffTwins : public QObject {
  Q_OBJECT

 private slots:
  void gyroscope_isItsTwin_data() { addStates(); }
  void gyroscope_isItsTwin() {
    const Turns turns = fetchedTurns();
    for (unsigned seed = 1; seed <= 4; ++seed) {
      States states(seed);
      const bool further = seed % 2 == 0, drifts = seed > 2;
      Blocks blocks = rotationsOf(turns, states);
      blocks.insert(blocks.end(), {States::numbers(states.vector(0.1)), mappingNumbers(states),
                                   turnOf(turns.sensor_rad, states)});
      // Knots are fixed: an offset would move samples off them.
      if (further) blocks.insert(blocks.end(), {turnOf(turns.sensor_rad, states), {0.0}, {0.0}});
      if (drifts) blocks.insert(blocks.end(), {{0.1, -0.2, 0.05}, {-0.1, 0.1, 0.3}});
      const auto drift = drifts ? std::optional(DriftTimes{0.99, 0.1}) : std::nullopt;
      compareInertial<GyroscopeCost>(
          blocks, GyroscopeTwin{{}, further, 0.1, segmentTimes(), samplesOf(1.0, states), drift});
    }
  }

  void accelerometer_isItsTwin_data() { addStates(); }
  void accelerometer_isItsTwin() {
    const Turns turns = fetchedTurns();
    for (unsigned seed = 1; seed <= 4; ++seed) {
      States states(seed);
      const bool further = seed % 2 == 0, drifts = seed > 2;
      Blocks blocks = rotationsOf(turns, states);
      states.appendPositions(blocks);
      blocks.insert(blocks.end(),
                    {{0.3, 9.7, -0.5}, States::numbers(states.vector(0.1)), mappingNumbers(states), {0.0}});
      if (further)
        blocks.insert(blocks.end(),
                      {turnOf(turns.sensor_rad, states), States::numbers(states.vector(0.1)), {0.0}, {0.0}});
      if (drifts) blocks.insert(blocks.end(), {{0.1, -0.2, 0.05}, {-0.1, 0.1, 0.3}});
      const auto drift = drifts ? std::optional(DriftTimes{0.99, 0.1}) : std::nullopt;
      compareInertial<AccelerometerCost>(
          blocks, AccelerometerTwin{{}, further, 0.5, segmentTimes(), samplesOf(10.0, states), drift});
    }
  }

  void delays_areTheirTwins() {
    for (const bool further : {false, true}) {
      States states(12);
      const Turns turns = {0.3, 0.7};
      Blocks blocks = rotationsOf(turns, states);
      states.appendPositions(blocks);
      blocks.insert(
          blocks.end(),
          {{0.3, 9.7, -0.5}, States::numbers(states.vector(0.1)), mappingNumbers(states), {0.0013}});
      if (further)
        blocks.insert(
            blocks.end(),
            {turnOf(turns.sensor_rad, states), States::numbers(states.vector(0.1)), {0.0017}, {0.4}});
      compareInertial<AccelerometerCost>(
          blocks, AccelerometerTwin{{}, further, 0.5, segmentTimes(), samplesOf(10.0, states), std::nullopt});
    }
  }

  void timeOffsets_ofFurtherImus_areTheirTwins() {
    States states(11);
    const Turns turns = {0.3, 0.7};
    Blocks gyroscope = rotationsOf(turns, states), accelerometer = gyroscope;
    gyroscope.insert(gyroscope.end(), {States::numbers(states.vector(0.1)),
                                       mappingNumbers(states),
                                       turnOf(turns.sensor_rad, states),
                                       turnOf(turns.sensor_rad, states),
                                       {0.0017},
                                       {0.4}});
    compareInertial<GyroscopeCost>(
        gyroscope, GyroscopeTwin{{}, true, 0.1, segmentTimes(), samplesOf(1.0, states), std::nullopt});
    states.appendPositions(accelerometer);
    accelerometer.insert(accelerometer.end(), {{0.3, 9.7, -0.5},
                                               States::numbers(states.vector(0.1)),
                                               mappingNumbers(states),
                                               {0.0},
                                               turnOf(turns.sensor_rad, states),
                                               States::numbers(states.vector(0.1)),
                                               {0.0017},
                                               {0.4}});
    compareInertial<AccelerometerCost>(
        accelerometer,
        AccelerometerTwin{{}, true, 0.5, segmentTimes(), samplesOf(10.0, states), std::nullopt});
  }

  void circles_areTheirTwins_data() {
    QTest::addColumn<double>("step_rad");
    QTest::addColumn<double>("near_sigma");
    for (const double near_sigma : {0.5, 30.0}) {  // 30: in the flat part of Huber's loss
      for (const double step_rad : {0.0, 1e-7, 1e-4, 0.05, 0.5})
        QTest::addRow("step %g rad, %g sigma", step_rad, near_sigma) << step_rad << near_sigma;
    }
  }
  void circles_areTheirTwins() {
    QFETCH(double, step_rad);
    QFETCH(double, near_sigma);
    for (unsigned seed = 1; seed <= 4; ++seed) {
      States states(seed);
      const CircleModel model = circleModel();
      Blocks blocks = circleBlocks(states, step_rad);
      std::vector<CircleMeasurement> circles = circlesNear(model, blocks, near_sigma, states);
      compareCircles(model, blocks, circles);
      // At the knots of the rotation's segment.
      blocks[10] = {0.0};
      blocks[11] = {0.0};
      blocks[12] = {0.0};
      circles[0].time_s = 1.0;
      circles[1].time_s = 1.0 + kSpacing_s;
      compareCircles(model, blocks, circles);
    }
  }

  // The board is in front of a camera rotated by almost pi, so that the IMU looks away from it.
  void circles_ofACameraTurnedByAlmostPi_areTheirTwins() {
    States states(3);
    const CircleModel model = circleModel();
    Blocks blocks = circleBlocks(states, 0.05);
    const Eigen::Quaterniond turn = quaternionExp(Vector3d(kPi - 1e-6, 0.0, 0.0));
    for (std::size_t k = 0; k < 4; ++k)
      blocks[k] = States::numbers(Eigen::Quaterniond(blocks[k].data()) * turn.conjugate());
    blocks[8] = States::numbers(turn * Eigen::Quaterniond(blocks[8].data()));
    compareCircles(model, blocks, circlesNear(model, blocks, 0.5, states));
  }

  void circlesOfFreeIntrinsics_areTheirTwins_data() {
    QTest::addColumn<int>("lens");
    QTest::newRow("radtan") << static_cast<int>(CameraModel::PinholeRadtan);
    QTest::newRow("equidistant") << static_cast<int>(CameraModel::PinholeEquidistant);
    QTest::newRow("double sphere") << static_cast<int>(CameraModel::DoubleSphere);
    QTest::newRow("eucm") << static_cast<int>(CameraModel::Eucm);
    QTest::newRow("omni") << static_cast<int>(CameraModel::OmniRadtan);
  }
  void circlesOfFreeIntrinsics_areTheirTwins() {
    QFETCH(int, lens);
    for (unsigned seed = 1; seed <= 4; ++seed) {
      States states(seed);
      const CircleModel model = freeModel(static_cast<CameraModel>(lens));
      Blocks blocks = circleBlocks(states, 0.05);
      const std::vector<CircleMeasurement> circles = circlesNear(heldModel(model), blocks, 0.5, states);
      blocks.push_back(intrinsicsNumbers(otherLens(model.camera, states)));
      compareCircles(model, blocks, circles);
    }
  }
};

}  // namespace

EVICAL_TEST(TestAutodiffTwins)
#include "tst_autodiff_twins.moc"
