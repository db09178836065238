// A saved run opens again completely; a folder that is damaged or of an older version shows its available
// data and lists what is missing.
#include "core/base/error.h"
#include "core/base/time.h"
#include "core/frontend/detection_options.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/detection/view_rejection.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/runs/run_data.h"
#include "core/pipeline/runs/saved_run.h"
#include "core/report/result_yaml.h"
#include "tests/support/file_content.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

using namespace evical;
using namespace evical::test;

namespace {

void writeForSavedRun(const std::filesystem::path& path, const QByteArray& content) {
  QFile file(QString::fromStdString(path.string()));
  QVERIFY(file.open(QIODevice::WriteOnly));
  file.write(content);
}

QString missingIn(const SavedRun& saved) {
  QStringList texts;
  for (const std::string& text : saved.missing) texts << QString::fromStdString(text);
  return texts.join('\n');
}

}  // namespace

class TestSavedRun : public QObject {
  Q_OBJECT

  SimulatedPass simulated_;
  std::shared_ptr<const CalibrationRun> run_;
  QTemporaryDir scratch_;
  static constexpr int kRejected = 5;

  std::filesystem::path scratch() const { return scratch_.path().toStdString(); }
  std::filesystem::path result() const { return scratch() / "result"; }
  std::filesystem::path copy(const char* name) const {
    std::filesystem::copy(result(), scratch() / name, std::filesystem::copy_options::recursive);
    return scratch() / name;
  }

 private slots:
  void initTestCase() {
    simulated_ = simulatePass(5.0);
    writeForSavedRun(scratch() / "recording.bag", "a recording");
    simulated_.session.recording = scratch() / "recording.bag";
    simulated_.session.options.optimisation.edit().max_iterations += 1;
    const DetectionResult detections = withoutViews(simulated_.detections, 0, std::vector{7, 20, 21, 40, 60});
    run_ = std::make_shared<CalibrationRun>(calibrate(simulated_.session, detections, {}));
    std::filesystem::create_directories(result());
    writeResultFiles(result(), simulated_.session, run_, "test", "the log\n");
  }

  void run_isReadBackBitByBit() {
    const SavedRun saved = readSavedRun(result());
    QVERIFY2(saved.missing.empty(), qPrintable(missingIn(saved)));
    QVERIFY(runData(*saved.run) == runData(*run_));
    QCOMPARE(static_cast<int>(saved.run->detections.rejected_views.at(0).size()),
             kRejected);  // can be undone
    const CalibrationResult& result = saved.run->result;
    QVERIFY(result.circle_residuals.size() > 1000);
    QVERIFY(result.iterations.size() > 3 && !result.state.imu_in_world_m.control_points.empty());
    QVERIFY(saved.run->detections.imus[0].samples.size() == run_->detections.imus[0].samples.size());
    QCOMPARE(sessionYaml(saved.session, "/"), sessionYaml(simulated_.session, "/"));
    QVERIFY(QString::fromStdString(saved.log).startsWith("the log"));
    const NamedResult before = namedRun(simulated_.session, run_, "test"),
                      after = namedRun(saved.session, saved.run, "test");
    QCOMPARE(resultYaml(after), resultYaml(before));
  }

  // A field of today's struct that an older version did not have.
  void runWithoutAField_hasTheOthers_data() {
    QTest::addColumn<QString>("field");
    QTest::newRow("number") << "result/memory_peak_mb";
    QTest::newRow("column of a list") << "observations/imus/samples/measured_by";
    QTest::newRow("vectors of a list") << "result/circle_residuals/sigma_px";
    QTest::newRow("list") << "result/notes/count";
    QTest::newRow("struct") << "result/timing/total_s";
    QTest::newRow("optional") << "observations/cameras/polarity_delay/count";
  }

  void runWithoutAField_hasTheOthers() {
    QFETCH(const QString, field);
    const std::string content = runData(*run_);
    const Hdf5Source all = runDatasets(content);
    int left_out = 0;
    const ReadRunData read = runFrom(
        [&](const std::string& path) {
          const bool is_field = path == field.toStdString();
          left_out += is_field ? 1 : 0;
          return is_field ? std::nullopt : all(path);
        },
        content.size());
    QCOMPARE(left_out, 1);
    QVERIFY(read.missing.empty() && read.has_result && read.has_pass);
    const CalibrationResult &result = read.run.result, &before = run_->result;
    QCOMPARE(result.memory_peak_mb, field.endsWith("memory_peak_mb") ? 0.0 : before.memory_peak_mb);
    QCOMPARE(result.timing.total_s, field.endsWith("total_s") ? 0.0 : before.timing.total_s);
    QCOMPARE(result.notes.size(), field.contains("notes") ? 0 : before.notes.size());
    QCOMPARE(result.circle_residuals.size(), before.circle_residuals.size());
    QVERIFY(result.circle_residuals.back().residual_px == before.circle_residuals.back().residual_px);
    QVERIFY(result.circle_residuals.back().sigma_px ==
            (field.contains("sigma_px") ? Eigen::Vector2d::Zero() : before.circle_residuals.back().sigma_px));
    const ImuSample &sample = read.run.detections.imus[0].samples.back(),
                    &sample_before = run_->detections.imus[0].samples.back();
    QVERIFY(sample.time_ns == sample_before.time_ns && sample.measured_by == MeasuredBy::Both);
    QVERIFY(sample.angular_rate_rad_s == sample_before.angular_rate_rad_s);
  }

  void numbersThatAreNone_comeBack() {
    CalibrationRun run = *run_;
    run.result.timing.read_s = std::bit_cast<double>(0x7ff8000000012345);
    run.result.timing.detect_s = -0.0;
    run.result.memory_peak_mb = std::numeric_limits<double>::denorm_min();
    run.detections.imus[0].samples.back().time_ns = kLatestTime_ns;
    const CalibrationRun read = parseRunData(runData(run)).run;
    QVERIFY(std::bit_cast<std::uint64_t>(read.result.timing.read_s) == 0x7ff8000000012345);
    QVERIFY(std::signbit(read.result.timing.detect_s));
    QCOMPARE(read.result.memory_peak_mb, run.result.memory_peak_mb);
    QVERIFY(read.detections.imus[0].samples.back().time_ns == kLatestTime_ns);
  }

  // For any changed byte, each part is unchanged or missing.
  void damagedData_isNeverMisread() {
    const std::string content = runData(*run_);
    std::set<std::string> parts;
    for (int k = 0; k < 8; ++k)
      parts.insert(
          runData({k & 1 ? run_->result : CalibrationResult{}, k & 2 ? run_->detections : DetectionResult{},
                   k & 4 ? run_->intrinsics : decltype(run_->intrinsics){}}));
    const std::size_t observations = content.find("observations ");
    QVERIFY(observations < content.size());
    for (int k = 0; k < 60; ++k) {
      std::string damaged = content;
      const std::size_t at = k < 20   ? static_cast<std::size_t>(k)
                             : k < 40 ? observations - 10 + static_cast<std::size_t>(k - 20)
                                      : content.size() * static_cast<std::size_t>(k - 40) / 20;
      if (k % 2 == 0)
        damaged[at] = static_cast<char>(damaged[at] ^ (1 << k % 8));
      else
        damaged.resize(at);
      const ReadRunData read = parseRunData(damaged);
      QVERIFY(!read.missing.empty());
      QVERIFY2(parts.contains(runData(read.run)), qPrintable(QString::number(at)));
    }
  }

  void file_opensItsFolder() {
    QVERIFY(isSavedRun(result()) && isSavedRun(result() / "result.yaml"));
    QVERIFY(!isSavedRun(scratch()) && !isSavedRun(scratch() / "recording.bag"));
    QVERIFY(runData(*readSavedRun(result() / "result.yaml").run) == runData(*run_));
  }

  // The log of a run has the same content; it is the caller's.
  void rejectedWindows_areCountedAndNamedAlike() {
    const CameraFit& fit = run_->result.cameras[0];
    QCOMPARE(fit.windows_rejected, kRejected);
    const auto views = static_cast<int>(run_->detections.cameras[0].views.size());
    QCOMPARE(fit.windows_complete + fit.windows_partial, views);

    QMap<QString, int> outcomes;
    QStringList times;
    for (const QByteArray& line : evical::test::fileContent(result() / "windows.csv").split('\n')) {
      const QStringList words = QString::fromUtf8(line).split(',');
      if (words.size() < 4) continue;
      ++outcomes[words[3]];
      if (words[3] == "rejected by hand") times << words[1];
    }
    QCOMPARE(outcomes["rejected by hand"], kRejected);
    QCOMPARE(outcomes["complete"] + outcomes["partial"], views);
    QCOMPARE(outcomes["complete"], fit.windows_complete);

    const NamedResult read = readResultYaml(result() / "result.yaml");
    QVERIFY(read.result->rejected_windows == run_->result.rejected_windows);
    QCOMPARE(read.result->cameras[0].windows_rejected, kRejected);
    QCOMPARE(static_cast<int>(read.result->rejected_windows.size()), kRejected);
    for (int k = 0; k < kRejected; ++k) {
      const RejectedWindow& window = read.result->rejected_windows[static_cast<std::size_t>(k)];
      QCOMPARE(window.time_s, times[k].toDouble());
    }
    const auto says = [](const std::string& note) {
      return QString::fromStdString(note).contains("5 windows with the board rejected by hand, at");
    };
    QVERIFY(std::any_of(read.result->notes.begin(), read.result->notes.end(), says));
    const QByteArray report = evical::test::fileContent(result() / "report.html");
    QVERIFY(report.contains("rejected by hand") &&
            report.contains("5 windows with the board rejected by hand"));
  }

  void durations_areOfThisRun() {
    DetectionResult before = simulated_.detections;
    before.read_s = before.detect_s = 1000.0;
    const Timing timing =
        calibrate(simulated_.session, withoutViews(before, 0, std::vector{1}), {}).result.timing;
    QVERIFY(timing.total_s < 500.0);
    QVERIFY(timing.total_s >= timing.initialise_s + timing.optimise_s);
  }

  void damagedData_showsWhatIsThere_data() {
    QTest::addColumn<int>("at_percent");
    QTest::addColumn<bool>("cut");
    QTest::addColumn<QString>("said");
    QTest::addColumn<bool>("has_trajectory");
    QTest::addColumn<bool>("has_samples");
    QTest::newRow("flipped early") << 10 << false << "trajectory, convergence and residuals" << false << true;
    QTest::newRow("flipped late") << 95 << false << "detections of the board" << true << false;
    QTest::newRow("cut off") << 90 << true << "detections of the board" << true << false;
    QTest::newRow("empty") << 0 << true << "run.data is missing" << false << false;
  }

  void damagedData_showsWhatIsThere() {
    QFETCH(const int, at_percent);
    QFETCH(const bool, cut);
    QFETCH(const QString, said);
    QFETCH(const bool, has_trajectory);
    QFETCH(const bool, has_samples);
    const std::filesystem::path folder = copy(QTest::currentDataTag());
    QByteArray data = evical::test::fileContent(folder / "run.data");
    const qsizetype at = data.size() * at_percent / 100;
    if (cut)
      data.truncate(at);
    else
      data[at] = static_cast<char>(data[at] ^ 0x10);
    writeForSavedRun(folder / "run.data", data);
    const SavedRun saved = readSavedRun(folder);
    QVERIFY2(missingIn(saved).contains(said), qPrintable(missingIn(saved)));
    const CalibrationResult& result = saved.run->result;
    QCOMPARE(!result.state.imu_in_world_m.control_points.empty(), has_trajectory);
    QCOMPARE(!saved.run->detections.imus.empty(), has_samples);
    QVERIFY(result.status == run_->result.status);
    const double moved_m = (result.state.cameras[0].reference_from_camera.translation_m -
                            run_->result.state.cameras[0].reference_from_camera.translation_m)
                               .norm();
    QVERIFY(moved_m < 1e-9);
    // Views are read from the tables if the data lacks them.
    QCOMPARE(saved.run->detections.cameras[0].views.size(), run_->detections.cameras[0].views.size());
    QCOMPARE(saved.run->detections.cameras[0].windows.size(), run_->detections.cameras[0].windows.size());
    for (const CircleResidual& r : result.circle_residuals)
      QVERIFY(static_cast<std::size_t>(r.view) < saved.run->detections.cameras[0].views.size());
  }

  // result.yaml is the truth: run.data is its cache.
  void resultThatWasEdited_isTheTruth() {
    const std::filesystem::path folder = copy("edited");
    QVERIFY(!whyRunDataIsForeign(folder / "result.yaml"));
    QByteArray yaml = evical::test::fileContent(folder / "result.yaml");
    const QByteArray key = "\n    time_offset_s: ";  // the camera's comes first
    const qsizetype at = yaml.indexOf(key) + key.size();
    yaml.replace(at, yaml.indexOf('\n', at) - at, "0.5");
    writeForSavedRun(folder / "result.yaml", yaml);
    const SavedRun saved = readSavedRun(folder);
    QCOMPARE(saved.run->result.state.cameras[0].time_offset_s, 0.5);
    QVERIFY(saved.run->result.state.imu_in_world_m.control_points.empty());
    QVERIFY2(missingIn(saved).contains("result.yaml was changed later"), qPrintable(missingIn(saved)));
    QVERIFY(missingIn(saved).contains("Its trajectory, convergence and residuals are missing"));
    QVERIFY(whyRunDataIsForeign(folder / "result.yaml").value_or("").find("changed later") !=
            std::string::npos);
    QCOMPARE(saved.run->detections.cameras[0].views.size(),
             run_->detections.cameras[0].views.size());  // of the tables
  }

  void runDataOfAnotherRun_isNotMixedIn() {
    const std::filesystem::path folder = copy("mixed");
    auto other = std::make_shared<CalibrationRun>(*run_);
    other->result.state.cameras[0].time_offset_s = 0.25;
    keepRun(scratch() / "mixed_other", simulated_.session, other, "test", "", 100);
    QVERIFY(readSavedRun(scratch() / "mixed_other").missing.empty());
    std::filesystem::copy_file(scratch() / "mixed_other" / "run.data", folder / "run.data",
                               std::filesystem::copy_options::overwrite_existing);
    const SavedRun saved = readSavedRun(folder);
    QVERIFY2(missingIn(saved).contains("it belongs to another run"), qPrintable(missingIn(saved)));
    QCOMPARE(saved.run->result.state.cameras[0].time_offset_s,
             readResultYaml(folder / "result.yaml").result->state.cameras[0].time_offset_s);
  }

  // Its checksum is not compared: older versions did not write it.
  void runDataWithoutAChecksum_isUsed() {
    const std::filesystem::path folder = copy("unchecked");
    writeForSavedRun(folder / "run.data", QByteArray::fromStdString(runData(*run_)));
    QVERIFY(!whyRunDataIsForeign(folder / "result.yaml"));
    QVERIFY2(readSavedRun(folder).missing.empty(), qPrintable(missingIn(readSavedRun(folder))));
  }

  void damagedChecksum_isNoAgreement() {
    const std::filesystem::path folder = copy("damaged_sum");
    QByteArray data = evical::test::fileContent(folder / "run.data");
    const qsizetype line = data.indexOf('\n', data.indexOf("result_yaml_checksum"));
    data[line + 200] = static_cast<char>(data[line + 200] ^ 0x10);
    writeForSavedRun(folder / "run.data", data);
    QVERIFY(missingIn(readSavedRun(folder)).contains("run.data is not used"));
  }

  void olderFolder_hasItsNumbersAndDetections() {
    const std::filesystem::path folder = copy("older");
    for (const char* name : {"run.data", "run.yaml", "run_session.yaml"})
      std::filesystem::remove(folder / name);
    const SavedRun saved = readSavedRun(folder);
    QVERIFY(missingIn(saved).contains("run_session.yaml"));
    QCOMPARE(saved.session.cameras.size(), simulated_.session.cameras.size());
    QCOMPARE(saved.session.board.rows, simulated_.session.board.rows);
    QCOMPARE(QString::fromStdString(saved.session.recording.filename().string()), QString("recording.bag"));
    QCOMPARE(saved.run->detections.cameras[0].views.size(), run_->detections.cameras[0].views.size());
    QVERIFY(saved.run->result.uncertainty.columns == run_->result.uncertainty.columns);
  }

  void numbersOfPeople_mayBeMissing() {
    const std::filesystem::path folder = copy("without_yaml");
    std::filesystem::remove(folder / "result.yaml");
    const SavedRun saved = readSavedRun(folder);
    QVERIFY(missingIn(saved).contains("result.yaml"));
    QVERIFY(runData(*saved.run) == runData(*run_));
    std::filesystem::remove(folder / "run.data");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, readSavedRun(folder));
  }

  void partsOfTwoRuns_areRefused() {
    const std::filesystem::path folder = copy("two");
    Session other = simulated_.session;
    other.cameras.push_back(other.cameras[0]);
    other.cameras.back().name = "another";
    other.cameras.back().stream = "/another";
    writeForSavedRun(folder / "run_session.yaml", QByteArray::fromStdString(sessionYaml(other, folder)));
    try {
      readSavedRun(folder);
      QFAIL("accepted");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains("not the session of the result"), error.what());
    }
  }

  void recordingThatMovedAlong_isFound() {
    const std::filesystem::path before = scratch() / "before", after = scratch() / "after";
    std::filesystem::create_directories(before);
    std::filesystem::copy(scratch() / "recording.bag", before / "recording.bag");
    Session session = simulated_.session;
    session.recording = before / "recording.bag";
    keepRun(before / "runs" / "one", session, run_, "test", "", 100);
    std::filesystem::rename(before, after);
    const SavedRun saved = readSavedRun(after / "runs" / "one");
    QVERIFY(std::filesystem::equivalent(saved.session.recording, after / "recording.bag"));
  }

  void recordingThatIsGone_leavesTheRest() {
    const std::filesystem::path folder = scratch() / "gone";
    writeForSavedRun(scratch() / "short_lived.bag", "a recording");
    Session session = simulated_.session;
    session.recording = scratch() / "short_lived.bag";
    keepRun(folder, session, run_, "test", "", 100);
    std::filesystem::remove(session.recording);
    const SavedRun saved = readSavedRun(folder);
    QVERIFY2(saved.missing.empty(), qPrintable(missingIn(saved)));
    QCOMPARE(saved.session.recording, session.recording);
    QVERIFY(runData(*saved.run) == runData(*run_));
  }

  void list_isNamedComparedAndBounded() {
    const std::filesystem::path place = scratch() / "list";
    Session session = simulated_.session;
    for (int k = 0; k < 4; ++k) {
      session.options.front_end.edit().grid.min_circles = 8 + k / 2;
      keepRun(place / std::to_string(k), session, run_, "test", "", 1000 + k);
    }
    renameRun(place / "1", "the \"good\": one");
    std::vector<RunSummary> runs = listRuns(place);
    QCOMPARE(runs.size(), std::size_t{4});
    QCOMPARE(QString::fromStdString(runs[1].name), QString("the \"good\": one"));
    QCOMPARE(runs[3].rejected_windows, kRejected);
    QCOMPARE(runs[0].made_s, std::int64_t{1000});
    QVERIFY(differingFrom(runs[0], runs[1]).empty());
    const std::vector<std::string> differing = differingFrom(runs[1], runs[2]);
    QCOMPARE(differing.size(), std::size_t{1});
    QVERIFY2(differing[0].find("min_circles 9 (was ") != std::string::npos, differing[0].c_str());

    writeForSavedRun(place / "2" / "run.yaml", "evical_run: 7\n");
    QCOMPARE(listRuns(place).size(), std::size_t{3});
    removeOldRuns(listRuns(place), 2, 1'000'000'000);  // the one with a name stays before the older one
    runs = listRuns(place);
    QCOMPARE(runs.size(), std::size_t{2});
    QVERIFY(runs[0].folder.filename() == "1" && runs[1].folder.filename() == "3");
    removeOldRuns(runs, 20, 1);  // the newest stays, however large it is
    QCOMPARE(listRuns(place).size(), std::size_t{1});
  }
};

EVICAL_TEST(TestSavedRun)
#include "tst_saved_run.moc"
