// Fixed, weighted and estimated quantities, and the axes of an IMU that never moved.
#include "core/optimisation/known_values.h"
#include "core/optimisation/weights.h"

#include "tests/core/optimisation/simulated_rig.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>

namespace {

using namespace evical;
using Eigen::Vector3d;

const QuantityInfo& timeOffset() {
  return quantityInfo(QuantityOwner::Camera, QuantityId::TimeOffset);
}
const QuantityInfo& gyroscopeMapping() {
  return quantityInfo(QuantityOwner::Imu, QuantityId::GyroscopeScaleMisalignment);
}

CalibrationInput oneOfEach() {
  CalibrationInput input;
  input.cameras.resize(1);
  input.cameras[0].name = "left";
  input.imus.resize(1);
  input.imus[0].name = "imu";
  return input;
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class TestKnownValues : public QObject {
  Q_OBJECT

 private slots:
  void effectivePrior_ofWhatIsReleased_isThePriorAsItIs() {
    const KnownNumber weighed{2e-3, 1e-4}, given{3e-3};
    QVERIFY(effectivePrior(timeOffset(), {}, std::optional(weighed)) == std::optional(weighed));
    QVERIFY(effectivePrior(timeOffset(), {}, std::optional(given)) == std::optional(given));
    QVERIFY(!effectivePrior(timeOffset(), {}, std::optional<KnownNumber>{}));
  }

  void effectivePrior_ofWhatIsNotReleased_isHeldAtThePriorOrAtZero() {
    OptimisationOptions options;
    options.free_time_offsets = false;
    const auto held = effectivePrior(timeOffset(), options, std::optional(KnownNumber{2e-3, 1e-4}));
    QVERIFY(held && held->isGiven());
    QCOMPARE(held->value, 2e-3);
    QCOMPARE(effectivePrior(timeOffset(), options, std::optional<KnownNumber>{})->value, 0.0);
    options.free_imu_intrinsics = false;
    const auto mapping = effectivePrior(gyroscopeMapping(), options, std::optional<KnownMapping>{});
    QVERIFY(mapping && mapping->isGiven());
    QVERIFY(mapping->value.isIdentity(0.0));
  }

  void isReleased_ofAGyroscopesRotation_isByOptionOrByAWeighedPrior() {
    const QuantityInfo& rotation = quantityInfo(QuantityOwner::Imu, QuantityId::GyroscopeRotation);
    OptimisationOptions options;
    options.gyroscope_rotation = Estimated::No;
    QVERIFY(!isReleased(rotation, options, false));
    QVERIFY(isReleased(rotation, options, true));
    options.gyroscope_rotation = Estimated::Yes;
    QVERIFY(isReleased(rotation, options, false));
    options.free_imu_intrinsics = false;
    QVERIFY(!isReleased(rotation, options, true));
  }

  void setGivenValues_replacesWhatTheStateHas_butNotWhatIsWeighed() {
    CalibrationInput input = oneOfEach();
    input.cameras[0].prior.time_offset = KnownNumber{4e-3};
    input.imus[0].prior.gyroscope_bias = KnownVector{Vector3d(1, 2, 3)};
    input.imus[0].prior.accelerometer_bias = KnownVector{Vector3d(1, 2, 3), Vector3d(1, 1, 1)};
    CalibrationState state;
    state.cameras.resize(1);
    state.imus.resize(1);
    setGivenValues(input, {}, state);
    QCOMPARE(state.cameras[0].time_offset_s, 4e-3);
    QVERIFY(state.imus[0].gyroscope_bias_rad_s == Vector3d(1, 2, 3));
    QVERIFY(state.imus[0].accelerometer_bias_m_s2.isZero(0.0));

    const std::vector<std::string> names = givenQuantities(input, {});
    QVERIFY(holds(names, "left.time_offset"));
    QVERIFY(holds(names, "imu.gyroscope_bias"));
    QVERIFY(!holds(names, "imu.accelerometer_bias"));
  }

  void givenQuantities_leaveOutTheReferencesOwnPlace() {
    CalibrationInput input = oneOfEach();
    input.imus[0].prior.translation = KnownVector{Vector3d::Zero()};
    QVERIFY(!holds(givenQuantities(input, {}), "imu.translation"));
    input.imus.resize(2);
    input.imus[1].name = "second";
    input.imus[1].prior.translation = KnownVector{Vector3d::Zero()};
    QVERIFY(holds(givenQuantities(input, {}), "second.translation"));
  }

  void stillAxes_ofRichMotion_areNone() {
    const test::SimulatedRig rig = test::simulateRig(test::shortRecording());
    const UnexcitedAxes still = stillAxes(rig.input, rig.truth, givenWeights(rig.input), 0);
    QVERIFY(still.gyroscope.empty());
  }

  void stillAxes_ofRotationAboutOneAxis_areTheTwoAcrossIt() {
    test::RigOptions options = test::shortRecording();
    options.motion = test::Motion::OneAxisRotation;
    const test::SimulatedRig rig = test::simulateRig(options);
    const UnexcitedAxes still = stillAxes(rig.input, rig.truth, givenWeights(rig.input), 0);
    QCOMPARE(still.gyroscope.size(), std::size_t{2});
    // The axis that moved, according to the samples themselves.
    Vector3d axis = Vector3d::Zero();
    for (const ImuSample& sample : rig.input.imus[0].samples) {
      const Vector3d rate = sample.angular_rate_rad_s - rig.truth.imus[0].gyroscope_bias_rad_s;
      if (rate.norm() > axis.norm()) axis = rate;
    }
    axis.normalize();
    for (const Vector3d& across : still.gyroscope) QVERIFY(std::abs(across.dot(axis)) < 0.02);
    const std::vector<Vector3d> axesWithoutRotation = still.axesWithoutRotation();
    QCOMPARE(axesWithoutRotation.size(), std::size_t{1});
    QVERIFY(std::abs(axesWithoutRotation[0].dot(axis)) > 0.999);
  }

  void leverless_areAllWithoutRotation_andNoneWithTwoAxes() {
    UnexcitedAxes still;
    still.gyroscope = {Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ()};
    QCOMPARE(still.axesWithoutRotation().size(), std::size_t{3});
    still.gyroscope = {Vector3d::UnitX()};
    QVERIFY(still.axesWithoutRotation().empty());
  }
};

}  // namespace

EVICAL_TEST(TestKnownValues)
#include "tst_known_values.moc"
