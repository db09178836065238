// An old calibration against new recordings of an unchanged rig, and of one with a change.
#include "core/base/error.h"
#include "core/base/yaml_node.h"
#include "core/data/quantity.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/check/check_calibration.h"
#include "core/pipeline/check/check_files.h"
#include "core/pipeline/check/check_session.h"
#include "core/pipeline/runs/result_files.h"
#include "core/report/assessment_report.h"
#include "core/report/report_options.h"
#include "tests/support/seen_through.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <algorithm>
#include <functional>

using namespace evical;
using namespace evical::test;

namespace {

// Fast motion, so that a few seconds suffice.
Scenario briskForCheckCalibration(std::uint64_t seed) {
  Scenario scenario = simulatePass(2.0).truth;
  scenario.motion.image_speed_px_s = 150.0;
  scenario.seed = seed;
  return scenario;
}

const Finding* changedOneForCheckCalibration(const CalibrationCheck& check) {
  const auto found = std::find_if(check.findings.begin(), check.findings.end(),
                                  [](const Finding& each) { return each.changed; });
  return found == check.findings.end() ? nullptr : &*found;
}

}  // namespace

class TestCheckCalibration : public QObject {
  Q_OBJECT

  NamedResult before_;
  Session session_;

  // Changes of the camera since the calibration.
  CheckRun check(double duration_s, const std::function<void(SimulatedCamera&)>& change = {},
                 const std::function<void(DetectionResult&)>& spoil = {}, std::uint64_t seed = 11) const {
    Scenario scenario = briskForCheckCalibration(seed);
    if (change) change(scenario.cameras.front());
    SimulatedPass now = simulatePass(duration_s, scenario);
    const CheckInput input = checkInputOf(before_, session_);
    const CameraIntrinsics lens = *input.session.cameras.front().intrinsics;
    seeThrough(scenario.cameras.front().intrinsics, lens, now.detections.cameras.front());
    now.detections.lenses.front() = givenLens(lens);
    if (spoil) spoil(now.detections);
    return checkCalibration(input, std::move(now.detections), {});
  }
  void verifyRejected(const std::function<void(NamedResult&, Session&)>& change, const char* part) const {
    NamedResult before = before_;
    Session session = session_;
    change(before, session);
    try {
      checkInputOf(before, session);
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY2(std::string(error.what()).find(part) != std::string::npos, error.what());
      return;
    }
    QFAIL("it was accepted");
  }

 private slots:
  void initTestCase() {
    SimulatedPass first = simulatePass(20.0, briskForCheckCalibration(3));
    session_ = first.session;
    session_.options.report.edit().split_half_check = false;
    const CalibrationRun run = calibrate(session_, first.detections, {});
    QVERIFY(run.result.status == CalibrationStatus::Ok);
    before_ = namedResult(session_, std::make_shared<const CalibrationResult>(run.result), "test");
  }

  void unchangedRig_isStillGood() {
    const CheckRun checked = check(10.0);
    QVERIFY2(checked.check.verdict == Verdict::Unchanged, checked.check.reason.c_str());
    QVERIFY(checked.check.findings.size() >= 4);
    for (const Finding& quantity : checked.check.findings) {
      QVERIFY(quantity.smallest_detectable_change > quantity.allowed_drift && quantity.change_sigma > 0.0);
      // Both together are more certain than either alone.
      for (const ComparedNumber& number : quantity.numbers)
        if (quantity.quantity == "translation") QVERIFY(number.joint.sigma < number.now.sigma);
    }
  }

  // Its lens was estimated separately (same_sensor_check), but the session has it once.
  void secondCameraOfASensor_hasNoPriorOfItsOwn() {
    NamedResult before = before_;
    before.cameras.push_back(before.cameras.front());
    before.cameras.back().name = "second";
    CalibrationResult result = *before.result;
    result.state.cameras.push_back(result.state.cameras.front());
    UncertaintyReport& report = result.uncertainty;
    report.cameras.push_back(report.cameras.front());
    report.columns.clear();
    for (const std::size_t camera : {0, 1})
      for (std::size_t k = 0; k < 4; ++k)
        report.columns.push_back({QuantityOwner::Camera, camera, QuantityId::Intrinsics, k});
    report.standard_deviations = Eigen::VectorXd::Constant(8, 0.1);
    report.correlation = Eigen::MatrixXd::Identity(8, 8);
    before.result = std::make_shared<const CalibrationResult>(std::move(result));
    Session session = session_;
    session.cameras.push_back(session.cameras.front());
    session.cameras.back().name = "second";
    session.cameras.back().same_sensor_as = session.cameras.front().name;
    session.cameras.back().intrinsics.reset();
    const Session weighed = withPriorOf(before, session);
    QVERIFY(weighed.cameras[0].intrinsics_uncertainty && weighed.cameras[0].prior.rotation);
    QVERIFY(!weighed.cameras[1].intrinsics_uncertainty && !weighed.cameras[1].prior.rotation);
  }

  void changedQuantity_isNamedWithItsSize_data() {
    QTest::addColumn<QString>("quantity");
    QTest::addColumn<double>("size");
    QTest::newRow("turned") << "rotation" << 0.5;
    QTest::newRow("shifted") << "translation" << 15.0;
    QTest::newRow("late") << "time_offset" << 1.5;
    QTest::newRow("other lens") << "intrinsics" << 3.0;
  }
  void changedQuantity_isNamedWithItsSize() {
    QFETCH(QString, quantity);
    QFETCH(double, size);
    const CheckRun checked = check(8.0, [&](SimulatedCamera& camera) {
      RigidTransform& pose = camera.imu_from_camera;
      if (quantity == "rotation")
        pose.rotation =
            Eigen::Quaterniond(so3Exp(Eigen::Vector3d(0.0, kRadPerDeg * size, 0.0))) * pose.rotation;
      if (quantity == "translation") pose.translation_m += 1e-3 * size * Eigen::Vector3d(0.6, 0.8, 0.0);
      if (quantity == "time_offset") camera.time_offset_s += 1e-3 * size;
      // 3 px at 125 px from the middle, the RMS distance.
      if (quantity == "intrinsics") camera.intrinsics.focal_length_px *= 1.0 + size / 125.0;
    });
    QVERIFY2(checked.check.verdict == Verdict::Changed, checked.check.reason.c_str());
    const Finding* const changed = changedOneForCheckCalibration(checked.check);
    QVERIFY(changed != nullptr);
    QCOMPARE(QString::fromStdString(changed->quantity), quantity);
    QVERIFY2(std::abs(changed->change - size) < 0.3 * size, qPrintable(QString::number(changed->change)));
    QVERIFY(checked.check.reason.find(changed->title) != std::string::npos);
    if (quantity == "rotation") {
      // The focal length is 262 px; at the image border a rotation has a larger effect.
      const double in_middle_px = 262.0 * kRadPerDeg * changed->change;
      QVERIFY(changed->edge_px > in_middle_px && changed->edge_px < 3.0 * in_middle_px);
    }
  }

  void poorRecording_cannotTell() {
    const CheckRun tooShort = check(2.5);
    QVERIFY(tooShort.check.verdict == Verdict::CannotTell);
    QVERIFY2(tooShort.check.reason.find("too short") != std::string::npos, tooShort.check.reason.c_str());
    QVERIFY(!tooShort.check.advice.empty() && !tooShort.run);
    const CheckRun short_one = check(3.2);
    QVERIFY2(short_one.check.verdict == Verdict::CannotTell, short_one.check.reason.c_str());
    QVERIFY(!short_one.check.advice.empty());
    const CheckRun unseen = check(6.0, {}, [](DetectionResult& detections) {
      for (BoardView& view : detections.cameras.front().views) view.circles.clear();
      detections.cameras.front().views.clear();
    });
    QVERIFY2(unseen.check.verdict == Verdict::CannotTell, unseen.check.reason.c_str());
  }

  // The camera's clock steps within the recording: its time offset changes, but not the rig.
  void spoiltRecording_isNoChange() {
    const CheckRun checked = check(8.0, {}, [](DetectionResult& detections) {
      for (BoardView& view : detections.cameras.front().views) {
        if (view.time_s < 4.0) continue;
        view.time_s += 0.02;
        for (CircleObservation& circle : view.circles) circle.time_s += 0.02;
      }
    });
    QVERIFY2(checked.check.verdict == Verdict::CannotTell, checked.check.reason.c_str());
    QVERIFY(checked.check.reason.find("is not reliable") != std::string::npos);
  }

  void otherRig_isBadInput() {
    verifyRejected([](NamedResult&, Session& session) { session.cameras.front().name = "right"; }, "'right'");
    verifyRejected([](NamedResult&, Session& session) { session.reference = "right"; }, "reference");
    verifyRejected([](NamedResult& before, Session&) { before.imus.clear(); }, "left_imu");
    verifyRejected(
        [](NamedResult&, Session& session) {
          session.cameras.front().resolution_px = {640, 480};
        },
        "640 x 480");
  }

  void lensOfAnotherKind_isTakenFromTheResult() {
    Session session = session_;
    session.cameras.front().intrinsics->model = CameraModel::PinholeEquidistant;
    const CheckInput input = checkInputOf(before_, session);
    QVERIFY(input.session.cameras.front().intrinsics->model == CameraModel::PinholeRadtan);
    QVERIFY(!input.notes.empty());
  }

  void doubtfulResult_isSaid() {
    CalibrationResult doubtful = *before_.result;
    doubtful.status = CalibrationStatus::Doubtful;
    doubtful.reason = "the sun was in its eyes";
    NamedResult before = before_;
    before.result = std::make_shared<const CalibrationResult>(doubtful);
    const CheckInput input = checkInputOf(before, session_);
    QVERIFY(input.notes.back().find("the sun was in its eyes") != std::string::npos);
  }

  // Earlier results had no covariances.
  void resultWithoutCovariance_isTaken() {
    CalibrationResult older = *before_.result;
    older.uncertainty.columns.clear();
    older.uncertainty.standard_deviations.resize(0);
    older.uncertainty.correlation.resize(0, 0);
    const NamedResult kept = before_;
    before_.result = std::make_shared<const CalibrationResult>(older);
    const CheckRun checked = check(8.0);
    before_ = kept;
    QVERIFY2(checked.check.verdict != Verdict::Changed, checked.check.reason.c_str());
    QVERIFY(checked.check.findings.front().numbers.front().before.sigma > 0.0);
  }

  // Cameras of one chip whose lenses were estimated separately, to compare them: the old result has two
  // lenses.
  void cameraThatSharesItsSensor_hasNoPriorOfItsOwn() {
    SimulatedPass first = simulatePass(10.0, "davis346_frames");
    first.session.options.report.edit().split_half_check = false;
    first.session.options.optimisation.edit().share_sensors = false;
    first.session.options.optimisation.edit().camera_intrinsics = CameraIntrinsicsChoice::Free;
    const CalibrationRun run = calibrate(first.session, first.detections, {});
    QVERIFY(intrinsicsCovariance(run.result.uncertainty, 0).rows() > 0);
    QVERIFY(intrinsicsCovariance(run.result.uncertainty, 1).rows() > 0);
    const NamedResult before =
        namedResult(first.session, std::make_shared<const CalibrationResult>(run.result), "test");
    const Session weighed = withPriorOf(before, checkInputOf(before, first.session).session);
    QVERIFY(weighed.cameras[0].intrinsics_uncertainty.has_value());
    QVERIFY(!weighed.cameras[1].intrinsics_uncertainty.has_value());
    QVERIFY(!weighed.cameras[1].prior.rotation && !weighed.cameras[1].prior.translation);
    const CheckRun checked = checkCalibration(checkInputOf(before, first.session), first.detections, {});
    QVERIFY2(checked.check.verdict != Verdict::Changed, checked.check.reason.c_str());
  }

  void cancelled_isNoVerdict() {
    std::stop_source source;
    source.request_stop();
    SimulatedPass now = simulatePass(5.0, briskForCheckCalibration(5));
    const RunContext context{silentProgress(), source.get_token()};
    const CheckInput input = checkInputOf(before_, session_);
    try {
      checkCalibration(input, now.detections, context);
    } catch (const Cancelled&) {
      return;
    }
    QFAIL("it continued");
  }

  void files_sayTheSame() {
    const CheckRun checked = check(8.0);
    QTemporaryDir folder;
    const std::filesystem::path path = folder.filePath("check").toStdString();
    writeCheckFiles(path, checkInputOf(before_, session_), checked, "test", "log");
    const YamlNode yaml = YamlNode::load(path / "check.yaml");
    QCOMPARE(yaml["evical_check"].integer(1, 1), 1);
    QCOMPARE(yaml["verdict"].text(), std::string(verdictName(checked.check.verdict)));
    QCOMPARE(yaml["findings"].items().size(), checked.check.findings.size());
    QFile report(QString::fromStdString((path / "report.html").string()));
    QVERIFY(report.open(QIODevice::ReadOnly));
    const QString page = QString::fromUtf8(report.readAll());
    QVERIFY(page.contains("Is the old calibration still good?"));
    QVERIFY(page.contains("lens of left"));
  }
};

EVICAL_TEST(TestCheckCalibration)
#include "tst_check_calibration.moc"
