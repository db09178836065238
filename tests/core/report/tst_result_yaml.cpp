#include "core/base/error.h"
#include "core/geometry/so3.h"
#include "core/report/csv.h"
#include "core/report/result_table.h"
#include "core/report/truth_comparison.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <fstream>
#include <limits>

using namespace evical;

namespace {

NamedResult sampleForResultYaml() {
  NamedResult named;
  named.reference = "left_imu";
  named.cameras = {{"left", "/left/events"}, {"1 odd: name"}};
  named.cameras[1].kind = CameraKind::Frames;
  named.imus = {{"left_imu", "/left/imu", {1.0 / 3000.0, 2e-3, 1e-5, 1e-4}, 997.25},
                {"far_imu", "/far imu: odd"}};
  named.version = "0.1.0";
  CameraIntrinsics intrinsics;
  intrinsics.resolution_px = {346, 260};
  intrinsics.focal_length_px = {1.0 / 3.0 + 260.0, 255.0};
  intrinsics.principal_point_px = {170.25, 131.0};
  intrinsics.distortion = {-0.3, 0.1, 1e-3, 2e-3, 0.05};
  named.options = {{"grid.min_circles", "6", "7", "4", "1000", "", "", {}}};
  CalibrationResult& result = test::ownResult(named);
  result.status = CalibrationStatus::Doubtful;
  result.reason = "planar motion: \"z\" is a guess\nand more";
  result.causes = {QualityWarning{"the lens: \"z\" is inaccurate",
                                  Repair{"optimisation.model.camera_intrinsics", "free"}, "lens", 0.875},
                   QualityWarning{"planar motion", {}, "observability"}};
  result.start_ns = 1'700'000'000'123'456'789;
  result.notes = {"IMU gap of 0.2 s"};
  result.memory_peak_mb = 310.0;
  result.timing.total_s = 6.4;
  for (int i = 0; i < 2; ++i) {
    CameraState camera;
    camera.reference_from_camera = {quaternionExp(Eigen::Vector3d(1.1, -0.7, 0.1 * i)),
                                    {0.01, -1.0 / 3.0, 1e-9}};
    camera.time_offset_s = 0.1 / 3.0;
    camera.edge_localisation_bias_px = -0.021;
    camera.slow_edge_localisation_bias_px = 0.003;
    result.state.cameras.push_back(camera);
    ImuState imu;
    if (i == 1) imu.reference_from_imu = {quaternionExp(Eigen::Vector3d(0.0, 0.2, 0.0)), {0.1, 0.0, 0.0}};
    imu.gyroscope_bias_rad_s = {0.01, -0.02, 1.0 / 7.0};
    imu.gyroscope_scale_misalignment(0, 1) = 0.003;
    imu.accelerometer_scale_misalignment(2, 2) = 1.01;
    imu.gyroscope_from_accelerometer = quaternionExp({0.01, -0.02, 0.005});
    imu.accelerometer_delay_s = 0.01 / 3.0;
    result.state.imus.push_back(imu);
    CameraUncertainty sigma;
    sigma.rotation_std_rad.setConstant(1e-4);
    sigma.translation_std_m.setConstant(2e-4);
    sigma.time_offset_std_s = 1.2e-5;
    sigma.edge_localisation_bias_std_px = std::numeric_limits<double>::quiet_NaN();
    result.uncertainty.cameras.push_back(sigma);
    ImuUncertainty imu_sigma;
    imu_sigma.gyroscope_bias_std_rad_s.setConstant(1e-5);
    imu_sigma.gyroscope_scale_misalignment_std(0, 1) = 1e-4;
    imu_sigma.gyroscope_rotation_std_rad = {1e-4, 2e-4, 3e-4};
    result.uncertainty.imus.push_back(imu_sigma);
    CameraFit fit;
    fit.reprojection_rms_px = 0.12;
    fit.windows_total = 1500;
    fit.windows_complete = 1320;
    fit.circles_rejected = 3;
    result.cameras.push_back(fit);
    result.imus.push_back({0.002, 0.05});
  }
  result.state.cameras[0].lens = givenLens(intrinsics);
  result.uncertainty.cameras[0].intrinsics_std = {0.05, 0.06, 0.1, 0.12, 1e-4, 2e-4, 3e-5, 4e-5, 5e-3};
  result.state.gravity_in_world_m_s2 = {0.1, 9.7, 1.4};
  result.uncertainty.gravity_norm_std_m_s2 = 0.012;
  result.uncertainty.given = {"left.time_offset", "1 odd: name.rotation"};
  result.uncertainty.weakest = "translation along the camera's z axis";
  result.uncertainty.observability = {0.5, 12.0};
  result.uncertainty.directions = {"translation along the camera's z axis", "time offset of 1 odd: name"};
  result.uncertainty.columns = {{QuantityOwner::Camera, 1, QuantityId::Rotation, 1},
                                {QuantityOwner::Imu, 0, QuantityId::AccelerometerDelay}};
  result.uncertainty.standard_deviations = Eigen::Vector2d(1e-4, 2e-4);
  SplitHalfCheck validation;
  validation.block_s = 2.5;
  validation.windows = {12, 13};
  validation.rms_sigmas = 1.25;
  validation.quantities = {{"left.rotation.x", "deg", -0.01, 0.02},
                           {"1 odd: name.time_offset", "", 3.0, 0.0}};
  result.split_half_check = validation;
  result.uncertainty.correlation = (Eigen::Matrix2d() << 1.0, 0.25, 0.25, 1.0).finished();
  return named;
}

}  // namespace

class TestResultYaml : public QObject {
  Q_OBJECT

  QTemporaryDir scratch_;

  NamedResult readBack(const std::string& text) const {
    const std::filesystem::path path = std::filesystem::path(scratch_.path().toStdString()) / "result.yaml";
    std::ofstream(path) << text;
    return readResultYaml(path);
  }

 private slots:
  void result_writtenAndRead_isTheSameText() {
    const std::string text = resultYaml(sampleForResultYaml());
    QCOMPARE(resultYaml(readBack(text)), text);
  }

  // Frames and points have none: it is fixed at 0.
  void edgeLocalisationBias_isShownWhereItIsEstimated() {
    NamedResult named = sampleForResultYaml();
    const auto rows = [&named](const char* name) {
      return QString::fromStdString(resultTable(named)).count(name);
    };
    QCOMPARE(rows("edge localisation bias at low speed"), 2);
    QCOMPARE(rows("edge localisation bias"), 4);
    CalibrationResult& result = test::ownResult(named);
    result.state.cameras[1].edge_localisation_bias_px =
        result.state.cameras[1].slow_edge_localisation_bias_px = 0.0;
    result.uncertainty.cameras[1].edge_localisation_bias_std_px = 0.0;
    QCOMPARE(rows("edge localisation bias at low speed"), 1);
    QCOMPARE(rows("edge localisation bias"), 2);
  }

  void estimates_readBackToTheLastBit() {
    const NamedResult written = sampleForResultYaml(), read = readBack(resultYaml(written));
    QVERIFY(read.cameras == written.cameras && read.cameras[1].kind == CameraKind::Frames);
    QVERIFY(read.imus == written.imus);
    QVERIFY(read.imus[0].stream == "/left/imu" && read.imus[1].stream == "/far imu: odd");
    QVERIFY(read.imus[0].noise.gyroscope_density == 1.0 / 3000.0 &&
            (read.imus[1].noise == ImuNoise{0.0, 0.0, 0.0, 0.0}));
    QVERIFY(read.imus[0].noise.accelerometer_random_walk == 1e-4 && read.imus[0].rate_hz == 997.25);
    QVERIFY(read.result->status == CalibrationStatus::Doubtful);
    QVERIFY(read.result->start_ns == 1'700'000'000'123'456'789);
    for (std::size_t i = 0; i < 2; ++i) {
      const CameraState &a = written.result->state.cameras[i], &b = read.result->state.cameras[i];
      QVERIFY(a.reference_from_camera.rotation.coeffs() == b.reference_from_camera.rotation.coeffs());
      QVERIFY(a.reference_from_camera.translation_m == b.reference_from_camera.translation_m);
      QVERIFY(a.lens == b.lens);
      const auto& lens_std = written.result->uncertainty.cameras[i].intrinsics_std;
      QVERIFY(read.result->uncertainty.cameras[i].intrinsics_std == lens_std);
      QVERIFY(a.time_offset_s == b.time_offset_s &&
              a.edge_localisation_bias_px == b.edge_localisation_bias_px &&
              a.slow_edge_localisation_bias_px == b.slow_edge_localisation_bias_px);
      const ImuState &c = written.result->state.imus[i], &d = read.result->state.imus[i];
      QVERIFY(c.gyroscope_bias_rad_s == d.gyroscope_bias_rad_s &&
              c.gyroscope_scale_misalignment == d.gyroscope_scale_misalignment);
      QVERIFY(c.accelerometer_scale_misalignment == d.accelerometer_scale_misalignment);
      QVERIFY(c.gyroscope_from_accelerometer.coeffs() == d.gyroscope_from_accelerometer.coeffs());
      QVERIFY(c.accelerometer_delay_s == d.accelerometer_delay_s);
    }
    QVERIFY(std::isnan(read.result->uncertainty.cameras[0].edge_localisation_bias_std_px));
    QVERIFY(read.result->uncertainty.correlation(0, 1) == 0.25);
    QCOMPARE(read.result->cameras[0].windows_complete, 1320);
    QVERIFY(read.result->split_half_check.has_value());
    QCOMPARE(read.result->split_half_check->windows[1], 13);
    QCOMPARE(read.result->split_half_check->quantities.size(), std::size_t{2});
    QCOMPARE(read.result->split_half_check->quantities[0].normalised(), -0.5);
    QCOMPARE(read.result->split_half_check->quantities[1].name, std::string("1 odd: name.time_offset"));
  }

  void columns_sayWhoseNumberTheyAre_andWhich() {
    NamedResult named = sampleForResultYaml();
    UncertaintyReport& report = test::ownResult(named).uncertainty;
    report.columns = {{QuantityOwner::Camera, 1, QuantityId::Rotation, 1},
                      {QuantityOwner::Camera, 0, QuantityId::Intrinsics, 6, CameraModel::PinholeRadtan},
                      {QuantityOwner::Imu, 1, QuantityId::AccelerometerDelay},
                      {QuantityOwner::Board, 0, QuantityId::Scale},
                      {QuantityOwner::Rig, 0, QuantityId::Gravity, 1}};
    report.standard_deviations.setOnes(5);
    report.correlation.setIdentity(5, 5);
    const std::string text = resultYaml(named);
    for (const char* const line :
         {"camera: \"1 odd: name\", quantity: rotation, component: y, unit: rad}",
          "camera: left, quantity: intrinsics, component: distortion.p1, unit: \"1\"}",
          "imu: far_imu, quantity: accelerometer_delay, unit: s}",
          "board: board, quantity: scale, unit: \"1\"}",
          "{quantity: gravity, component: direction.2, unit: rad}"})
      QVERIFY2(text.find(line) != std::string::npos,
               qPrintable(QString(line) + " is not in\n" + text.c_str()));
    QVERIFY(readBack(text).result->uncertainty.columns == report.columns);
  }

  void causes_areListedWithWhatMendsThem() {
    const std::string text = resultYaml(sampleForResultYaml());
    const NamedResult read = readBack(text);
    const std::vector<QualityWarning>& causes = read.result->causes;
    QCOMPARE(causes.size(), std::size_t{2});
    QVERIFY(causes[0].name == "lens" && causes[0].explains == 0.875 && causes[0].repair->value == "free");
    QVERIFY(causes[1].name == "observability" && !causes[1].repair && causes[1].explains == 0.0);
    QVERIFY(text.find("\ncauses:\n  - name: lens\n    explains: 0.875\n    text: ") != std::string::npos);
    QVERIFY(text.find("    set: {optimisation.model.camera_intrinsics: free}\n") != std::string::npos);
  }

  void biasesCsv_hasALineForEveryKnot() {
    NamedResult named = sampleForResultYaml();
    QVERIFY(biasesCsv(named).empty());
    CalibrationResult& result = test::ownResult(named);
    ImuState& imu = result.state.imus[1];
    imu.bias_drift = {1.0, 2.0, {{0.1, 0.0, 0.0}, {-0.1, 0.0, 0.0}}, {{0.0, 0.0, 0.5}, {0.0, 0.0, -0.5}}};
    ImuUncertainty& sigma = result.uncertainty.imus[1];
    sigma.gyroscope_drift_std_rad_s = {{1e-3, 2e-3, 3e-3}, {4e-3, 5e-3, 6e-3}};
    sigma.accelerometer_drift_std_m_s2 = sigma.gyroscope_drift_std_rad_s;
    const QStringList lines = QString::fromStdString(biasesCsv(named)).trimmed().split('\n');
    QCOMPARE(lines.size(), 3);
    const QStringList names = lines[0].split(','), numbers = lines[2].split(',');
    QCOMPARE(numbers.size(), names.size());
    QCOMPARE(numbers[0], QString("\"far_imu\""));
    QCOMPARE(numbers[names.indexOf("time_s")].toDouble(), 3.0);
    QCOMPARE(numbers[names.indexOf("gyroscope_x_rad_s")].toDouble(), 0.01 - 0.1);
    QCOMPARE(numbers[names.indexOf("gyroscope_std_y_rad_s")].toDouble(), 5e-3);
    QCOMPARE(numbers[names.indexOf("accelerometer_z_m_s2")].toDouble(), -0.5);
  }

  void failedRun_isAResultToo() {
    NamedResult failed;
    test::ownResult(failed).status = CalibrationStatus::Failed;
    test::ownResult(failed).reason = "the board was never seen";
    const NamedResult read = readBack(resultYaml(failed));
    QVERIFY(read.result->status == CalibrationStatus::Failed);
    QCOMPARE(read.result->reason, failed.result->reason);
    QVERIFY(read.result->state.cameras.empty());
    QVERIFY(!read.result->start_ns);
  }

  // Reasons and notes may name paths, which may have any character.
  void reasonWithLineBreaks_readsBack() {
    NamedResult failed;
    test::ownResult(failed).reason = "/data/a\nb\x1b.bag: is gone";
    test::ownResult(failed).notes = {"a\rb"};
    const NamedResult read = readBack(resultYaml(failed));
    QCOMPARE(read.result->reason, std::string("/data/a\\x0ab\\x1b.bag: is gone"));
    QCOMPARE(read.result->notes.at(0), std::string("a\\x0db"));
  }

  void result_thatIsNone_isRefused_data() {
    QTest::addColumn<QString>("text");
    QTest::addColumn<QString>("said");
    QTest::newRow("session") << "evical_session: 1\n"
                             << "neither a result nor a truth";
    QTest::newRow("quaternion")
        << "evical_result: 1\ncameras: {a: {reference_from_camera: {rotation_xyzw: [0, 0, 0, "
           "0], translation_m: [0, 0, 0]}}}\n"
        << "not a unit quaternion";
    QTest::newRow("start") << "evical_result: 1\nrecording: {start_ns: 1.7e18}\n"
                           << "whole number";
    QTest::newRow("vector") << "evical_result: 1\ngravity_m_s2: [1, 2]\n"
                            << "3 are needed";
    QTest::newRow("later version") << "evical_result: 2\n"
                                   << "this program reads files of version 1";
    QTest::newRow("reason") << "evical_result: 1\nreason: \"a\\rb\"\n"
                            << "reason (line 2): the text has a control character: 'a\\x0db'";
    QTest::newRow("version") << "evical_result: 1\nprogram: {version: \"\\x1b[2J\"}\n"
                             << "'\\x1b[2J'";
    QTest::newRow("reference") << "evical_result: 1\nreference: \"\\u2028\"\n"
                               << "'\\u2028'";
    QTest::newRow("name") << "evical_result: 1\ncameras: {\"\\v\": {}}\n"
                          << "a key has a control character: '\\x0b'";
    QTest::newRow("stream")
        << "evical_result: 1\ncameras: {a: {stream: \"b\\u0085\", reference_from_camera: {rotation_xyzw: "
           "[0, 0, 0, 1], translation_m: [0, 0, 0]}}}\n"
        << "cameras.a.stream";
    for (const char* const column :
         {"quantity: width", "quantity: gravity, component: x", "camera: left, quantity: rotation"})
      QTest::newRow(column)
          << QString("evical_result: 1\nuncertainty: {columns: [{%1}], std: [1], correlation: [[1]]}\n")
                 .arg(column)
          << QString("%1 is not among the numbers of this result").arg(column);
  }
  void result_thatIsNone_isRefused() {
    QFETCH(QString, text);
    QFETCH(QString, said);
    try {
      readBack(text.toStdString());
      QFAIL("must throw");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains(said), error.what());
    }
  }

  void table_hasVerdictAndSigmas() {
    const QString table = QString::fromStdString(resultTable(sampleForResultYaml()));
    for (const char* part :
         {"Verdict: doubtful - planar motion", "33.333 +- 0.012", "Weakest: translation", "1500"})
      QVERIFY2(table.contains(part), qPrintable(table));
  }

  void comparison_withItself_hasNoErrors() {
    const TruthComparison comparison = compareWithTruth(sampleForResultYaml(), sampleForResultYaml());
    for (const QuantityDifference& q : comparison.quantities)
      QVERIFY2(std::abs(q.difference) < 1e-12, q.name.c_str());
  }

  void comparison_givesErrorsInReferenceAxesAndSigmas() {
    const NamedResult truth = sampleForResultYaml();
    NamedResult result = truth;
    CameraState& camera = test::ownResult(result).state.cameras[0];
    RigidTransform& pose = camera.reference_from_camera;
    pose.rotation = quaternionExp(Eigen::Vector3d(0.0, 3e-4, 0.0)) * pose.rotation;
    pose.translation_m.z() -= 4e-4;
    camera.time_offset_s += 6e-5;
    const TruthComparison comparison = compareWithTruth(result, truth);
    const auto normalised = [&](const std::string& name) {
      for (const QuantityDifference& q : comparison.quantities)
        if (q.name == name) return q.normalised();
      return std::numeric_limits<double>::quiet_NaN();
    };
    QVERIFY(std::abs(normalised("left.rotation.y") - 3.0) < 1e-6);
    QVERIFY(std::abs(normalised("left.rotation.x")) < 1e-6);
    QVERIFY(std::abs(normalised("left.translation.z") + 2.0) < 1e-6);
    QVERIFY(std::abs(normalised("left.time_offset") - 5.0) < 1e-6);
    QVERIFY(std::abs(comparison.cameras[0].translation_mm - 0.4) < 1e-9);
    QVERIFY(QString::fromStdString(comparisonTable(comparison)).contains("left.rotation.y [deg]"));
  }

  void trajectory_hasALineEvery5ms() {
    CalibrationState state;
    state.world_from_imu_rotation = makeUniformSo3Spline(1.0, 2.0, 0.02);
    state.imu_in_world_m = makeUniformVectorSpline(1.0, 2.0, 0.02, {1.0, 2.0, 3.0});
    const QStringList lines = QString::fromStdString(trajectoryCsv(state)).trimmed().split('\n');
    QCOMPARE(lines.size(), 202);
    QCOMPARE(
        lines[2],
        QString("1.005000,1.0000000,2.0000000,3.0000000,0.000000000,0.000000000,0.000000000,1.000000000"));
  }
};

EVICAL_TEST(TestResultYaml)
#include "tst_result_yaml.moc"
