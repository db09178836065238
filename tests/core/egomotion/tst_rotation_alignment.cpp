// A camera next to a gyroscope, with edges simulated from a known motion: errors, and sigmas over seeds.
#include "core/egomotion/rotation_alignment.h"

#include "core/base/error.h"
#include "core/geometry/so3.h"
#include "tests/support/moving_camera.h"
#include "tests/support/test_program.h"

#include <QTest>

#include <algorithm>
#include <cmath>
#include <stop_token>
#include <vector>

using namespace evical;
using namespace evical::test;

namespace {

constexpr double kOffset_s = 0.0073;
const Eigen::Vector3d kBias(0.011, -0.007, 0.004);

Eigen::Quaterniond mounting() {
  return quaternionExp(Eigen::Vector3d(0.4, -1.5, 0.3));
}

// Sums of sinusoids as the IMU's motion; `axes`: amplitude of the rotation about each axis.
Eigen::Vector3d rateAt(double time_s, const Eigen::Vector3d& axes) {
  Eigen::Vector3d rate;
  for (int axis = 0; axis < 3; ++axis) {
    rate[axis] = 0.0;
    for (int k = 0; k < 3; ++k)
      rate[axis] +=
          axes[axis] * 0.4 * std::sin((1.3 + 1.1 * k + 0.37 * axis) * time_s + 1.7 * axis + 0.9 * k);
  }
  return rate;
}

Eigen::Vector3d walkAt(double time_s) {
  return 0.15 *
         Eigen::Vector3d(std::sin(0.9 * time_s), std::sin(1.9 * time_s + 1.0), std::sin(0.7 * time_s + 2.0));
}

struct Rig {
  Eigen::Vector3d axes = Eigen::Vector3d::Ones();
  Eigen::Vector3d lever_m =
      Eigen::Vector3d::Zero();  // from what it turns about to the camera, in the camera's frame
  bool walks = false;
  double noise = 0.05;
};

struct Record {
  std::vector<ImuSample> samples;
  CameraRecord camera;
};

Record recordOf(unsigned seed, double duration_s, const Rig& rig = {}) {
  Record record;
  for (int k = -400; k < static_cast<int>(200.0 * duration_s) + 400; ++k) {
    ImuSample& sample = record.samples.emplace_back();
    sample.time_ns = 5'000'000LL * k;
    sample.angular_rate_rad_s = rateAt(0.005 * k, rig.axes) + kBias;
  }
  MovingCamera camera;
  camera.slopes = 120;
  camera.noise = rig.noise;
  camera.rate_rad_s = [rig](double time_s) {
    return Eigen::Vector3d(mounting().conjugate() * rateAt(time_s + kOffset_s, rig.axes));
  };
  camera.velocity_m_s = [rig, rate = camera.rate_rad_s](double time_s) {
    return Eigen::Vector3d(rate(time_s).cross(rig.lever_m) +
                           (rig.walks ? walkAt(time_s) : Eigen::Vector3d::Zero()));
  };
  record.camera = cameraRecord(camera, LensRays(davisLens()), 0.0, duration_s, quickEgomotion(), seed);
  return record;
}

RotationAlignment aligned(Record& record, const Eigen::Quaterniond& start, double offset_s) {
  const ImuState imu;
  return alignRotation(record.camera, LensRays(davisLens()), {record.samples, 0, imu}, {start, offset_s},
                       quickEgomotion(), 1);
}

double turnedBy_deg(const RotationAlignment& found) {
  return 57.29578 * quaternionLog(found.imu_from_camera * mounting().conjugate()).norm();
}

}  // namespace

class TestRotationAlignment : public QObject {
  Q_OBJECT

 private slots:
  // From 1 to 90 degrees and half a second away.
  void alignment_isFoundFromFar_data() {
    QTest::addColumn<double>("turn_rad");
    QTest::addColumn<double>("late_s");
    QTest::newRow("near") << 0.01 << 0.001;
    QTest::newRow("turned by a quarter") << 1.57 << 0.0;
    QTest::newRow("late by half a second") << 0.05 << 0.5;
  }
  void alignment_isFoundFromFar() {
    QFETCH(double, turn_rad);
    QFETCH(double, late_s);
    Record record = recordOf(3, 20.0);
    const Eigen::Quaterniond start = quaternionExp(Eigen::Vector3d(turn_rad, 0.0, 0.0)) * mounting();
    const RotationAlignment found = aligned(record, start, kOffset_s + late_s);
    QVERIFY2(found.found(), found.failure.c_str());
    QVERIFY2(turnedBy_deg(found) < 0.1, qPrintable(QString::number(turnedBy_deg(found))));
    QVERIFY2(std::abs(found.time_offset_s - kOffset_s) < 3e-4,
             qPrintable(QString::number(found.time_offset_s)));
    QVERIFY2((found.gyroscope_bias_rad_s - kBias).norm() < 0.005, "rad/s");
  }

  // Walking, and rotation about a point at 0.2 m from the camera: v = w x l looks like a rotation if depths
  // are unknown.
  void translation_doesNotTurnTheResult_data() {
    QTest::addColumn<double>("lever_x_m");
    QTest::addColumn<bool>("walks");
    QTest::newRow("walk") << 0.0 << true;
    QTest::newRow("lever") << 0.2 << false;
  }
  void translation_doesNotTurnTheResult() {
    QFETCH(double, lever_x_m);
    QFETCH(bool, walks);
    Rig rig;
    rig.walks = walks;
    rig.lever_m.x() = lever_x_m;
    Record record = recordOf(4, 30.0, rig);
    const RotationAlignment found = aligned(record, mounting(), kOffset_s);
    QVERIFY2(found.found(), found.failure.c_str());
    QVERIFY2(turnedBy_deg(found) < 0.5, qPrintable(QString::number(turnedBy_deg(found))));
    const Eigen::Vector3d error = quaternionLog(found.imu_from_camera * mounting().conjugate());
    const double square =
        error.dot(Eigen::Matrix3d(found.covariance.topLeftCorner<3, 3>()).ldlt().solve(error));
    QVERIFY2(square < 16.0, qPrintable(QString::number(square)));  // of three numbers: 99.9 %
  }

  void sigmas_areThoseOfTheErrors() {
    constexpr int kSeeds = 12;
    Rig rig;
    rig.noise = 0.15;
    double rotation = 0.0, offset = 0.0;
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      Record record = recordOf(seed, 24.0, rig);
      const RotationAlignment found = aligned(record, mounting(), kOffset_s);
      QVERIFY2(found.found(), found.failure.c_str());
      const Eigen::Vector3d error = quaternionLog(found.imu_from_camera * mounting().conjugate());
      for (int axis = 0; axis < 3; ++axis)
        rotation += error[axis] * error[axis] / found.covariance(axis, axis) / (3.0 * kSeeds);
      const double late_s = found.time_offset_s - kOffset_s;
      offset += late_s * late_s / found.covariance(3, 3) / kSeeds;
    }
    // RMS values of up to 1.4, of 36 and of 12 quantities; below one, since sigmas include the uncertainty
    // from unknown depths.
    QVERIFY2(rotation > 0.2 && rotation < 1.96, qPrintable(QString::number(rotation)));
    QVERIFY2(offset > 0.1 && offset < 2.2, qPrintable(QString::number(offset)));
  }

  // Rotation about one axis does not determine the rotation about it; the sigmas show this.
  void oneAxis_leavesThatAxisOpen() {
    Rig rig;
    rig.axes = {0.0, 0.0, 1.0};
    Record record = recordOf(1, 30.0, rig);
    const RotationAlignment found = aligned(record, mounting(), kOffset_s);
    if (!found.found()) return;
    const Eigen::Vector3d sigmas = found.covariance.diagonal().head<3>().cwiseSqrt();
    QVERIFY2(sigmas.z() > 10.0 * sigmas.x(), qPrintable(QString::number(sigmas.z())));
    QVERIFY(std::abs((mounting() * found.weakest_in_camera).z()) > 0.9);
  }

  void gapInTheGyroscope_leavesItsWindowsOut() {
    Record record = recordOf(5, 24.0);
    std::erase_if(record.samples, [](const ImuSample& sample) {
      return sample.time_ns > 5'000'000'000 && sample.time_ns < 7'000'000'000;
    });
    const RotationAlignment found = aligned(record, mounting(), kOffset_s);
    QVERIFY2(found.found(), found.failure.c_str());
    const auto left_out =
        std::count_if(record.camera.windows.begin(), record.camera.windows.end(),
                      [](const WindowMotion& window) { return window.use == WindowUse::NoGyroscope; });
    QVERIFY2(left_out >= 24 && left_out < 30, qPrintable(QString::number(left_out)));
  }

  void stop_endsIt() {
    Record record = recordOf(1, 24.0);
    std::stop_source stop;
    stop.request_stop();
    const ImuState imu;
    QVERIFY_THROWS_EXCEPTION(
        Cancelled,
        alignRotation(record.camera, LensRays(davisLens()), {record.samples, 0, imu}, {mounting(), kOffset_s},
                      quickEgomotion(), 1, RunContext{silentProgress(), stop.get_token()}));
  }

  void shortRecording_isAReason() {
    Record record = recordOf(1, 5.0);
    QVERIFY(!aligned(record, mounting(), kOffset_s).found());
  }
};

EVICAL_TEST(TestRotationAlignment)
#include "tst_rotation_alignment.moc"
