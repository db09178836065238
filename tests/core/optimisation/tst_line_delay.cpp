// Rolling shutter: rows that are exposed one after the other.
#include "core/optimisation/batch_optimiser.h"
#include "core/optimisation/uncertainty/covariance.h"
#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <cmath>

namespace {

using namespace evical;

constexpr double kLineDelay_us = 30.0;

test::SimulatedRig rigOfLineDelay(unsigned seed, double line_delay_us) {
  test::RigOptions options = test::shortRecording(seed);
  options.duration_s = 6.0;
  options.frames = true;
  options.line_delay_us = line_delay_us;
  return test::simulateRig(options);
}

OptimisationOptions heldLens() {
  OptimisationOptions options;
  options.camera_intrinsics = CameraIntrinsicsChoice::Fixed;
  return options;
}

BatchSolution solveForLineDelay(const test::SimulatedRig& rig, unsigned seed) {
  return optimiseBatch(rig.input, test::disturbed(rig.truth, seed), heldLens(), RunContext{});
}

}  // namespace

class TestLineDelay : public QObject {
  Q_OBJECT

 private slots:
  // Half of them are read out from the last row to the first, as behind a mirror: their line delay is
  // negative.
  void rollingShutter_isFound_withAnHonestSigma() {
    constexpr unsigned kSeeds = 12;
    double delay = 0.0, extrinsics = 0.0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      const double line_delay_us = seed % 2 == 0 ? kLineDelay_us : -kLineDelay_us;
      const test::SimulatedRig rig = rigOfLineDelay(seed, line_delay_us);
      const BatchSolution solution = solveForLineDelay(rig, seed);
      const UncertaintyReport report =
          estimateUncertainty(rig.input, solution, heldLens(), RunContext{}).report;
      const double error_us = solution.state.cameras[0].line_delay_us - line_delay_us;
      const double sigma_us = report.cameras[0].line_delay_std_us;
      QVERIFY2(sigma_us > 0.01 && sigma_us < 0.3, QByteArray::number(sigma_us));
      QVERIFY2(std::abs(error_us) < 4.0 * sigma_us, QByteArray::number(error_us));
      delay += error_us * error_us / (sigma_us * sigma_us * kSeeds);
      QVERIFY((report.columns[8] == QuantityAddress{QuantityOwner::Camera, 0, QuantityId::LineDelay}));
      constexpr Eigen::Index kExtrinsics = 7;  // rotation, translation, time offset
      const Eigen::VectorXd normalised = test::reportedErrors(solution.state, rig.truth, heldLens())
                                             .head(kExtrinsics)
                                             .cwiseQuotient(report.standard_deviations.head(kExtrinsics));
      extrinsics += normalised.squaredNorm() / (kExtrinsics * kSeeds);
    }
    QVERIFY2(std::sqrt(delay) > 0.6 && std::sqrt(delay) < 1.5, QByteArray::number(std::sqrt(delay)));
    QVERIFY2(std::sqrt(extrinsics) > 0.7 && std::sqrt(extrinsics) < 1.4,
             QByteArray::number(std::sqrt(extrinsics)));
  }

  // Stamps at the beginning of varying exposures: half of the additional exposure passes before the middle.
  void exposuresShare_isFound_withAnHonestSigma() {
    constexpr unsigned kSeeds = 12;
    constexpr double kShare = 0.5;
    double share = 0.0;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
      test::RigOptions rig_options = test::shortRecording(seed);
      rig_options.frames = true;
      rig_options.exposure_share = kShare;
      const test::SimulatedRig rig = test::simulateRig(rig_options);
      const BatchSolution solution = solveForLineDelay(rig, seed);
      const UncertaintyReport report =
          estimateUncertainty(rig.input, solution, heldLens(), RunContext{}).report;
      const double error = solution.state.cameras[0].exposure_share - kShare;
      const double sigma = report.cameras[0].exposure_share_std;
      QVERIFY2(sigma > 1e-3 && sigma < 0.03, QByteArray::number(sigma));
      QVERIFY((report.columns[8] == QuantityAddress{QuantityOwner::Camera, 0, QuantityId::ExposureShare}));
      share += error * error / (sigma * sigma * kSeeds);
    }
    QVERIFY2(std::sqrt(share) > 0.6 && std::sqrt(share) < 1.5, QByteArray::number(std::sqrt(share)));
  }

  void exposuresThatDoNotVary_leaveTheShareAt0() {
    const test::SimulatedRig rig = rigOfLineDelay(1, 0.0);
    const BatchSolution solution = solveForLineDelay(rig, 1);
    QCOMPARE(solution.state.cameras[0].exposure_share, 0.0);
    QCOMPARE(estimateUncertainty(rig.input, solution, heldLens(), RunContext{})
                 .report.cameras[0]
                 .exposure_share_std,
             0.0);
  }

  void shutterCalledGlobal_isToldOfWhereItRolls() {
    test::SimulatedRig rig = rigOfLineDelay(1, kLineDelay_us);
    rig.input.cameras[0].shutter = Shutter::Global;
    const UncertaintyEstimate estimate =
        estimateUncertainty(rig.input, solveForLineDelay(rig, 1), heldLens(), RunContext{});
    QVERIFY2(estimate.rolling_shutters.find("the shutter is rolling") != std::string::npos,
             estimate.rolling_shutters.c_str());
    QCOMPARE(estimate.report.cameras[0].line_delay_std_us, 0.0);
  }

  void globalShutter_isNot() {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const test::SimulatedRig rig = rigOfLineDelay(seed, 0.0);
      const UncertaintyEstimate estimate =
          estimateUncertainty(rig.input, solveForLineDelay(rig, seed), heldLens(), RunContext{});
      QVERIFY2(estimate.rolling_shutters.empty(), estimate.rolling_shutters.c_str());
    }
  }
};

EVICAL_TEST(TestLineDelay)
#include "tst_line_delay.moc"
