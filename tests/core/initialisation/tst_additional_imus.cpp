#include "core/initialisation/additional_imus.h"

#include "core/geometry/so3.h"
#include "core/initialisation/initialise.h"
#include "core/numerics/angles.h"
#include "tests/core/initialisation/simulated_input.h"
#include "tests/support/test_program.h"

#include <utility>

using namespace evical;
using namespace evical::test;

namespace {

SimulatedInput twoImus(double offset_s) {
  SimulationOptions options;
  options.duration_s = 10.0;
  options.second_imu = true;
  options.second_imu_offset_s = offset_s;
  return simulateInput(options);
}

// Accurate enough that the batch converges.
void verifyRoughlyForFurtherImus(const ImuState& found, const RigidTransform& reference_from_imu,
                                 double time_offset_s) {
  QVERIFY(kDegPerRad *
              rotationAngleBetween_rad(found.reference_from_imu.rotation, reference_from_imu.rotation) <
          0.5);
  QVERIFY((found.reference_from_imu.translation_m - reference_from_imu.translation_m).norm() < 0.02);
  QVERIFY(std::abs(found.time_offset_s - time_offset_s) < 1e-3);
}

}  // namespace

class TestFurtherImus : public QObject {
  Q_OBJECT

 private slots:
  void secondImu_isFound_data() {
    QTest::addColumn<double>("offset_s");
    QTest::newRow("0.03 s") << 0.03;
    QTest::newRow("-0.7 s") << -0.7;
    QTest::newRow("same clock") << 0.0;
  }
  void secondImu_isFound() {
    QFETCH(double, offset_s);
    const SimulatedInput simulated = twoImus(offset_s);
    const Initialisation initial = initialise(simulated.input, {}, RunContext{});
    QCOMPARE(initial.state.imus.size(), std::size_t{2});
    const ImuState& found = initial.state.imus[1];
    const SimulatedImu& truth = simulated.truth.imus[1];
    verifyRoughlyForFurtherImus(found, truth.reference_from_imu, offset_s);
    QVERIFY((found.gyroscope_bias_rad_s - truth.gyroscope_bias_rad_s).norm() < 5e-3);
    QVERIFY((found.accelerometer_bias_m_s2 - truth.accelerometer_bias_m_s2).norm() < 0.1);
  }

  // The reference need not be the first in the list.
  void referenceBehindTheOther_isUsed() {
    SimulatedInput simulated = twoImus(0.03);
    std::swap(simulated.input.imus[0], simulated.input.imus[1]);
    simulated.input.reference_imu = 1;
    const Initialisation initial = initialise(simulated.input, {}, RunContext{});
    verifyRoughlyForFurtherImus(initial.state.imus[0], simulated.truth.imus[1].reference_from_imu, 0.03);
    QCOMPARE(initial.state.imus[1].time_offset_s, 0.0);
    const SimulatedCamera& camera = simulated.truth.cameras[0];
    const CameraState& found = initial.state.cameras[0];
    QVERIFY(rotationAngleBetween_rad(found.reference_from_camera.rotation, camera.imu_from_camera.rotation) <
            0.01);
    QVERIFY(std::abs(found.time_offset_s - camera.time_offset_s) < 1e-3);
  }
};

EVICAL_TEST(TestFurtherImus)
#include "tst_additional_imus.moc"
