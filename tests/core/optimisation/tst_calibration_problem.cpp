// Parameter blocks and the state that they represent, and the effect of weights on the problem.
#include "core/optimisation/calibration_problem.h"

#include "core/geometry/so3.h"
#include "core/optimisation/normal_equations.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace evical;

test::SimulatedRig shortRig() {
  test::RigOptions options = test::shortRecording();
  options.duration_s = 0.4;
  return test::simulateRig(options);
}

double* blockOf(CalibrationProblem& problem, QuantityOwner owner, const std::string& name) {
  for (const Quantity& quantity : problem.quantities())
    if (quantity.info->owner == owner && quantity.info->name == name) return quantity.block;
  return nullptr;
}

std::ptrdiff_t countOf(const CalibrationProblem& problem, SensorKind kind) {
  return std::count_if(problem.blocks().begin(), problem.blocks().end(),
                       [&](const BlockInfo& info) { return info.kind == kind; });
}

// Half the sum of squares of all residuals of one kind.
double costOf(CalibrationProblem& problem, SensorKind kind) {
  double sum = 0.0;
  for (const BlockInfo& info : problem.blocks()) {
    double cost = 0.0;
    if (info.kind != kind) continue;
    problem.problem().EvaluateResidualBlock(info.id, false, &cost, nullptr, nullptr);
    sum += cost;
  }
  return sum;
}

// One view of ten circles within 27 ms, and no samples.
CalibrationInput oneView(CalibrationInput input) {
  BoardObservations& seen = input.cameras[0].observations;
  BoardView view = seen.views[seen.views.size() / 2];
  view.circles.resize(10);
  for (std::size_t i = 0; i < view.circles.size(); ++i)
    view.circles[i].time_s = view.time_s + 3e-3 * (static_cast<double>(i) - 4.5);
  seen.views = {view};
  input.imus[0].samples.clear();
  return input;
}

// Even motion, which does not depend on the knots.
CalibrationState movingEvenly(CalibrationState state, double knot_spacing_s) {
  So3Spline& turns = state.world_from_imu_rotation;
  VectorSpline& shifts = state.imu_in_world_m;
  const Eigen::Quaterniond rotation = turns.control_points.front();
  const Eigen::Vector3d position = shifts.control_points.front();
  turns = makeUniformSo3Spline(turns.start_s, turns.endTime_s(), knot_spacing_s, rotation);
  shifts = makeUniformVectorSpline(shifts.start_s, shifts.endTime_s(), knot_spacing_s, position);
  for (std::size_t k = 0; k < turns.control_points.size(); ++k) {
    const double time_s = (static_cast<double>(k) - 1.0) * knot_spacing_s;
    turns.control_points[k] = rotation * quaternionExp(time_s * Eigen::Vector3d(0.3, -0.5, 0.4));
    shifts.control_points[k] = position + time_s * Eigen::Vector3d(0.2, 0.1, -0.1);
  }
  return state;
}

// Information of the quantities if the trajectory is known.
Eigen::MatrixXd informationWithKnots(const CalibrationInput& input, const CalibrationState& state,
                                     double knot_spacing_s) {
  OptimisationOptions options;
  options.huber_sigma = 1e9;
  options.time_offset_drift = false;  // its reference time is the middle of the splines
  CalibrationProblem problem(input, options, movingEvenly(state, knot_spacing_s));
  problem.build(ParameterStages::Mappings, givenWeights(input));
  const UnknownColumns columns(problem);
  NormalEquations equations(columns);
  assemble(columns, 1, {}, equations);
  return equations.matrix.corner().selfadjointView<Eigen::Lower>();
}

}  // namespace

class TestCalibrationProblem : public QObject {
  Q_OBJECT

 private slots:
  void state_isTheInitialOne() {
    const test::SimulatedRig rig = shortRig();
    const OptimisationOptions options;
    const CalibrationProblem problem(rig.input, options, rig.truth);
    const CalibrationState state = problem.state();
    QVERIFY(state.imus[0].gyroscope_scale_misalignment == rig.truth.imus[0].gyroscope_scale_misalignment);
    QVERIFY(state.imus[0].accelerometer_scale_misalignment ==
            rig.truth.imus[0].accelerometer_scale_misalignment);
    QVERIFY(state.cameras[0].reference_from_camera.translation_m ==
            rig.truth.cameras[0].reference_from_camera.translation_m);
    QVERIFY(state.gravity_in_world_m_s2 == rig.truth.gravity_in_world_m_s2);
  }

  void state_followsItsBlocks() {
    const test::SimulatedRig rig = shortRig();
    const OptimisationOptions options;
    CalibrationProblem problem(rig.input, options, rig.truth);
    problem.build(ParameterStages::Mappings, givenWeights(rig.input));
    const CalibrationState before = problem.state();
    *blockOf(problem, QuantityOwner::Camera, "time_offset") = 0.001;
    blockOf(problem, QuantityOwner::Imu, "gyroscope_scale_misalignment")[2] = 0.25;  // m02
    QCOMPARE(problem.state().cameras[0].time_offset_s, 0.001);
    QCOMPARE(problem.state().imus[0].gyroscope_scale_misalignment(0, 2), 0.25);
    // A returned state does not change.
    QVERIFY(before.imus[0].gyroscope_scale_misalignment(0, 2) != 0.25);
  }

  void build_leavesOutCirclesThatAreNotUsed() {
    const test::SimulatedRig rig = shortRig();
    const OptimisationOptions options;
    CalibrationProblem problem(rig.input, options, rig.truth);
    Weights weights = givenWeights(rig.input);
    problem.build(ParameterStages::Mappings, weights);
    QVERIFY(countOf(problem, SensorKind::Circles) > 0);
    for (auto& circles : weights.used_circles[0]) std::fill(circles.begin(), circles.end(), std::uint8_t{0});
    problem.build(ParameterStages::Mappings, weights);
    QCOMPARE(countOf(problem, SensorKind::Circles), std::ptrdiff_t{0});
    QVERIFY(countOf(problem, SensorKind::Gyroscope) > 0);
  }

  // The displacement field of its circles is one, also if there are knots between their times.
  void viewAcrossKnots_isOneMeasurement() {
    const test::SimulatedRig rig = shortRig();
    const CalibrationInput input = oneView(rig.input);
    const Eigen::MatrixXd whole = informationWithKnots(input, rig.truth, 0.5);
    const Eigen::VectorXd sigmas = whole.diagonal().cwiseSqrt().cwiseInverse();
    for (const double knot_spacing_s : {0.02, 0.01, 0.005}) {
      const Eigen::MatrixXd difference = informationWithKnots(input, rig.truth, knot_spacing_s) - whole;
      const double largest = (sigmas.asDiagonal() * difference * sigmas.asDiagonal()).cwiseAbs().maxCoeff();
      QVERIFY2(largest < 1e-9, qPrintable(QString::number(largest)));
    }
  }

  void build_dividesResidualsByTheScales() {
    const test::SimulatedRig rig = shortRig();
    const OptimisationOptions options;
    CalibrationProblem problem(rig.input, options, rig.truth);
    Weights weights = givenWeights(rig.input);
    problem.build(ParameterStages::Mappings, weights);
    const double gyroscopes = costOf(problem, SensorKind::Gyroscope),
                 accelerometers = costOf(problem, SensorKind::Accelerometer);
    QVERIFY(gyroscopes > 0.0);
    weights.scales.gyroscopes[0] = 2.0;
    problem.build(ParameterStages::Mappings, weights);
    QVERIFY(std::abs(4.0 * costOf(problem, SensorKind::Gyroscope) / gyroscopes - 1.0) < 1e-12);
    QCOMPARE(costOf(problem, SensorKind::Accelerometer), accelerometers);
  }

  // By more than half a knot: most specific forces are in another segment than the rates of the same stamp.
  void build_putsForcesWhereTheyWereMeasured() {
    test::RigOptions late = test::shortRecording();
    late.duration_s = 0.4;
    late.accelerometer_delay_s = 0.013;
    const test::SimulatedRig rig = test::simulateRig(late);
    const OptimisationOptions options;
    CalibrationProblem problem(rig.input, options, rig.truth);
    problem.build(ParameterStages::Mappings, givenWeights(rig.input));
    const double samples = static_cast<double>(rig.input.imus[0].samples.size());
    for (const SensorKind kind : {SensorKind::Gyroscope, SensorKind::Accelerometer}) {
      const double each = costOf(problem, kind) / samples;  // half the square of three residuals
      QVERIFY2(each > 1.0 && each < 2.0, qPrintable(QString::number(each)));
    }
    QCOMPARE(problem.segmentDrift_knots(), 0.0);
    *blockOf(problem, QuantityOwner::Imu, "accelerometer_delay") -= 0.01;
    QVERIFY(std::abs(problem.segmentDrift_knots() - 0.5) < 1e-9);
  }

  void build_withAHeldAxis_holdsTheGyroscopesTurn() {
    const test::SimulatedRig rig = shortRig();
    OptimisationOptions options;
    options.gyroscope_rotation = Estimated::Yes;
    CalibrationProblem problem(rig.input, options, rig.truth);
    Weights weights = givenWeights(rig.input);
    problem.build(ParameterStages::Mappings, weights);
    QVERIFY(blockOf(problem, QuantityOwner::Imu, "gyroscope_rotation") != nullptr);
    const std::ptrdiff_t priors = countOf(problem, SensorKind::Prior);
    weights.held_axes[0].gyroscope = {Eigen::Vector3d::UnitZ()};
    problem.build(ParameterStages::Mappings, weights);
    QVERIFY(blockOf(problem, QuantityOwner::Imu, "gyroscope_rotation") == nullptr);
    QCOMPARE(countOf(problem, SensorKind::Prior), priors - 1);  // that of the rotation
  }

  void build_beforeTheLastStage_holdsMappings() {
    const test::SimulatedRig rig = shortRig();
    const OptimisationOptions options;
    CalibrationProblem problem(rig.input, options, rig.truth);
    problem.build(ParameterStages::Extrinsics, givenWeights(rig.input));
    QVERIFY(blockOf(problem, QuantityOwner::Imu, "gyroscope_scale_misalignment") == nullptr);
    QVERIFY(blockOf(problem, QuantityOwner::Camera, "rotation") != nullptr);
  }
};

EVICAL_TEST(TestCalibrationProblem)
#include "tst_calibration_problem.moc"
