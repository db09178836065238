// A camera's motion in a window, estimated from slopes simulated from a known motion.
#include "core/egomotion/camera_record.h"

#include "core/egomotion/window_fit.h"
#include "core/geometry/so3.h"
#include "tests/support/moving_camera.h"
#include "tests/support/test_program.h"

#include <Eigen/LU>
#include <QTest>

#include <cmath>
#include <random>
#include <vector>

using namespace evical;
using namespace evical::test;

namespace {

const Eigen::Vector3d kRate(0.4, -0.7, 0.5), kVelocity(0.3, -0.1, 0.2);

MovingCamera steadyCamera(double speed) {
  MovingCamera camera;
  camera.rate_rad_s = [](double) { return kRate; };
  camera.velocity_m_s = [speed](double) { return Eigen::Vector3d(speed * kVelocity); };
  return camera;
}

WindowMotion motionOf(const MovingCamera& camera, unsigned seed, const EgomotionOptions& options = {}) {
  const LensRays lens(davisLens());
  std::mt19937 generator(seed);
  return estimateWindowMotion(edgeSlopes(camera, lens, 0.0, options.window_s, generator), lens, {}, options);
}

}  // namespace

class TestWindowMotion : public QObject {
  Q_OBJECT

 private slots:
  // Image motion of a static point, seen by a camera that moves for a short time.
  void imageMotion_matchesNumericDifferences() {
    const Eigen::Vector3d point(0.4, -0.3, 1.7), rate(0.3, -0.5, 0.8), velocity(0.2, 0.6, -0.4);
    const Eigen::Vector2d place = point.hnormalized();
    constexpr double kStep_s = 1e-6;
    const auto seen = [&](double time_s) {
      const Eigen::Matrix3d turned = so3Exp(rate * time_s);
      return Eigen::Vector2d((turned.transpose() * (point - velocity * time_s)).hnormalized());
    };
    const Eigen::Vector2d numeric = (seen(kStep_s) - seen(-kStep_s)) / (2.0 * kStep_s);
    const Eigen::Vector2d analytic =
        rotationalMotion(place) * rate + translationalMotion(place) * velocity / point.z();
    QVERIFY2((numeric - analytic).norm() < 1e-8, "1/s");
  }

  void estimate_onPerfectSlopes_isTheTruth_data() {
    QTest::addColumn<double>("speed");
    QTest::addColumn<double>("further");
    QTest::newRow("rotation alone") << 0.0 << 0.5;
    QTest::newRow("one depth") << 1.0 << 0.3;
    QTest::newRow("two depths") << 1.0 << 0.7;
  }
  void estimate_onPerfectSlopes_isTheTruth() {
    QFETCH(double, speed);
    QFETCH(double, further);
    MovingCamera camera = steadyCamera(speed);
    camera.further_1_m = further;
    EgomotionOptions options;
    options.depth_columns = 8;
    options.depth_rows = 6;
    options.depth_error = 0.2;
    const WindowMotion found = motionOf(camera, 1, options);
    QCOMPARE(found.use, WindowUse::Used);
    // Image patches do not coincide with regions of equal depth: an error of 2 % of the rate.
    QVERIFY2((found.rate_rad_s - kRate).norm() < (speed > 0.0 ? 0.02 : 1e-3), "rad/s");
    QVERIFY(found.inliers > 0.9);
    QCOMPARE(found.rotation_alone, speed == 0.0);
  }

  // It weights windows relative to each other at the start of the alignment, so only ratios matter.
  void covariance_growsAsTheErrorsDo() {
    constexpr int kSeeds = 40;
    std::array<double, 2> errors = {}, variances = {};
    for (const int noisy : {0, 1}) {
      MovingCamera camera = steadyCamera(0.0);
      camera.noise = noisy ? 0.15 : 0.05;
      for (unsigned seed = 0; seed < kSeeds; ++seed) {
        const WindowMotion found = motionOf(camera, seed);
        errors[static_cast<std::size_t>(noisy)] += (found.rate_rad_s - kRate).squaredNorm();
        variances[static_cast<std::size_t>(noisy)] += found.covariance.trace();
      }
    }
    const double grown = (variances[1] / variances[0]) / (errors[1] / errors[0]);
    QVERIFY2(errors[1] > 4.0 * errors[0], "noise must increase the error");
    QVERIFY2(grown > 0.5 && grown < 2.0, qPrintable(QString::number(grown)));
  }

  void tooFewSlopes_areAReason() {
    MovingCamera camera = steadyCamera(1.0);
    camera.slopes = 50;
    const WindowMotion found = motionOf(camera, 1);
    QCOMPARE(found.use, WindowUse::FewEdges);
    QCOMPARE(found.slopes, std::size_t{50});
  }
};

EVICAL_TEST(TestWindowMotion)
#include "tst_window_motion.moc"
