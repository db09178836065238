#include "core/initialisation/initialisation_options.h"
#include "core/numerics/angles.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/session/session_priors.h"
#include "tests/core/pipeline/session/refused_session.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <cmath>
#include <fstream>

using namespace evical;

namespace {

const char* const kSession = R"(evical_session: 1
recording: recording.bag
board: {type: asymmetric_circles, rows: 11, cols: 4, spacing_m: 0.05, radius_m: 0.02}
cameras:
  left: {stream: /left/events}
  right: {stream: /right/events}
imus:
  left_imu: {stream: /left/imu, accelerometer_noise_density: 1.86e-3, gyroscope_noise_density: 1.87e-4}
  right_imu: {stream: /right/imu, accelerometer_noise_density: 1.86e-3, gyroscope_noise_density: 1.87e-4}
reference: left_imu
prior:
)";

const char* const kPriors = R"(  time_offset_search_s: 0.5
  gravity_norm_m_s2: 9.7803
  cameras:
    left:
      reference_from_camera: {rotation_xyzw: [0.5, -0.5, 0.5, 0.5], rotation_std_deg: [0.1, 0.2, 0.3],
                              translation_m: [0.04, -0.03, 0.05], translation_std_m: 0.002}
      time_offset_s: 0.0073
      time_offset_std_s: 1e-4
  imus:
    left_imu:
      gyroscope: {bias_rad_s: [0.01, -0.02, 0.005], bias_std_rad_s: [1e-3, 2e-3, 3e-3]}
    right_imu:
      reference_from_imu: {translation_m: [0.1, 0, 0]}
      time_offset_s: -0.002
      gyroscope: {mapping: [[1.01, 0.002, 0], [0, 0.99, 0.001], [0, 0, 1]], mapping_std: 0.003}
      accelerometer: {bias_m_s2: [0.1, 0.05, -0.08], mapping: [[1, 0, 0], [0, 1, 0], [0, 0, 1.002]]}
)";

// Sensors as written in a result, including the reference.
const char* const kPasted = R"(  cameras:
    left:
      stream: /left/events
      reference_from_camera:
        rotation_xyzw: [0, 0, 0, 1]
        translation_m: [0.04, -0.03, 0.05]
        rotation_std_deg: [0.01, 0.02, 0.03]
        translation_std_m: [0.0001, 0.0002, 0.0003]
      time_offset_s: 0.005
      time_offset_std_s: 0
      clock_drift_ppm: 12
      clock_drift_std_ppm: 1
      kind: events
      latency_s: 0.001
      latency_std_s: 0.0001
      latency_against: right
      edge_localisation_bias_px: 0.1
      intrinsics: {model: pinhole_radtan}
      reprojection_rms_px: 0.05
      windows: {total: 100, complete: 90, partial: 0, used: 90}
  imus:
    left_imu:
      rate_hz: 1000
      reference_from_imu:
        rotation_xyzw: [0, 0, 0, 1]
        translation_m: [0, 0, 0]
        rotation_std_deg: [0, 0, 0]
        translation_std_m: [0, 0, 0]
      time_offset_s: 0
      time_offset_std_s: 0
      gyroscope:
        bias_rad_s: [0.01, 0, 0]
        bias_std_rad_s: [1e-05, 1e-05, 1e-05]
        mapping: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        mapping_std: [[0, 0, 0], [0, 0, 0], [0, 0, 0]]
        residual_rms_rad_s: 0.005
)";

}  // namespace

class TestSessionPriors : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;
  std::filesystem::path file() const {
    return std::filesystem::path(scratch_.path().toStdString()) / "session.yaml";
  }
  Session read(const QString& priors) const {
    std::ofstream(file()) << kSession << priors.toStdString();
    return readSession(file());
  }

 private slots:
  void initTestCase() { std::ofstream(file().parent_path() / "recording.bag") << "x"; }

  void priors_areRead() {
    const Session session = read(kPriors);
    QCOMPARE(session.options.initialisation->time_offset_search_s, 0.5);
    QCOMPARE(session.options.initialisation->gravity_m_s2, 9.7803);
    QVERIFY(!session.options.optimisation->free_gravity_norm);
    const SensorPrior& left = session.cameras[0].prior;
    QVERIFY(left.rotation->value.isApprox(Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)));
    QVERIFY((kDegPerRad * *left.rotation->sigma - Eigen::Vector3d(0.1, 0.2, 0.3)).norm() < 1e-12);
    QVERIFY(left.translation->value == Eigen::Vector3d(0.04, -0.03, 0.05));
    QVERIFY(*left.translation->sigma == Eigen::Vector3d::Constant(0.002));
    QCOMPARE(left.time_offset->value, 0.0073);
    QCOMPARE(*left.time_offset->sigma, 1e-4);
    QVERIFY(session.cameras[1].prior == SensorPrior{});
    const ImuPrior &reference = session.imus[0].prior, &right = session.imus[1].prior;
    QVERIFY(!reference.rotation && !reference.translation && !reference.time_offset);
    QVERIFY(*reference.gyroscope_bias->sigma == Eigen::Vector3d(1e-3, 2e-3, 3e-3));
    QVERIFY(right.translation->isGiven() && !right.rotation);
    QVERIFY(right.time_offset->isGiven());
    QCOMPARE(right.gyroscope_scale_misalignment->value(0, 1), 0.002);
    QCOMPARE((*right.gyroscope_scale_misalignment->sigma)(1, 2), 0.003);
    QVERIFY(right.accelerometer_bias->isGiven() && right.accelerometer_scale_misalignment->isGiven());
  }

  void priors_writtenAndRead_areTheSame() {
    const Session session = read(kPriors);
    writeSession(session, file());
    const Session again = readSession(file());
    QVERIFY(again.options == session.options);
    for (std::size_t i = 0; i < 2; ++i) {
      QVERIFY(again.cameras[i].prior == session.cameras[i].prior);
      QVERIFY(again.imus[i].prior == session.imus[i].prior);
    }
    QCOMPARE(sessionYaml(again, file().parent_path()), sessionYaml(session, file().parent_path()));
  }

  void gravityWithASigma_isFree() {
    const Session session = read("  gravity_norm_m_s2: 9.79\n  gravity_norm_std_m_s2: 0.01\n");
    QVERIFY(session.options.optimisation->free_gravity_norm);
    QCOMPARE(session.options.optimisation->gravity_norm_sigma_m_s2, 0.01);
    writeSession(session, file());
    QVERIFY(readSession(file()).options == session.options);
  }

  void gravityByPlace_isNormalGravity() {
    const Session session = read("  time_offset_search_s: 1\ngravity: {latitude_deg: 45, height_m: 1000}\n");
    // GRS 80 has 9.80620 m/s^2 at 45 deg on the ellipsoid, and 3.086e-6 m/s^2 less for each metre above it.
    QVERIFY(std::abs(session.options.initialisation->gravity_m_s2 - 9.80311) < 2e-5);
    QCOMPARE(session.options.optimisation->gravity_norm_sigma_m_s2, 1e-3);
    QVERIFY(session.options.optimisation->free_gravity_norm);
    writeSession(session, file());
    QVERIFY(readSession(file()).options == session.options);
  }

  void sensorsOfAResult_canBePasted() {
    const Session session = read(kPasted);
    QVERIFY(session.cameras[0].prior.translation->sigma.has_value());
    QVERIFY(session.cameras[0].prior.time_offset->isGiven());
    QVERIFY(!session.imus[0].prior.rotation);
    QVERIFY(session.imus[0].prior.gyroscope_scale_misalignment->isGiven());
    QVERIFY(session.imus[0].prior.gyroscope_bias->sigma.has_value());
  }

  // A quantity that was not estimated is not a prior; a known misalignment is one, with or without sigmas.
  void gyroscopesRotationOfAResult_isAPrior() {
    const QString none = QString(kPasted) +
                         "        gyroscope_from_accelerometer_xyzw: [0, 0, 0, 1]\n"
                         "        rotation_std_deg: [0, 0, 0]\n";
    QVERIFY(!read(none).imus[0].prior.gyroscope_rotation);
    const QString turned =
        QString(kPasted) + "        gyroscope_from_accelerometer_xyzw: [0, 0.0871557427, 0, 0.9961946981]\n";
    const auto given = read(turned).imus[0].prior.gyroscope_rotation;
    QVERIFY(given && given->isGiven());
    QVERIFY(std::abs(given->value.angularDistance(Eigen::Quaterniond::Identity()) - M_PI / 18.0) < 1e-9);
    QVERIFY(
        read(turned + "        rotation_std_deg: [0, 0, 0]\n").imus[0].prior.gyroscope_rotation->isGiven());
    const auto weighed = read(turned + "        rotation_std_deg: 0.5\n").imus[0].prior.gyroscope_rotation;
    QVERIFY((*weighed->sigma - Eigen::Vector3d::Constant(M_PI / 360.0)).norm() < 1e-12);
  }

  void anotherReference_isRefused() {
    Session session = read(kPriors);
    session.reference = "right_imu";
    QVERIFY_THROWS_EXCEPTION(CalibrationError, validate(session, "window"));
  }

  void mistake_isRefusedWithItsPlace_data() {
    QTest::addColumn<QString>("from");
    QTest::addColumn<QString>("to");
    QTest::addColumn<QStringList>("said");
    const auto row = [](const char* name, const char* from, const char* to, const QStringList& said) {
      QTest::newRow(name) << QString(from) << QString(to) << said;
    };
    row("unknown camera", "    left:\n", "    lefd:\n",
        {"prior.cameras.lefd (line 15)", "Did you mean 'left'?"});
    row("unknown IMU", "    right_imu:\n", "    right_inu:\n",
        {"prior.imus.right_inu", "Did you mean 'right_imu'?"});
    row("unknown key", "time_offset_std_s", "time_offset_sdt_s",
        {"prior.cameras.left.time_offset_sdt_s (line 19)", "'time_offset_std_s'"});
    row("unknown group", "  imus:", "  imu:", {"prior.imu (line 20)", "'imus'"});
    row("quaternion's norm", "[0.5, -0.5, 0.5, 0.5]", "[0.5, -0.5, 0.5, 0.6]",
        {"rotation_xyzw (line 16)", "unit quaternion"});
    row("quaternion's size", "[0.5, -0.5, 0.5, 0.5]", "[0, 0, 1]", {"rotation_xyzw", "3 numbers"});
    row("not finite", "[0.04, -0.03, 0.05]", "[0.04, .nan, 0.05]", {"translation_m", ".nan"});
    row("millimetres", "[0.04, -0.03, 0.05]", "[400, -30, 50]", {"translation_m", "unit"});
    row("negative sigma", "0.002}", "-0.002}", {"translation_std_m", "must be positive"});
    row("one sigma of 0", "[0.1, 0.2, 0.3]", "[0.1, 0, 0.3]", {"rotation_std_deg", "0 for some"});
    row("sigma without value", "translation_m: [0.1, 0, 0]", "translation_std_m: 0.1",
        {"translation_std_m", "without translation_m"});
    row("lower triangle", "[0, 0.99, 0.001]", "[0.1, 0.99, 0.001]",
        {"gyroscope.mapping", "upper triangular"});
    row("scale of 0", "[0, 0, 1.002]", "[0, 0, 0]", {"accelerometer.mapping", "scales near 1"});
    row("sigmas of a mapping", "mapping_std: 0.003", "mapping_std: [0.003]", {"mapping_std", "three rows"});
    row("time offset", "0.0073", "soon", {"time_offset_s (line 18)", "'soon'"});
    row("own place", "    left_imu:\n",
        "    left_imu:\n      reference_from_imu: {translation_m: [0.1, 0, 0]}\n",
        {"prior.imus.left_imu.reference_from_imu (line 22)", "reference itself"});
    row("own clock", "    left_imu:\n", "    left_imu:\n      time_offset_s: 0.1\n",
        {"prior.imus.left_imu.time_offset_s (line 22)", "reference itself"});
    row("gravity", "9.7803", "978.03", {"prior.gravity_norm_m_s2 (line 13)", "100 m/s^2"});
  }
  void mistake_isRefusedWithItsPlace() {
    QFETCH(QString, from);
    QFETCH(QString, to);
    QFETCH(QStringList, said);
    QVERIFY(QString(kPriors).contains(from));
    try {
      read(QString(kPriors).replace(from, to));
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      test::verifyRefusal(error, said);
    }
  }
};

EVICAL_TEST(TestSessionPriors)
#include "tst_session_priors.moc"
