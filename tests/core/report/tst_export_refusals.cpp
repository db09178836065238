// What exporters refuse, and what they say of results that do not hold all that a program asks for.
#include "core/base/error.h"
#include "tests/core/report/exported_rig.h"
#include "tests/support/own_result.h"
#include "tests/support/test_program.h"

#include <limits>

using namespace evical;
using namespace evical::test;

namespace {

ExportedFiles exportTo(const NamedResult& result, const std::string& target) {
  return exportResult(result, std::vector<std::string>{target});
}

}  // namespace

class TestExportRefusals : public QObject {
  Q_OBJECT

 private slots:
  void withoutNoise_notesSaySo() {
    NamedResult result = rig({});
    for (SensorDescription& imu : result.imus) imu = {imu.name};
    const QString notes = QString::fromStdString(exportTo(result, "ultimate-slam").notes.back());
    QVERIFY(notes.contains("rate"));
  }

  void camerasOnly_isRefusedWhereAnImuIsNeeded_data() {
    QTest::addColumn<QString>("target");
    for (const char* target : {"openvins", "vins-fusion", "basalt", "svo", "ultimate-slam", "esvo2"})
      QTest::newRow(target) << target;
  }
  void camerasOnly_isRefusedWhereAnImuIsNeeded() {
    QFETCH(QString, target);
    RigKind kind;
    kind.inertial = false;
    try {
      exportTo(rig(kind), target.toStdString());
      QFAIL("taken");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY2(error.problem().find("has no IMU") != std::string::npos, error.what());
    }
    const ExportedFiles chain = exportTo(rig(kind), "kalibr");
    QCOMPARE(chain.files.size(), 1U);  // camchain.yaml
    QVERIFY(QString::fromStdString(chain.notes.back())
                .contains("add to the stamps of left 0.007301 s, right -0.0021 s"));
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
    QVERIFY(reason(unset, "kalibr").find("cameras.right: has numbers that are none") != std::string::npos);
    unset = rig({});
    test::ownResult(unset).state.imus[1].accelerometer_mapping(0, 2) =
        std::numeric_limits<double>::infinity();
    QVERIFY(reason(unset, "ros").find("imus.") != std::string::npos);
    NamedResult bare = rig({});
    test::ownResult(bare).state.cameras[1].lens = {};
    QVERIFY(reason(bare, "ros").find("cameras.right") != std::string::npos);
  }
};

EVICAL_TEST(TestExportRefusals)
#include "tst_export_refusals.moc"
