// A camera whose intrinsics are found first and then estimated jointly with everything else: results, files
// and halves.
#include "core/geometry/projection_difference.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/rig/calibrated_lenses.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/report/report_options.h"
#include "core/report/truth_comparison.h"
#include "tests/support/own_result.h"
#include "tests/support/seen_through.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <QFile>
#include <QTemporaryDir>

#include <algorithm>
#include <filesystem>

using namespace evical;
using namespace evical::test;

class TestJointIntrinsics : public QObject {
  Q_OBJECT

  static constexpr const char* kDoubt = "pixels of rays are known to 3.00 px RMS only";
  SimulatedPass simulated_;
  CameraIntrinsics truth_, found_;
  CalibrationRun run_;

  // The state after the first stages of a run.
  IntrinsicsResult foundFirst() const {
    IntrinsicsResult first;
    first.intrinsics = found_;
    first.covariance.diagonal().head<8>().setConstant(0.0025);
    first.image.columns = 16;
    first.image.rows = 12;
    first.image.cells.resize(16 * 12);
    for (ImageCell& cell : first.image.cells) cell.circles = 1;
    first.image.rms_px = 3.0;
    first.circles_used = 1000;
    first.status = CalibrationStatus::Doubtful;
    first.reason = kDoubt;
    return first;
  }
  NamedResult named(const CalibrationRun& run) const {
    return namedResult(simulated_.session, std::make_shared<const CalibrationResult>(run.result), "test");
  }
  static bool holds(const std::vector<std::string>& texts, const std::string& part) {
    return std::any_of(texts.begin(), texts.end(),
                       [&](const std::string& text) { return text.find(part) != std::string::npos; });
  }
  static QString readFile(const QString& path) {
    QFile file(path);
    return file.open(QIODevice::ReadOnly) ? QString::fromUtf8(file.readAll()) : QString();
  }

 private slots:
  void initTestCase() {
    simulated_ = simulatePass(8.0, "intrinsics_davis346");
    truth_ = found_ = *simulated_.session.cameras[0].intrinsics;
    found_.focal_length_px += Eigen::Vector2d(0.4, -0.3);
    found_.principal_point_px += Eigen::Vector2d(-0.5, 0.6);
    found_.distortion[0] += 4e-3;
    seeThrough(truth_, found_, simulated_.detections.cameras[0]);
    simulated_.session.cameras[0].intrinsics.reset();
    simulated_.detections.lenses = {{std::nullopt, found_}};
    run_ = calibrate(simulated_.session, simulated_.detections, {}, {foundFirst()});
  }

  void run_solvesForThem_andKeepsWhatWasFoundFirst() {
    const CameraIntrinsics solved = run_.result.state.cameras[0].lens.solved.value();
    QVERIFY(run_.intrinsics[0]->intrinsics == found_);
    QCOMPARE(QString::fromStdString(run_.intrinsics[0]->reason), QString(kDoubt));
    // But the quantity that was doubtful then is determined well now.
    QVERIFY2(run_.result.reason.find("intrinsics") == std::string::npos, run_.result.reason.c_str());
    QVERIFY(!holds(run_.result.notes, "projection sigma 3.000 px"));
    QVERIFY(run_.result.state.cameras[0].lens == (CameraLens{std::nullopt, found_, solved}));
    const double before_px = projectionDifference(truth_, found_).rms_px;
    const double after_px = projectionDifference(truth_, solved).rms_px;
    QVERIFY2(after_px < 0.02 && after_px < 0.2 * before_px, qPrintable(QString::number(after_px)));
    QVERIFY(holds(run_.result.notes, "refined in the joint optimisation, which changed the projection by"));
    QVERIFY(columnOf({QuantityOwner::Camera, 0, QuantityId::Intrinsics, 0, solved.model},
                     run_.result.uncertainty.columns));
  }

  void errors_areThoseThatTheSigmasSay() {
    NamedResult truth;
    truth.reference = simulated_.session.reference;
    truth.cameras = {{"left"}};
    truth.imus = {{simulated_.session.imus[0].name}};
    const SimulatedCamera& camera = simulated_.truth.cameras[0];
    CalibrationState& state = ownResult(truth).state;
    state.cameras = {{camera.imu_from_camera, camera.time_offset_s - camera.pixel.delay_s()}};
    state.cameras[0].lens = givenLens(truth_);
    state.imus.resize(1);
    const TruthComparison comparison = compareWithTruth(named(run_), truth);
    int compared = 0;
    for (const QuantityDifference& each : comparison.quantities) {
      if (each.name.rfind("left.", 0) != 0) continue;
      QVERIFY2(std::abs(each.normalised()) < 4.0,
               qPrintable(QString("%1: %2").arg(QString::fromStdString(each.name)).arg(each.normalised())));
      compared += each.sigma > 0.0;
    }
    QCOMPARE(compared, 7 + 1 + 8);  // extrinsics, drift, lens
  }

  void movedPrincipalPoint_isComparedWithARotation() {
    CameraIntrinsics moved = truth_;
    moved.principal_point_px.x() += 0.02 * truth_.focal_length_px.x();
    const std::string advice = adviceOnMovedLens(truth_, moved, 0.3);
    QVERIFY2(advice.find("turns the camera by 1.15 deg") != std::string::npos, advice.c_str());
    moved.principal_point_px.x() = truth_.principal_point_px.x() + 0.002 * truth_.focal_length_px.x();
    QVERIFY(adviceOnMovedLens(truth_, moved, 0.3).empty());
  }

  void halves_solveForThemToo() {
    const SplitHalfCheck& validation = run_.result.split_half_check.value();
    QVERIFY2(validation.failure.empty(), validation.failure.c_str());
    const auto difference =
        std::find_if(validation.quantities.begin(), validation.quantities.end(),
                     [](const QuantityDifference& each) { return each.name == "left.focal_length.x"; });
    QVERIFY(difference != validation.quantities.end());
    QVERIFY(difference->sigma > 0.0 && difference->difference != 0.0);
  }

  void files_holdThemAsSolved() {
    const CameraIntrinsics solved = run_.result.state.cameras[0].lens.solved.value();
    QTemporaryDir folder;
    writeResultFiles(folder.path().toStdString(), simulated_.session,
                     std::make_shared<const CalibrationRun>(run_), "test", "log");
    const NamedResult read = readResultYaml(folder.filePath("result.yaml").toStdString());
    QVERIFY(read.result->state.cameras[0].lens.inUse() == solved);
    QVERIFY(read.result->uncertainty.cameras[0].intrinsics_std.has_value());
    const QString page = readFile(folder.filePath("report.html"));
    QVERIFY(page.contains("Intrinsics refined in the joint optimisation"));
    QVERIFY(page.contains("calibrated first") && page.contains("left.focal_length.x"));
    const QString focal = QString::number(solved.focal_length_px.x(), 'f', 6).left(9);
    int holding = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(folder.path().toStdString() + "/kalibr"))
      holding += readFile(QString::fromStdString(entry.path().string())).contains(focal);
    QVERIFY2(holding > 0, qPrintable(focal));
  }

  void fixed_keepsWhatWasFoundFirst() {
    Session session = simulated_.session;
    session.options.optimisation.edit().camera_intrinsics = CameraIntrinsicsChoice::Fixed;
    session.options.report.edit().split_half_check = false;
    const CalibrationRun run = calibrate(session, simulated_.detections, {}, {foundFirst()});
    QVERIFY(!run.result.state.cameras[0].lens.solved);
    QVERIFY(run.result.reason.find(kDoubt) != std::string::npos);
    QVERIFY(run.result.state.cameras[0].lens.found() == found_);
    QVERIFY(run.result.state.cameras[0].lens.inUse() == found_);
    QVERIFY(std::abs((*run.result.uncertainty.cameras[0].intrinsics_std)[0] - 0.05) < 1e-12);
    QVERIFY(!holds(run.result.notes, "refined in the joint optimisation"));
  }

  void givenIntrinsics_stayAsTheyAreWhereAsked() {
    Session session = simulated_.session;
    session.options.optimisation.edit().camera_intrinsics = CameraIntrinsicsChoice::Fixed;
    session.options.report.edit().split_half_check = false;
    session.cameras[0].intrinsics = found_;
    DetectionResult detections = simulated_.detections;
    detections.lenses = givenLenses(session);
    const CalibrationRun run = calibrate(session, detections, {});
    QVERIFY(run.result.state.cameras[0].lens.given == found_);
    QVERIFY(!run.result.state.cameras[0].lens.solved && !run.result.state.cameras[0].lens.found());
    QVERIFY(!run.result.uncertainty.cameras[0].intrinsics_std);
  }
};

EVICAL_TEST(TestJointIntrinsics)
#include "tst_joint_intrinsics.moc"
