// A camera beside a gyroscope, from windows that a known rotation makes: errors, and sigmas over seeds.
#include "core/egomotion/rotation_alignment.h"

#include "core/geometry/rigid_transform.h"
#include "core/geometry/so3.h"
#include "tests/support/test_program.h"

#include <QTest>

#include <cmath>
#include <random>
#include <vector>

using namespace evical;

namespace {

constexpr double kOffset_s = 0.0073, kWindow_s = 0.04;
const Eigen::Vector3d kBias(0.011, -0.007, 0.004);

Eigen::Quaterniond mounting() {
  return quaternionExp(Eigen::Vector3d(0.4, -1.5, 0.3));
}

// Sums of sinusoids; `axes`: how much of each the rig turns about.
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

struct Record {
  std::vector<ImuSample> samples;
  std::vector<WindowMotion> windows;
};

Record recordOf(unsigned seed, double duration_s, const Eigen::Vector3d& axes = Eigen::Vector3d::Ones()) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Record record;
  for (int k = -200; k < static_cast<int>(200.0 * duration_s) + 200; ++k) {
    ImuSample& sample = record.samples.emplace_back();
    sample.time_ns = 5'000'000LL * k;
    sample.angular_rate_rad_s = rateAt(0.005 * k, axes) + kBias;
  }
  constexpr double kSigma_rad_s = 0.02;
  for (double begin_s = 0.0; begin_s + kWindow_s < duration_s; begin_s += kWindow_s) {
    WindowMotion& window = record.windows.emplace_back();
    window.use = WindowUse::Used;
    window.begin_s = begin_s;
    window.end_s = begin_s + kWindow_s;
    window.part_weights.fill(1.0 / static_cast<double>(WindowMotion::kParts));
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (int k = 0; k < 20; ++k)
      mean += rateAt(begin_s + (k + 0.5) / 20.0 * kWindow_s + kOffset_s, axes) / 20.0;
    window.rate_rad_s =
        mounting().conjugate() * mean +
        kSigma_rad_s * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
    window.turning_alone_rad_s = window.rate_rad_s;
    window.covariance = kSigma_rad_s * kSigma_rad_s * Eigen::Matrix3d::Identity();
  }
  return record;
}

RotationAlignment aligned(Record& record, const Eigen::Quaterniond& start, double offset_s) {
  const ImuState imu;
  return alignRotation(record.windows, {record.samples, 0, imu}, {start, offset_s}, {});
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
    QVERIFY2(quaternionLog(found.imu_from_camera * mounting().conjugate()).norm() < 0.006, "rad");
    QVERIFY2(std::abs(found.time_offset_s - kOffset_s) < 0.002, "s");
    QVERIFY2((found.gyroscope_bias_rad_s - kBias).norm() < 0.005, "rad/s");
  }

  void sigmas_areThoseOfTheErrors() {
    constexpr int kSeeds = 20;
    double rotation = 0.0, offset = 0.0;
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      Record record = recordOf(seed, 30.0);
      const RotationAlignment found = aligned(record, mounting(), kOffset_s);
      QVERIFY2(found.found(), found.failure.c_str());
      const Eigen::Vector3d error = quaternionLog(found.imu_from_camera * mounting().conjugate());
      for (int axis = 0; axis < 3; ++axis)
        rotation += error[axis] * error[axis] / found.covariance(axis, axis) / (3.0 * kSeeds);
      const double late_s = found.time_offset_s - kOffset_s;
      offset += late_s * late_s / found.covariance(3, 3) / kSeeds;
    }
    // RMS of 0.7 to 1.4, of 60 and of 20 numbers.
    QVERIFY2(rotation > 0.49 && rotation < 1.96, qPrintable(QString::number(rotation)));
    QVERIFY2(offset > 0.3 && offset < 2.2, qPrintable(QString::number(offset)));
  }

  // Turning about one axis leaves the rotation about it open, and the sigmas say so.
  void oneAxis_leavesThatAxisOpen() {
    Record record = recordOf(1, 30.0, {0.0, 0.0, 1.0});
    const RotationAlignment found = aligned(record, mounting(), kOffset_s);
    if (!found.found()) return;
    const Eigen::Vector3d sigmas = found.covariance.diagonal().head<3>().cwiseSqrt();
    QVERIFY2(sigmas.z() > 10.0 * sigmas.x(), qPrintable(QString::number(sigmas.z())));
    QVERIFY(std::abs((mounting() * found.weakest_in_camera).z()) > 0.9);
  }

  // What translation turns the windows by is in the sigmas in its part, and never in the rotation.
  void whatTranslationMayLeave_isInTheSigmas() {
    Record record = recordOf(2, 30.0);
    const RotationAlignment found = aligned(record, mounting(), kOffset_s);
    const Eigen::Matrix3d turned = so3Exp(Eigen::Vector3d(0.0, 0.0, 0.1));
    for (WindowMotion& window : record.windows) window.turning_alone_rad_s = turned * window.rate_rad_s;
    const RotationAlignment doubted = aligned(record, mounting(), kOffset_s);
    QVERIFY2(found.found() && doubted.found(), doubted.failure.c_str());
    QVERIFY(rotationAngleBetween_rad(found.imu_from_camera, doubted.imu_from_camera) < 1e-9);
    QVERIFY2(std::abs(doubted.turning_alone.head<3>().norm() - 0.1) < 0.01, "rad");
    const double more =
        doubted.covariance.topLeftCorner<3, 3>().trace() - found.covariance.topLeftCorner<3, 3>().trace();
    const double left = EgomotionOptions{}.translation_left * 0.1;
    QVERIFY2(std::abs(more - left * left) < 0.2 * left * left, qPrintable(QString::number(more)));
  }

  void gapInTheGyroscope_leavesItsWindowsOut() {
    Record record = recordOf(5, 20.0);
    std::erase_if(record.samples, [](const ImuSample& sample) {
      return sample.time_ns > 5'000'000'000 && sample.time_ns < 7'000'000'000;
    });
    const RotationAlignment found = aligned(record, mounting(), kOffset_s);
    QVERIFY2(found.found(), found.failure.c_str());
    const auto left_out =
        std::count_if(record.windows.begin(), record.windows.end(),
                      [](const WindowMotion& window) { return window.use == WindowUse::NoGyroscope; });
    QVERIFY2(left_out >= 49 && left_out < 60, qPrintable(QString::number(left_out)));
  }

  void shortRecording_isAReason() {
    Record record = recordOf(1, 5.0);
    QVERIFY(!aligned(record, mounting(), kOffset_s).found());
  }
};

EVICAL_TEST(TestRotationAlignment)
#include "tst_rotation_alignment.moc"
