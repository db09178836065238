#include "core/base/error.h"
#include "core/pipeline/runs/result_files.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <QDir>
#include <QRegularExpression>
#include <QTemporaryDir>
#include <QXmlStreamReader>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace evical;
using namespace evical::test;

namespace {

const char* const kHostile = "<script>alert(\"1\")</script>&'x";

QString readFileForResultFiles(const QString& path) {
  QFile file(path);
  return file.open(QIODevice::ReadOnly) ? QString::fromUtf8(file.readAll()) : QString();
}

// Well formed, and without NaN or infinity as text; returns the text between the tags.
QString checkedText(const QString& page) {
  QXmlStreamReader reader(page);
  QString text;
  int scripts = 0;
  while (!reader.atEnd()) {
    reader.readNext();
    if (reader.isCharacters()) text += reader.text().toString() + " ";
    if (reader.isStartElement() && reader.name() == QLatin1String("script")) ++scripts;
  }
  if (reader.hasError())
    return QString("not well formed: %1, line %2").arg(reader.errorString()).arg(reader.lineNumber());
  if (scripts > 0) return "has a script";
  const QRegularExpression no_number("(?<![A-Za-z])[-+]?(nan|inf)(?![A-Za-z])",
                                     QRegularExpression::CaseInsensitiveOption);
  const QRegularExpressionMatch match = no_number.match(page);
  return match.hasMatch() ? "has " + match.captured() + " near " + page.mid(match.capturedStart() - 80, 160)
                          : text;
}

std::shared_ptr<const CalibrationRun> shared(const CalibrationRun& run) {
  return std::make_shared<const CalibrationRun>(run);
}

}  // namespace

class TestResultFiles : public QObject {
  Q_OBJECT

  SimulatedPass simulated_;
  CalibrationRun run_;
  QTemporaryDir folder_;
  QString page_, text_;

  QString path(const char* name) const { return folder_.filePath(name); }

 private slots:
  void initTestCase() {
    simulated_ = simulatePass(6.0);
    run_ = calibrate(simulated_.session, simulated_.detections, {});
    writeResultFiles(folder_.path().toStdString(), simulated_.session, shared(run_), "test", "log");
    page_ = readFileForResultFiles(path("report.html"));
    text_ = checkedText(page_);
  }

  void report_isWellFormedAndSelfContained() {
    QVERIFY2(text_.startsWith(" ") || text_.contains("Calibration of"), qPrintable(text_.left(300)));
    QVERIFY(!page_.contains("src="));
    QVERIFY(!page_.contains("@import") && !page_.contains("url("));
    QVERIFY2(page_.size() < 3'000'000, qPrintable(QString::number(page_.size())));
  }

  void sections_areAllThere() {
    for (const char* id :
         {"advice", "results", "sensors", "detections", "coverage", "excitation", "reprojection", "inertial",
          "convergence", "uncertainty", "split-half-check", "run"}) {
      const QString anchor = QString("<section id=\"%1\">").arg(id);
      QVERIFY2(page_.contains(anchor), id);
      QVERIFY2(page_.contains(QString("href=\"#%1\"").arg(id)), id);
    }
    QVERIFY(page_.count("<svg") >= 18);
  }

  void numbers_areThoseOfTheResult() {
    const NamedResult read = readResultYaml(path("result.yaml").toStdString());
    const CameraState& camera = read.result->state.cameras[0];
    const CameraUncertainty& sigma = read.result->uncertainty.cameras[0];
    const auto shown = [&](double value, double std) {
      const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(std))), 0, 6);
      return QString::number(value, 'f', decimals).replace('-', QChar(0x2212));
    };
    for (int k = 0; k < 3; ++k) {
      const QString mm =
          shown(1e3 * camera.reference_from_camera.translation_m[k], 1e3 * sigma.translation_std_m[k]);
      QVERIFY2(text_.contains(mm), qPrintable(mm));
    }
    const QString ms = shown(1e3 * camera.time_offset_s, 1e3 * sigma.time_offset_std_s);
    QVERIFY2(text_.contains(ms), qPrintable(ms));
    QVERIFY(
        text_.contains(QString("of %1 event windows or frames").arg(read.result->cameras[0].windows_total)));
    QVERIFY(read.result->split_half_check.has_value());
    QVERIFY2(text_.contains(QString::number(read.result->split_half_check->rms_sigmas, 'f', 2)),
             "rms of the halves");
  }

  void csvFiles_areLinkedAndWhole() {
    const QRegularExpression link("href=\"(plots/[^\"]+)\"");
    QSet<QString> linked;
    for (auto it = link.globalMatch(page_); it.hasNext();) linked.insert(it.next().captured(1));
    QVERIFY(linked.size() >= 15);
    for (const QString& name : linked) {
      const QStringList lines = readFileForResultFiles(folder_.filePath(name)).trimmed().split('\n');
      QVERIFY2(lines.size() > 1, qPrintable(name));
      const auto commas = lines[0].count(',');
      for (const QString& line : lines)
        if (!line.contains('"')) QCOMPARE(line.count(','), commas);
    }
    const QStringList there = QDir(folder_.filePath("plots")).entryList(QDir::Files);
    for (const QString& name : there)
      QVERIFY2(linked.contains("plots/" + name) || name.endsWith("_windows.csv"), qPrintable(name));
  }

  void csvFiles_areWhatIsPlotted() {
    // There are as many dots as lines, and the first dot at the position of the first line.
    const QStringList lines =
        readFileForResultFiles(folder_.filePath("plots/camera1_centres.csv")).trimmed().split('\n');
    const auto begin = page_.indexOf("aria-label=\"points over the image\"");
    QVERIFY(begin > 0);
    const QString svg = page_.mid(begin, page_.indexOf("</svg>", begin) - begin);
    const QString dots = svg.mid(svg.indexOf("class=\"dots"));
    const Resolution size = run_.detections.resolutions_px[0];
    int inside = 0;
    for (qsizetype i = 1; i < lines.size(); ++i) {
      const double x = lines[i].section(',', 0, 0).toDouble(), y = lines[i].section(',', 1, 1).toDouble();
      inside += x >= 0.0 && x <= size.width_px && y >= 0.0 && y <= size.height_px;
    }
    QCOMPARE(dots.count("h0"), inside);
  }

  void names_fromOutsideAreEscaped() {
    Session session = simulated_.session;
    session.recording = std::string("rec") + "<b>&\"'.bag";
    CalibrationRun run = run_;
    session.cameras[0].name = run.detections.cameras[0].camera = kHostile;
    session.imus[0].name = run.detections.imus[0].name = session.reference = "\"><img src=x onerror=1>";
    run.result.reason = "</style></p><script>1</script>";
    run.result.notes.emplace_back("a\x01note ]]> <i>");
    run.detections.faults.push_back({"<s>", FaultKind::Gap, 0.0, "<u>gap</u>"});
    QTemporaryDir folder;
    writeResultFiles(folder.path().toStdString(), session, shared(run), "1<2", "log");
    const QString page = readFileForResultFiles(folder.filePath("report.html"));
    const QString text = checkedText(page);
    QVERIFY2(text.contains(kHostile), qPrintable(text.left(300)));
    QVERIFY(!page.contains("<script") && !page.contains("<img") && !page.contains("<u>gap"));
    for (const QString& name : QDir(folder.filePath("plots")).entryList(QDir::Files))
      QVERIFY2(QRegularExpression("^[a-z0-9_]+\\.csv$").match(name).hasMatch(), qPrintable(name));
  }

  void exports_thatARigCannotHave_costNobodyTheRest() {
    Session session = simulated_.session;
    session.exports = {"openvins", "esvo", "kalibr"};
    QTemporaryDir folder;
    const ExportRemarks remarks =
        writeResultFiles(folder.path().toStdString(), session, shared(run_), "test", "the log\n");
    QCOMPARE(remarks.refused.size(), std::size_t{1});
    QVERIFY(QString::fromStdString(remarks.refused[0]).startsWith("esvo: not exported"));
    for (const char* const file : {"kalibr/imu.yaml", "openvins/kalibr_imu_chain.yaml", "result.yaml"})
      QVERIFY2(QFile::exists(folder.filePath(file)), file);
    QVERIFY(!QFile::exists(folder.filePath("esvo")));
    const QString log = readFileForResultFiles(folder.filePath("log.txt"));
    QVERIFY(log.startsWith("the log\n") && log.contains("esvo: not exported"));
    QVERIFY(log.contains("random walks are not measured"));
  }

  void onlyTarget_thatIsRefused_isNamed() {
    CalibrationRun run = run_;
    run.result.state.cameras[0].time_offset_s = std::numeric_limits<double>::quiet_NaN();
    QTemporaryDir folder;
    const ExportRemarks remarks =
        writeResultFiles(folder.path().toStdString(), simulated_.session, shared(run), "test", "log");
    QCOMPARE(remarks.refused.size(), std::size_t{1});
    QVERIFY2(remarks.refused[0].starts_with("kalibr: not exported: "), remarks.refused[0].c_str());
    QVERIFY(remarks.targets.empty());
  }

  void exports_areReadBackBesideTheResult() {
    Session session = simulated_.session;
    session.exports = {"ros"};
    QTemporaryDir folder;
    const std::filesystem::path place = folder.path().toStdString();
    const ExportRemarks remarks = writeResultFiles(place, session, shared(run_), "test", "log");
    for (const ExportCheck& check : checkExports(place, remarks.targets, {}))
      QVERIFY2(check.same, check.text.c_str());
    QVERIFY(QFile::remove(folder.filePath("kalibr/imu.yaml")));
    const std::vector<ExportCheck> checks = checkExports(place, remarks.targets, {});
    QCOMPARE(checks.size(), std::size_t{2});
    QVERIFY(!checks[0].same && checks[1].same);  // kalibr, ros
  }

  void numbersThatAreNone_areNotShown() {
    CalibrationRun run = run_;
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    run.result.uncertainty.cameras[0].translation_std_m.setConstant(nan);
    run.result.uncertainty.cameras[0].time_offset_std_s = inf;
    run.result.uncertainty.correlation(0, 1) = nan;
    run.result.uncertainty.observability[0] = 0.0;
    run.result.circle_residuals[0].residual_px.setConstant(nan);
    run.result.iterations[0].cost = nan;
    run.result.cameras[0].normalised_rms = inf;
    run.result.split_half_check->quantities[0].difference = nan;
    QTemporaryDir folder;
    writeResultFiles(folder.path().toStdString(), simulated_.session, shared(run), "test", "log");
    const QString text = checkedText(readFileForResultFiles(folder.filePath("report.html")));
    QVERIFY2(text.contains("Calibration of"), qPrintable(text.left(400)));
  }

  void calibratedIntrinsics_haveTheirSection() {
    QVERIFY(!page_.contains("<section id=\"intrinsics\">") &&
            text_.contains("Intrinsics refined in the joint optimisation"));
    CalibrationRun run = run_;
    IntrinsicsResult& found = run.intrinsics.emplace_back().emplace();
    found.intrinsics = *simulated_.session.cameras[0].intrinsics;
    run.result.state.cameras[0].lens.given.reset();
    run.result.state.cameras[0].lens.solved.reset();
    run.result.uncertainty.cameras[0].intrinsics_std.emplace().fill(0.05);
    found.covariance.diagonal().head<8>().setConstant(0.0025);
    found.status = CalibrationStatus::Doubtful;
    found.reason = "no views reach the <left> side";
    found.advice = {"No views in the left edge: move the board there"};
    found.image.columns = 2;
    found.image.rows = 1;
    found.image.cells = {{{86.5, 129.5}, 0, std::numeric_limits<double>::infinity()},
                         {{259.5, 129.5}, 1234, 0.021}};
    QTemporaryDir folder;
    writeResultFiles(folder.path().toStdString(), simulated_.session, shared(run), "test", "log");
    const QString page = readFileForResultFiles(folder.filePath("report.html")), text = checkedText(page);
    QVERIFY2(page.contains("<section id=\"intrinsics\">"), qPrintable(text.left(400)));
    for (const char* said : {"Intrinsics calibrated first", "no views reach the <left> side",
                             "No views in the left edge", "1234"})
      QVERIFY2(text.contains(said), said);
    QVERIFY(page.contains("correlation of the intrinsics"));
    const QString cells = readFileForResultFiles(folder.filePath("plots/camera1_intrinsics.csv"));
    QCOMPARE(cells.count('\n'), 3);
    QVERIFY(readFileForResultFiles(folder.filePath("result.yaml")).contains("intrinsics_std:"));
  }

  void repair_isSaidWithTheVerdict() {
    QVERIFY(!page_.contains("class=\"repair\""));
    CalibrationRun run = run_;
    run.result.status = CalibrationStatus::Doubtful;
    run.result.repair = Repair{"imus.imu.acceleration_unit", "<g> 1"};
    QTemporaryDir folder;
    writeResultFiles(folder.path().toStdString(), simulated_.session, shared(run), "test", "log");
    const QString text = checkedText(readFileForResultFiles(folder.filePath("report.html")));
    QVERIFY2(text.contains("--set 'imus.imu.acceleration_unit=<g> 1'"), qPrintable(text.left(600)));
  }

  // Layouts of data sets store each of them in a separate place.
  void frameCamera_isNamedAsOne() {
    QVERIFY(!readFileForResultFiles(path("result.yaml")).contains("kind:"));
    CalibrationRun run = run_;
    run.detections.cameras[0].kind = CameraKind::Frames;
    QTemporaryDir folder;
    writeResultFiles(folder.path().toStdString(), simulated_.session, shared(run), "test", "log");
    const NamedResult read = readResultYaml(folder.filePath("result.yaml").toStdString());
    QVERIFY(read.cameras[0].kind == CameraKind::Frames);
  }

  void failedCalibration_hasItsReasonAndItsDetections() {
    QTemporaryDir folder;
    DetectionResult detections = simulated_.detections;
    detections.cameras[0].views.clear();
    for (WindowReport& window : detections.cameras[0].windows) window.outcome = WindowOutcome::NoLattice;
    writeFailure(folder.path().toStdString(), simulated_.session,
                 QualityWarning{"the board was <never> found"}, "test", "log", detections);
    const QString page = readFileForResultFiles(folder.filePath("report.html"));
    const QString text = checkedText(page);
    QVERIFY2(text.contains("the board was <never> found") && text.contains("failed"),
             qPrintable(text.left(300)));
    QVERIFY(page.contains("<section id=\"detections\">") && page.contains("<section id=\"excitation\">"));
    QVERIFY(!page.contains("<section id=\"results\">") && !page.contains("<section id=\"reprojection\">"));
    QVERIFY(text.contains("Keep more of the board in the image"));
  }

  void failureBeforeAnythingWasRead_isAReportToo() {
    QTemporaryDir folder;
    writeFailure(folder.path().toStdString(), simulated_.session, QualityWarning{"nothing there"}, "test",
                 "log");
    const QString text = checkedText(readFileForResultFiles(folder.filePath("report.html")));
    QVERIFY2(text.contains("nothing there"), qPrintable(text.left(300)));
    QVERIFY(QFile::exists(folder.filePath("result.yaml")) && QFile::exists(folder.filePath("log.txt")));
  }

  void advice_isGivenOnlyWhereTheDataSaySo() {
    QVERIFY(!text_.contains("Avoid data loss"));
    CalibrationRun run = run_;
    run.detections.faults.push_back({"imu", FaultKind::Gap, 1.0, "gap of 0.3 s at 1.0 s"});
    for (ImuSample& sample : run.detections.imus[0].samples) sample.angular_rate_rad_s.z() *= 0.01;
    for (BoardView& view : run.detections.cameras[0].views)
      std::erase_if(view.circles, [](const CircleObservation& c) { return c.centre_px.x() > 120.0; });
    QTemporaryDir folder;
    writeResultFiles(folder.path().toStdString(), simulated_.session, shared(run), "test", "log");
    const QString text = checkedText(readFileForResultFiles(folder.filePath("report.html")));
    for (const char* said : {"gap of 0.3 s", "Avoid data loss", "Turn about the z axis", "top right"})
      QVERIFY2(text.contains(said), said);
  }
};

EVICAL_TEST(TestResultFiles)
#include "tst_result_files.moc"
