// Sensors that move, or clocks that step, within a recording.
#include "core/base/time.h"
#include "core/numerics/angles.h"
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using namespace evical;

constexpr double kAt_s = 5.0;

test::SimulatedRig rigOfChangeWithin(unsigned seed, bool second_imu = false) {
  test::RigOptions options = test::shortRecording(seed);
  options.duration_s = 8.0;
  options.second_imu = second_imu;
  return test::simulateRig(options);
}

// The camera's, by 2 ms.
test::SimulatedRig rigWithSteppingClock() {
  test::SimulatedRig rig = rigOfChangeWithin(1);
  for (BoardView& view : rig.input.cameras[0].observations.views)
    for (CircleObservation& circle : view.circles)
      if (circle.time_s > kAt_s) circle.time_s += 2e-3;
  return rig;
}

UncertaintyEstimate estimateOfChangeWithin(const test::SimulatedRig& rig,
                                           const OptimisationOptions& options = {}) {
  const BatchSolution solution =
      optimiseBatch(rig.input, test::disturbed(rig.truth, 1), options, RunContext{});
  return estimateUncertainty(rig.input, solution, options, RunContext{});
}

class TestChangeWithin : public QObject {
  Q_OBJECT

 private slots:
  void whatStays_isNoChange() {
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const QualityWarning change = estimateOfChangeWithin(rigOfChangeWithin(seed, true)).change;
      QVERIFY2(change.text.empty(), change.text.c_str());
    }
  }

  // The repair is to calibrate the part before the step.
  void clockThatSteps_isToldWithItsMoment() {
    const test::SimulatedRig rig = rigWithSteppingClock();
    const QualityWarning change = estimateOfChangeWithin(rig).change;
    QVERIFY2(change.text.find("left: its clock seems to step relative to that of") == 0, change.text.c_str());
    QVERIFY2(std::abs(millisecondsIn(change.text) - 2.0) < 0.4, change.text.c_str());
    expectKeptBefore(change);
  }

  // A second IMU that slips: its samples are rotated by 0.5 deg from then on.
  void sensorThatSlips_isToldByItsName() {
    test::SimulatedRig rig = rigOfChangeWithin(1, true);
    ImuData& imu = rig.input.imus[1];
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(kRadPerDeg * 0.5, Eigen::Vector3d::UnitX()));
    for (ImuSample& sample : imu.samples) {
      if (secondsSince(rig.input.start_ns, sample.time_ns) < kAt_s) continue;
      sample.angular_rate_rad_s = turn * sample.angular_rate_rad_s;
      sample.specific_force_m_s2 = turn * sample.specific_force_m_s2;
    }
    const QualityWarning change = estimateOfChangeWithin(rig).change;
    QVERIFY2(change.text.find(imu.name + ": it seems to have moved relative to imu") == 0,
             change.text.c_str());
    expectKeptBefore(change);
  }

  // Biases that are constant by the options; if they may drift, there is no change to report.
  void biasesThatStep_areTold() {
    test::SimulatedRig rig = rigOfChangeWithin(1);
    for (ImuSample& sample : rig.input.imus[0].samples)
      if (secondsSince(rig.input.start_ns, sample.time_ns) > kAt_s)
        sample.angular_rate_rad_s += Eigen::Vector3d(5e-3, 0.0, 0.0);
    OptimisationOptions options;
    const QualityWarning change = estimateOfChangeWithin(rig, options).change;
    QVERIFY2(change.text.find("imu: its biases change within the recording by 0.00") == 0,
             change.text.c_str());
    QVERIFY((change.repair == Repair{"optimisation.model.bias_model", "linear"}));
    options.bias_model = BiasModel::Linear;
    QVERIFY(estimateOfChangeWithin(rig, options).change.text.empty());
  }

  void options_tellWhatIsLarge() {
    const test::SimulatedRig rig = rigWithSteppingClock();
    OptimisationOptions options;
    options.needed_time_offset_ms = 5.0;
    QVERIFY(estimateOfChangeWithin(rig, options).change.text.find("clock") == std::string::npos);
    options = {};
    options.changed_sigmas = 1000.0;
    QVERIFY(estimateOfChangeWithin(rig, options).change.text.empty());
  }

 private:
  static double millisecondsIn(const std::string& text) {
    const std::size_t by = text.find("by ");
    return by == std::string::npos ? 0.0 : std::atof(text.c_str() + by + 3);
  }
  static void expectKeptBefore(const QualityWarning& change) {
    QVERIFY(change.repair.has_value());
    QCOMPARE(change.repair->key, std::string("time_range_s"));
    double begin_s = -1.0, end_s = -1.0;
    QCOMPARE(std::sscanf(change.repair->value.c_str(), "[%lf,%lf]", &begin_s, &end_s), 2);
    QVERIFY2(begin_s < 0.3 && end_s > kAt_s - 1.2 && end_s < kAt_s, change.repair->value.c_str());
  }
};

}  // namespace

EVICAL_TEST(TestChangeWithin)
#include "tst_change_within.moc"
