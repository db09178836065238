// Recordings from other simulators of pixels, in the folder EVICAL_DATA: the same scene, motion and IMU, seen
// by fast and by slow pixels. Their manifest lists the delays of the pixels, each measured in two ways.
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/session/session.h"

#include "tests/support/test_program.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace evical;

constexpr double kOtherPixelsSigmas = 3.0;

class TestOtherPixels : public QObject {
  Q_OBJECT

 private slots:
  void calibration_endsWithinItsSigmasOfTheTruth_data() {
    QTest::addColumn<QString>("recording");
    QTest::addColumn<QList<double>>("delays_ms");
    QTest::addColumn<bool>("slow");
    QTest::newRow("fast pixels") << QString("dark_3x7.iebcs") << QList<double>{-0.44, -0.58} << false;
    QTest::newRow("slow pixels") << QString("dark_3x7.v2e-default") << QList<double>{2.07, 2.39} << true;
  }

  void calibration_endsWithinItsSigmasOfTheTruth() {
    const QString folder = qEnvironmentVariable("EVICAL_DATA");
    if (folder.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
    QFETCH(QString, recording);
    QFETCH(QList<double>, delays_ms);
    QFETCH(bool, slow);
    const Session session = readSession((folder + "/pixels/" + recording + "/session.yaml").toStdString());
    const CalibrationRun run = calibrate(session, RunContext{});
    const CameraState& camera = run.result.state.cameras.front();
    const CameraUncertainty& sigma = run.result.uncertainty.cameras.front();

    constexpr double kClock_ms = 18.1;
    double sigmas = 1e9;
    for (const double delay_ms : delays_ms) {
      const double error_ms = 1e3 * camera.time_offset_s - (kClock_ms - delay_ms);
      sigmas = std::min(sigmas, std::abs(error_ms) / (1e3 * sigma.time_offset_std_s));
    }
    QVERIFY2(sigmas < kOtherPixelsSigmas, qPrintable(QString::number(sigmas)));

    const Eigen::Quaterniond truth(0.718680715156, 0.00610162138709, -0.695273307691, 0.00747177977426);
    const Eigen::Vector3d turn =
        quaternionLog(camera.reference_from_camera.rotation * truth.normalized().conjugate());
    const Eigen::Vector3d shift =
        camera.reference_from_camera.translation_m - Eigen::Vector3d(0.022, -0.041, 0.016);
    QVERIFY((turn.cwiseAbs().array() < kOtherPixelsSigmas * sigma.rotation_std_rad.array()).all());
    QVERIFY((shift.cwiseAbs().array() < kOtherPixelsSigmas * sigma.translation_std_m.array()).all());
    QVERIFY(sigma.rotation_std_rad.maxCoeff() < 0.1 * kRadPerDeg);
    const std::vector<std::string>& notes = run.result.notes;
    QCOMPARE(std::any_of(
                 notes.begin(), notes.end(),
                 [](const std::string& note) { return note.find("pixels are slow") != std::string::npos; }),
             slow);
  }
};

}  // namespace

EVICAL_TEST(TestOtherPixels)
#include "tst_other_pixels.moc"
