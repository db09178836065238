// Refusals of exporters, and their notes on results without some of the values that a program requires.
#include "core/base/error.h"
#include "tests/core/export/exported_rig.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <QRegularExpression>

#include <algorithm>
#include <limits>

using namespace evical;
using namespace evical::test;

class TestExportRefusals : public QObject {
  Q_OBJECT

  static RigKind fisheye() {
    RigKind kind;
    kind.fisheye = true;
    return kind;
  }

 private slots:
  void withoutNoise_notesSaySo() {
    NamedResult result = rig({});
    for (SensorDescription& imu : result.imus) imu = {imu.name};
    const QString notes = QString::fromStdString(exportTo(result, "ultimate-slam").notes.back());
    QVERIFY(notes.contains("rate"));
  }

  // Within three sigmas a drift is attributed to chance, and no note is written.
  void driftingClock_isSaid_data() {
    QTest::addColumn<QString>("target");
    for (const ExportTarget& target : exportTargets()) QTest::newRow(target.name) << target.name;
  }
  void driftingClock_isSaid() {
    QFETCH(QString, target);
    NamedResult result = rig({});
    CalibrationResult& own = test::ownResult(result);
    own.uncertainty.cameras.resize(own.state.cameras.size());
    own.state.cameras[0].time_offset_drift_ppm = 41.5;
    own.state.cameras[0].time_offset_at_s = 12.25;
    own.uncertainty.cameras[0].time_offset_drift_std_ppm = 10.0;
    const ExportedFiles exported = exportTo(result, target.toStdString());
    const QString note = QString::fromStdString(exported.notes.back());
    QVERIFY2(note.contains("left: its clock drifts by 41.5 ppm") && note.contains("12.25 s"),
             qPrintable(note));
    const bool in_a_file = std::any_of(
        exported.files.begin(), exported.files.end(),
        [](const FileContent& file) { return file.content.find("drifts by 41.5 ppm") != std::string::npos; });
    QVERIFY(in_a_file);

    own.uncertainty.cameras[0].time_offset_drift_std_ppm = 20.0;
    for (const std::string& each : exportTo(result, target.toStdString()).notes)
      QVERIFY(each.find("drifts") == std::string::npos);
  }

  // For lenses that see beyond a program's range, no error in pixels is stated.
  void lensThatSeesTooFar_isRefusedInWords() {
    NamedResult result = rig(fisheye());
    for (CameraState& camera : test::ownResult(result).state.cameras) {
      CameraIntrinsics lens = *camera.lens.inUse();
      lens.focal_length_px *= 0.4;  // 240 degrees across the image
      camera.lens = givenLens(lens);
    }
    for (const char* const target : {"dsec", "m3ed"}) try {
        exportTo(result, target);
        QFAIL("it was exported");
      } catch (const CalibrationError& error) {
        QVERIFY2(!QString(error.what()).contains("inf "), error.what());
      }
  }

  void equidistantLens_isNoInputOfEkalibr() {
    QVERIFY(hasNote(exportTo(rig(fisheye()), "ekalibr"), "does not accept them as input"));
    QVERIFY(!hasNote(exportTo(rig({}), "ekalibr"), "does not accept them as input"));
  }

  void rollingShutter_isSaid() {
    NamedResult result = rig({});
    CalibrationResult& own = test::ownResult(result);
    own.state.cameras[0].line_delay_us = 29.5;
    own.uncertainty.cameras.resize(own.state.cameras.size());
    own.uncertainty.cameras[0].line_delay_std_us = 0.1;
    const ExportedFiles exported = exportTo(result, "kalibr");
    const QString note = QString::fromStdString(exported.notes.back());
    QVERIFY2(note.contains("left: rolling shutter, 29.5 us from row to row"), qPrintable(note));
    QVERIFY(exported.files.front().content.find("29.5 us from row to row") != std::string::npos);
    const std::string svo = exportTo(result, "svo").files.front().content;
    QVERIFY(svo.find("line-delay-nanoseconds: 29500") != std::string::npos);
  }

  void lateAccelerometer_isSaid() {
    NamedResult result = rig({});
    CalibrationResult& own = test::ownResult(result);
    own.state.imus[1].accelerometer_delay_s = 3.25e-3;
    own.uncertainty.imus.resize(2);
    own.uncertainty.imus[1].accelerometer_delay_std_s = 1e-4;
    const ExportedFiles exported = exportTo(result, "kalibr");
    const QString note = QString::fromStdString(exported.notes.back());
    QVERIFY2(note.contains("far_imu: the accelerometer's samples are 3.25 ms later"), qPrintable(note));
    QVERIFY(exported.files.front().content.find("3.25 ms later") != std::string::npos);
    own.uncertainty.imus[1].accelerometer_delay_std_s = 2e-3;
    for (const std::string& each : exportTo(result, "kalibr").notes)
      QVERIFY(each.find("later") == std::string::npos);
  }

  void camerasOnly_isRefusedWhereAnImuIsNeeded_data() {
    QTest::addColumn<QString>("target");
    for (const char* target :
         {"openvins", "vins-fusion", "basalt", "svo", "ultimate-slam", "esvo2", "kimera", "tum-vie"})
      QTest::newRow(target) << target;
  }
  void camerasOnly_isRefusedWhereAnImuIsNeeded() {
    QFETCH(QString, target);
    RigKind kind;
    kind.inertial = false;
    try {
      exportTo(rig(kind), target.toStdString());
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY2(error.problem().find("has no IMU") != std::string::npos, error.what());
    }
    const ExportedFiles chain = exportTo(rig(kind), "kalibr");
    QCOMPARE(chain.files.size(), 1U);  // camchain.yaml
    QVERIFY(QString::fromStdString(chain.notes.back())
                .contains("add to the stamps of left 0.007301 s, right -0.0021 s"));
  }

  void whatOneTargetRefuses_theOthersGet() {
    RigKind kind;
    kind.inertial = false;
    const ExportedFiles exported =
        exportResult(rig(kind), std::vector<std::string>{"openvins", "kalibr", "openvins"});
    QCOMPARE(exported.files.size(), 1U);
    QCOMPARE(exported.refused.size(), 1U);
    QVERIFY(exported.refused[0].starts_with("openvins: not exported: ") &&
            exported.refused[0].find("has no IMU") != std::string::npos);
  }

  // An explicit request fails if it writes no file; files written next to a result only cause a note.
  void whereNobodyTakesIt_eachRefusalNamesItsTarget() {
    NamedResult broken = rig({});
    test::ownResult(broken).state.cameras[0].time_offset_s = std::numeric_limits<double>::quiet_NaN();
    const std::vector<std::string> targets{"kalibr", "ros"};
    QVERIFY_THROWS_EXCEPTION(CalibrationError, exportResult(broken, targets));
    const ExportedFiles exported = exportWhatCanBe(broken, targets);
    QVERIFY(exported.files.empty() && exported.targets.empty());
    QCOMPARE(exported.refused.size(), 2U);
    QVERIFY(exported.refused[0].starts_with("kalibr: not exported: "));
    QVERIFY(exported.refused[1].starts_with("ros: not exported: "));
  }

  // No file has a number that is not finite: other programs read it as text, as 0, or not at all.
  void numbersThatAreNotFinite_areNotWritten_data() {
    QTest::addColumn<QString>("target");
    QTest::addColumn<int>("number");
    for (const ExportTarget& target : exportTargets())
      for (int number = 0; number < 4; ++number)
        QTest::addRow("%s, number %d", target.name, number) << target.name << number;
  }
  void numbersThatAreNotFinite_areNotWritten() {
    QFETCH(const QString, target);
    QFETCH(const int, number);
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(),
                     kInfinity = std::numeric_limits<double>::infinity();
    NamedResult result = rig({});
    CalibrationResult& own = test::ownResult(result);
    own.cameras.resize(own.state.cameras.size());
    if (number == 0) result.imus[0].noise.gyroscope_density = kNaN;
    if (number == 1) result.imus[0].rate_hz = kInfinity;
    if (number == 2) own.cameras[0].reprojection_rms_px = kNaN;
    if (number == 3) own.state.cameras[0].time_offset_at_s = -kInfinity;
    ExportedFiles exported;
    try {
      exported = exportTo(result, target.toStdString());
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains("not finite"), error.what());
      return;
    }
    static const QRegularExpression kNumber(R"((?<![\w/])[-.]?(nan|inf)(\.0)?\b)",
                                            QRegularExpression::CaseInsensitiveOption);
    for (const FileContent& file : exported.files) {
      if (file.path.extension() == ".npy" || file.path.extension() == ".h5") continue;
      const QString text = QString::fromStdString(file.content);
      QVERIFY2(!kNumber.match(text).hasMatch(), qPrintable(kNumber.match(text).captured()));
    }
  }

  void everyTarget_saysWhoReadsIt() {
    for (const ExportTarget& target : exportTargets())
      QVERIFY2(std::string(target.use).size() > 10 && target.use != std::string(target.files), target.name);
    QVERIFY(exportTarget("openvins", "").inertial_odometry && !exportTarget("numpy", "").inertial_odometry);
  }

  void badRequests_areRefused() {
    NamedResult failed = rig({});
    test::ownResult(failed).status = CalibrationStatus::Failed;
    test::ownResult(failed).reason = "the board was never seen";
    const auto reason = [](const NamedResult& result, const std::string& target) {
      try {
        exportTo(result, target);
        return std::string("taken");
      } catch (const CalibrationError& error) {
        return std::string(error.what());
      }
    };
    QVERIFY(reason(failed, "kalibr").find("the board was never seen") != std::string::npos);
    QVERIFY(reason(rig({}), "opnvins").find("Did you mean 'openvins'?") != std::string::npos);
    NamedResult unset = rig({});
    test::ownResult(unset).state.cameras[1].time_offset_s = std::numeric_limits<double>::quiet_NaN();
    QVERIFY(reason(unset, "kalibr").find("cameras.right: has values that are not finite") !=
            std::string::npos);
    unset = rig({});
    test::ownResult(unset).state.imus[1].accelerometer_scale_misalignment(0, 2) =
        std::numeric_limits<double>::infinity();
    QVERIFY(reason(unset, "ros").find("imus.") != std::string::npos);
    NamedResult bare = rig({});
    test::ownResult(bare).state.cameras[1].lens = {};
    QVERIFY(reason(bare, "ros").find("cameras.right") != std::string::npos);
  }
};

EVICAL_TEST(TestExportRefusals)
#include "tst_export_refusals.moc"
