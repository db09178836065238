// `evical intrinsics`, and `evical calibrate` on a session without intrinsics, on a recording with a truth.
#include "core/base/yaml_node.h"
#include "core/format/intrinsics_yaml.h"
#include "core/geometry/projection_difference.h"
#include "tests/support/test_program.h"
#include "tests/system/program.h"

#include <QRegularExpression>
#include <QTemporaryDir>

#include <cmath>

using namespace evical;
using namespace evical::test;

class TestIntrinsicsCommand : public QObject {
  Q_OBJECT

 private slots:
  void init() {
    folder_ = std::make_unique<QTemporaryDir>();
    QFile::link(simulated("intrinsics") + "/recording.bag", folder_->filePath("recording.bag"));
    session_ = QString::fromUtf8(readFile(simulated("intrinsics") + "/session.yaml"));
  }

  void files_holdTheCamera() {
    const Outcome outcome = run("intrinsics");
    VERIFY_OUTCOME(outcome, 0);
    QCOMPARE(filesIn(result()), (QStringList{"camchain.yaml", "camera_info.yaml", "detections.csv",
                                             "intrinsics.yaml", "log.txt", "projection_std.csv"}));
    const CameraIntrinsics truth = trueIntrinsics();
    for (const char* file : {"intrinsics.yaml", "camera_info.yaml", "camchain.yaml"}) {
      const CameraIntrinsics found =
          readIntrinsicsFile((result() + "/" + file).toStdString(), "left", "/davis_left/events");
      QVERIFY(found.model == truth.model);
      QVERIFY(projectionDifference(truth, found).rms_px < 0.1);
    }
    QVERIFY2(outcome.output.contains(QRegularExpression("focal length x +26[0-9.]+ \\+- 0\\.")),
             qPrintable(outcome.output));
  }

  void model_isAChoice() {
    Outcome outcome = run("intrinsics", {"--set", "intrinsics.model=pinhole_equidistant"});
    VERIFY_OUTCOME(outcome, 0);
    QVERIFY(readFile(result() + "/intrinsics.yaml").contains("model: pinhole_equidistant"));
    QVERIFY(readFile(result() + "/camchain.yaml").contains("distortion_model: equidistant"));
    outcome = run("intrinsics",
                  {"--set", "intrinsics.model=pinhole_radtan", "--set", "intrinsics.radtan_coefficients=5"});
    VERIFY_OUTCOME(outcome, 0);
    const YamlNode file = YamlNode::load((result() + "/intrinsics.yaml").toStdString());
    QCOMPARE(file["intrinsics"]["distortion"].reals(5).size(), std::size_t{5});
    QCOMPARE(file["intrinsics_std"]["distortion"].reals(5).size(), std::size_t{5});
    QCOMPARE(file["correlation"].items().size(), std::size_t{9});
  }

  void calibrate_beginsWithTheIntrinsics() {
    const Outcome outcome = run("calibrate");
    VERIFY_OUTCOME(outcome, 0);
    const YamlNode camera = YamlNode::load((result() + "/result.yaml").toStdString())["cameras"]["left"];
    const CameraIntrinsics found = readIntrinsics(camera["intrinsics"]);
    QVERIFY(projectionDifference(trueIntrinsics(), found).rms_px < 0.1);
    QVERIFY(camera["intrinsics_std"]["focal_length_px"].reals(2)[0] > 0.0);
    const double off_s = camera["time_offset_s"].real() - 0.0068;
    QVERIFY2(std::abs(off_s) < 1e-3, qPrintable(QString::number(off_s)));
  }

  void shortRecording_saysWhereViewsAreMissing() {
    session_ += "time_range_s: [0, 0.5]\n";
    const Outcome outcome = run("intrinsics");
    VERIFY_OUTCOME(outcome, 1);
    VERIFY_SAYS(outcome,
                "only \\d+ well-spaced views.*10 are needed for intrinsics; \\d+ more are within 0.1 s of "
                "these; none "
                "reaches the .*[Mm]ove the board");
    QVERIFY(!QFile::exists(result()));
  }

  // One camera at rest: the results of the others are written nevertheless.
  void cameraThatFails_leavesTheOthersTheirs() {
    session_.replace(
        "cameras:\n",
        QString("cameras:\n  right: {recording: %1, stream: events.txt, resolution_px: [346, 260]}\n")
            .arg(simulated("still")));
    const Outcome outcome = run("intrinsics");
    VERIFY_OUTCOME(outcome, 1);
    VERIFY_SAYS(outcome, "^right: ");
    QCOMPARE(filesIn(result()), (QStringList{"left", "log.txt"}));
    QVERIFY(filesIn(result() + "/left").contains("intrinsics.yaml"));
    QVERIFY2(outcome.output.contains("Files of left are in "), qPrintable(outcome.output));
    QVERIFY(readFile(result() + "/log.txt").contains("warning  right: "));
  }

  void streamThatIsMissing_isMissedAtOnce() {
    session_.replace("imus:", "  right: {stream: /nowhere, resolution_px: [346, 260]}\nimus:");
    const Outcome outcome = run("intrinsics");
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, "/nowhere");
    QVERIFY2(!outcome.errors.contains("first look"), qPrintable(outcome.errors));
    QVERIFY(!QFile::exists(result()));
  }

  void firstLook_isAsLongAsWanted() {
    const Outcome outcome = run("intrinsics", {"--set", "tuning.intrinsics.first_look_slices=5", "--set",
                                               "tuning.intrinsics.first_look_projection_px=0.001"});
    VERIFY_OUTCOME(outcome, 0);
    QVERIFY(readFile(result() + "/log.txt").contains("first look: 5 slices"));
  }

  void boardOfAnotherSize_isNamed() {
    session_.replace("rows: 11", "rows: 9");
    const Outcome outcome = run("intrinsics");
    VERIFY_OUTCOME(outcome, 1);
    VERIFY_SAYS(outcome, "larger than 9 x 4.*[Cc]heck rows");
  }

  void resolutionOfOtherIntrinsics_isRefused() {
    session_.replace(
        "resolution_px: [346, 260]",
        "resolution_px: [346, 260]\n    intrinsics: {model: pinhole_radtan, resolution_px: [640, 480], "
        "focal_length_px: [500, 500], principal_point_px: [320, 240], distortion: [0, 0, 0, 0]}");
    const Outcome outcome = run("calibrate");
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, "640 x 480 px, but resolution_px is 346 x 260");
    QVERIFY(!QFile::exists(result()));
  }

  void symmetricBoard_isForOneCameraAlone() {
    session_.replace("asymmetric_circles", "symmetric_circles");
    Outcome outcome = run("intrinsics");
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, "a symmetric board looks the same when turned.*an IMU cannot be calibrated");
    session_ = session_.section("imus:", 0, 0);
    session_.replace("cameras:\n", "cameras:\n  other: {stream: /other, resolution_px: [346, 260]}\n");
    outcome = run("calibrate");
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, "poses between cameras are ambiguous.*evical intrinsics");
  }

  void cameraAlone_isSentToTheIntrinsics() {
    session_ = session_.section("imus:", 0, 0);
    const Outcome outcome = run("calibrate");
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, "neither an IMU nor a second camera.*evical intrinsics");
  }

  void unknownCamera_isNamedWithThoseThatAre() {
    const Outcome outcome = run("intrinsics", {"--camera", "right"});
    VERIFY_OUTCOME(outcome, 2);
    VERIFY_SAYS(outcome, "--camera right.*Choose one of: left");
    QVERIFY(!QFile::exists(result()));
  }

  void sessionsWithoutImus_mayCalibrateIntrinsics() {
    session_ = session_.section("imus:", 0, 0);
    const Outcome outcome = run("intrinsics", {"--camera", "left", "--quiet"});
    VERIFY_OUTCOME(outcome, 0);
  }

 private:
  QString result() const { return folder_->filePath("result"); }

  Outcome run(const char* command, const QStringList& more = {}) {
    writeFile(folder_->filePath("session.yaml"), session_.toUtf8());
    return runProgram(QStringList{command, folder_->filePath("session.yaml"), "-o", result()} + more, 300);
  }

  CameraIntrinsics trueIntrinsics() const {
    const std::string truth = (simulated("intrinsics") + "/truth.yaml").toStdString();
    return readIntrinsics(YamlNode::load(truth)["cameras"]["left"]["intrinsics"]);
  }

  std::unique_ptr<QTemporaryDir> folder_;
  QString session_;
};

EVICAL_TEST(TestIntrinsicsCommand)
#include "tst_intrinsics_command.moc"
