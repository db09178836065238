// The batch's own solver compared with Ceres on the same problems.
#include "core/optimisation/levenberg_marquardt.h"

#include "core/base/error.h"
#include "core/optimisation/calibration_problem.h"
#include "core/optimisation/normal_equations.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <ceres/solver.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stop_token>
#include <utility>
#include <vector>

namespace {

using namespace evical;

enum class Kind { OneImu, TwoImus, LinearBiases, FreeLens, Rotation, TwoCameras, CamerasAlone, Priors };

struct Case {
  test::SimulatedRig rig;
  OptimisationOptions options;
  CalibrationState start;
};

Case caseOf(Kind kind) {
  test::RigOptions rig_options = test::shortRecording(3);
  rig_options.second_imu = kind == Kind::TwoImus;
  rig_options.frames_too = kind == Kind::TwoCameras || kind == Kind::CamerasAlone;
  Case test{test::simulateRig(rig_options), {}, {}};
  // A start near enough that no measurement leaves its spline segment.
  test.start = test.rig.truth;
  test.start.cameras.back().time_offset_s += 2e-4;
  test.start.cameras.back().reference_from_camera.translation_m.x() += 5e-3;
  test.start.imus[0].gyroscope_bias_rad_s.y() += 2e-3;
  OptimisationOptions& options = test.options;
  if (kind == Kind::LinearBiases) {
    options.bias_model = BiasModel::Linear;
    options.bias_knot_spacing_s = 0.5;
  }
  if (kind == Kind::FreeLens) options.camera_intrinsics = CameraIntrinsicsChoice::Free;
  if (kind == Kind::Rotation) {
    options.gyroscope_rotation = Estimated::Yes;
    options.free_gravity_norm = true;
  }
  if (kind == Kind::CamerasAlone) {
    test.rig.input.imus.clear();
    test.start.imus.clear();
  }
  if (kind == Kind::Priors) {
    test.rig.input.cameras[0].prior.time_offset = KnownNumber{test.rig.truth.cameras[0].time_offset_s, {}};
    test.rig.input.cameras[0].prior.translation =
        KnownVector{{0.1, 0.0, 0.0}, Eigen::Vector3d::Constant(0.01)};
  }
  return test;
}

struct Solved {
  std::vector<double> costs;  // by iteration
  bool converged = false;
};

class Recorder final : public ceres::IterationCallback {
 public:
  explicit Recorder(std::vector<double>& costs) : costs_(costs) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    costs_.push_back(summary.cost);
    return ceres::SOLVER_CONTINUE;
  }

 private:
  std::vector<double>& costs_;
};

Solved byCeres(CalibrationProblem& problem, const SolverLimits& limits) {
  Solved solved;
  Recorder recorder(solved.costs);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;  // without additional threads
  options.max_num_iterations = limits.max_iterations;
  options.function_tolerance = limits.cost_change;
  options.gradient_tolerance = options.parameter_tolerance = 1e-12;
  options.max_num_consecutive_invalid_steps = 20;
  options.initial_trust_region_radius = 1e12;
  options.logging_type = ceres::SILENT;
  options.callbacks = {&recorder};
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem.problem(), &summary);
  solved.converged = summary.termination_type == ceres::CONVERGENCE;
  return solved;
}

Solved byOurs(CalibrationProblem& problem, const SolverLimits& limits) {
  Solved solved;
  SolverMemory memory;
  const SolverSummary summary =
      solveNormalEquations(problem, limits, {}, memory, [&](const SolverIteration& iteration) {
        solved.costs.push_back(iteration.cost);
        return true;
      });
  solved.converged = summary.converged && summary.failure.empty();
  return solved;
}

// The largest difference of any quantity, in its sigmas.
double differenceInSigmas(CalibrationProblem& a, CalibrationProblem& b) {
  const UnknownColumns columns(a);
  NormalEquations equations(columns);
  assemble(columns, 1, {}, equations);
  const Eigen::MatrixXd covariance = equations.matrix.schurComplement().inverse();
  double largest = 0.0;
  const std::vector<Quantity> of_a = a.quantities(), of_b = b.quantities();
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    const Eigen::Index first = columns.firstColumn()[i], size = columns.firstColumn()[i + 1] - first;
    std::vector<double> difference(static_cast<std::size_t>(size));
    if (const ceres::Manifold* const manifold = a.problem().GetManifold(of_a[i].block))
      manifold->Minus(of_a[i].block, of_b[i].block, difference.data());
    else
      std::transform(of_a[i].block, of_a[i].block + size, of_b[i].block, difference.begin(), std::minus<>());
    for (Eigen::Index k = 0; k < size; ++k)
      largest = std::max(largest, std::abs(difference[static_cast<std::size_t>(k)]) /
                                      std::sqrt(covariance(first + k, first + k)));
  }
  return largest;
}

}  // namespace

class TestLevenbergMarquardt : public QObject {
  Q_OBJECT

 private slots:
  void optimum_isThatOfCeres_data() {
    QTest::addColumn<int>("kind");
    QTest::newRow("camera and IMU") << static_cast<int>(Kind::OneImu);
    QTest::newRow("two IMUs") << static_cast<int>(Kind::TwoImus);
    QTest::newRow("linear biases") << static_cast<int>(Kind::LinearBiases);
    QTest::newRow("free lens") << static_cast<int>(Kind::FreeLens);
    QTest::newRow("misaligned gyroscope and gravity's norm") << static_cast<int>(Kind::Rotation);
    QTest::newRow("two cameras") << static_cast<int>(Kind::TwoCameras);
    QTest::newRow("cameras alone") << static_cast<int>(Kind::CamerasAlone);
    QTest::newRow("priors") << static_cast<int>(Kind::Priors);
  }
  // The path is the same, too. The usual end is near the optimum, and a close one is Ceres' own.
  void optimum_isThatOfCeres() {
    QFETCH(int, kind);
    const Case test = caseOf(static_cast<Kind>(kind));
    CalibrationProblem ours(test.rig.input, test.options, test.start),
        ceres(test.rig.input, test.options, test.start);
    ours.build(lastStage(test.options), givenWeights(test.rig.input));
    ceres.build(lastStage(test.options), givenWeights(test.rig.input));
    QVERIFY(!ours.quantities().empty());
    const Solved a = byOurs(ours, {30, OptimisationOptions{}.last_step_sigmas, 1e-9, 2}),
                 b = byCeres(ceres, {100, 0.0, 1e-15, 2});
    QVERIFY(a.converged && b.converged);
    QVERIFY(a.costs.size() > 2 && a.costs.size() <= b.costs.size());
    for (std::size_t i = 0; i < a.costs.size(); ++i)  // the last one is promised
      QVERIFY2(std::abs(a.costs[i] / b.costs[i] - 1.0) < (i + 1 < a.costs.size() ? 1e-9 : 1e-6),
               qPrintable(QString::number(i)));
    const double sigmas = differenceInSigmas(ours, ceres);
    QVERIFY2(sigmas < 1e-2, qPrintable(QString("%1 sigmas apart").arg(sigmas)));
    QVERIFY(byOurs(ours, {100, 0.0, 1e-15, 2}).converged);
    const double closely = differenceInSigmas(ours, ceres);
    QVERIFY2(closely < 1e-6, qPrintable(QString("%1 sigmas apart").arg(closely)));
  }

  // If the optimum is beyond a bound, the bounded parameter ends at the bound, and all others at the optimum
  // for it.
  void bound_isKept() {
    const Case test = caseOf(Kind::FreeLens);
    constexpr int kFirstDistortion = 4;
    constexpr double kBound = 0.01;  // the rig's lens has none
    const auto solve = [&](const std::function<Solved(CalibrationProblem&)>& by) {
      CalibrationProblem problem(test.rig.input, test.options, test.start);
      problem.build(lastStage(test.options), givenWeights(test.rig.input));
      double* lens = nullptr;
      for (const Quantity& quantity : problem.quantities())
        if (quantity.info->shape == QuantityShape::Intrinsics) lens = quantity.block;
      problem.problem().SetParameterLowerBound(lens, kFirstDistortion, kBound);
      lens[kFirstDistortion] = 2.0 * kBound;
      const Solved solved = by(problem);
      return std::pair{solved, lens[kFirstDistortion]};
    };
    const SolverLimits limits{60, 0.0, 1e-12, 1};
    const auto [ours, at] = solve([&](CalibrationProblem& problem) { return byOurs(problem, limits); });
    const auto [ceres, at_by_ceres] =
        solve([&](CalibrationProblem& problem) { return byCeres(problem, limits); });
    QVERIFY(ours.converged);
    QCOMPARE(at, kBound);
    QVERIFY(std::abs(at_by_ceres - kBound) < 1e-6);
    QVERIFY2(
        ours.costs.back() < ceres.costs.back() * (1.0 + 1e-7),
        qPrintable(
            QString("%1 against %2").arg(ours.costs.back(), 0, 'g', 12).arg(ceres.costs.back(), 0, 'g', 12)));
  }

  void threads_doNotChangeTheResult() {
    const Case test = caseOf(Kind::TwoImus);
    std::vector<std::vector<double>> costs;
    for (const int threads : {1, 2, 3}) {
      CalibrationProblem problem(test.rig.input, test.options, test.start);
      problem.build(lastStage(test.options), givenWeights(test.rig.input));
      costs.push_back(byOurs(problem, {30, 0.0, 1e-10, threads}).costs);
    }
    QVERIFY(costs[0] == costs[1] && costs[0] == costs[2]);
  }

  void stop_endsIt() {
    const Case test = caseOf(Kind::OneImu);
    CalibrationProblem problem(test.rig.input, test.options, test.start);
    problem.build(lastStage(test.options), givenWeights(test.rig.input));
    std::stop_source stop;
    SolverMemory memory;
    int iterations = 0;
    QVERIFY_THROWS_EXCEPTION(Cancelled, solveNormalEquations(problem, {30, 0.0, 1e-10, 2}, stop.get_token(),
                                                             memory, [&](const SolverIteration&) {
                                                               stop.request_stop();
                                                               ++iterations;
                                                               return true;
                                                             }));
    QCOMPARE(iterations, 1);
  }

  void whoWatches_endsIt() {
    const Case test = caseOf(Kind::OneImu);
    CalibrationProblem problem(test.rig.input, test.options, test.start);
    problem.build(lastStage(test.options), givenWeights(test.rig.input));
    SolverMemory memory;
    int iterations = 0;
    const SolverSummary summary = solveNormalEquations(
        problem, {30, 0.0, 1e-10, 1}, {}, memory, [&](const SolverIteration&) { return ++iterations < 2; });
    QCOMPARE(iterations, 2);
    QVERIFY(!summary.converged && summary.failure.empty() && summary.final_cost < summary.initial_cost);
  }
};

EVICAL_TEST(TestLevenbergMarquardt)
#include "tst_levenberg_marquardt.moc"
