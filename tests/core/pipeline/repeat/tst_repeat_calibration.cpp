// Several recordings of one rig: alone, jointly, and with one of another rig among them.
#include "core/base/error.h"
#include "core/base/yaml_node.h"
#include "core/geometry/so3.h"
#include "core/numerics/angles.h"
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/compare/rig_quantities.h"
#include "core/pipeline/repeat/repeat_calibration.h"
#include "core/pipeline/repeat/repeat_files.h"
#include "core/report/assessment_report.h"
#include "core/report/truth_comparison.h"
#include "tests/support/scenario_session.h"
#include "tests/support/simulated_pass.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

using namespace evical;
using namespace evical::test;

namespace {

constexpr double kRepeatCalibrationDuration_s = 6.0;

Scenario briskForRepeatCalibration(std::uint64_t seed, const std::string& name = "davis346") {
  Scenario scenario = simulatePass(2.0, name).truth;
  scenario.motion.image_speed_px_s = 150.0;
  scenario.seed = seed;
  scenario.start_ns += static_cast<std::int64_t>(seed) * 3'600'000'000'000;
  return scenario;
}

// Changes of the recordings before their calibration.
struct Spoil {
  std::function<void(std::size_t, Scenario&)> rig = {};
  std::function<void(std::size_t, DetectionResult&)> detections = {};
};

RepeatRun repeatOf(std::size_t count, const Spoil& spoil = {}, const std::string& name = "davis346",
                   const RunContext& context = {}) {
  std::vector<Session> sessions;
  std::vector<DetectionResult> passes;
  for (std::size_t k = 0; k < count; ++k) {
    Scenario scenario = briskForRepeatCalibration(k + 1, name);
    Session session = simulatePass(2.0, scenario).session;  // the user's session of the rig
    if (spoil.rig) spoil.rig(k, scenario);
    SimulatedPass simulated = simulatePass(kRepeatCalibrationDuration_s, scenario);
    if (spoil.detections) spoil.detections(k, simulated.detections);
    session.recording = "recording" + std::to_string(k + 1) + ".bag";
    session.source = "session" + std::to_string(k + 1) + ".yaml";
    sessions.push_back(std::move(session));
    passes.push_back(std::move(simulated.detections));
  }
  const RepeatInput input = evical::repeatOf(std::move(sessions));
  return repeatCalibration(
      input,
      [&](std::size_t k, const Session& session, const RunContext& one) {
        return runCalibration(session, passes[k], one);
      },
      {}, context);
}

void turnCamera(std::size_t of, double angle_deg, std::size_t k, Scenario& scenario) {
  RigidTransform& pose = scenario.cameras.back().imu_from_camera;
  if (k == of)
    pose.rotation =
        Eigen::Quaterniond(so3Exp(Eigen::Vector3d(0.0, kRadPerDeg * angle_deg, 0.0))) * pose.rotation;
}

Session sessionNamed(const std::string& recording) {
  Session session = simulatePass(2.0).session;
  session.recording = recording;
  session.source = recording + ".yaml";
  return session;
}

}  // namespace

class TestRepeatCalibration : public QObject {
  Q_OBJECT

  RepeatRun good_;

  void verifyRejected(const std::function<void(Session&)>& change, const char* part) const {
    Session second = sessionNamed("b.bag");
    change(second);
    try {
      evical::repeatOf({sessionNamed("a.bag"), second});
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY2(std::string(error.what()).find(part) != std::string::npos, error.what());
      return;
    }
    QFAIL("it was accepted");
  }

 private slots:
  void initTestCase() { good_ = repeatOf(3); }

  // The size of a further board is a prior, too, which is counted once.
  void sigmasOfFurtherBoards_areTheSame() {
    const auto repeatWith = [](std::optional<double> first, std::optional<double> second) {
      std::vector<Session> sessions;
      for (const char* name : {"a", "b"}) {
        Session& session = sessions.emplace_back(simulatePass(2.0, "two_boards").session);
        session.recording = std::string(name) + ".bag";
        session.source = std::string(name) + ".yaml";
      }
      sessions[0].further_boards.at(0).spacing_std = first;
      sessions[1].further_boards.at(0).spacing_std = second;
      return evical::repeatOf(std::move(sessions));
    };
    const double usual = OptimisationOptions().board_spacing_sigma;
    repeatWith({}, {});
    repeatWith({}, usual);
    repeatWith(0.5 * usual, 0.5 * usual);
    QVERIFY_THROWS_EXCEPTION(CalibrationError, repeatWith({}, 0.5 * usual));
    QVERIFY_THROWS_EXCEPTION(CalibrationError, repeatWith(0.25 * usual, 0.5 * usual));
  }

  // A session need not give the resolution, on which the weak prior of a line delay depends.
  void priorOfLineDelays_needsNoResolutionInTheSession() {
    const SimulatedPass simulated = simulatePass(2.0, "rolling_shutter");
    CalibrationState state;
    for (const CameraLens& lens : simulated.detections.lenses) state.cameras.emplace_back().lens = lens;
    state.imus.resize(simulated.session.imus.size());
    Session without = simulated.session;
    for (SessionCamera& camera : without.cameras) camera.resolution_px = {};
    int compared = 0;
    const RigQuantities given(simulated.session, state), recorded(without, state);
    for (std::size_t k = 0; k < given.all.size(); ++k) {
      if (given.all[k].info->id != QuantityId::LineDelay) continue;
      QVERIFY(given.all[k].prior_information.size() == 1 && given.all[k].prior_information(0, 0) > 0.0);
      QCOMPARE(recorded.all[k].prior_information(0, 0), given.all[k].prior_information(0, 0));
      ++compared;
    }
    QVERIFY(compared > 0);
  }

  void otherOptions_areRefused() {
    verifyRejected([](Session& session) { session.options.optimisation.edit().pixel_delay_ms *= 2.0; },
                   "results computed with different options cannot be combined");
  }

  // If the model is selected per recording, models may differ; then parameters of the same name have
  // different meanings.
  void otherLensModel_isNotCombined() {
    const SimulatedPass simulated = simulatePass(2.0);
    std::vector<Session> sessions;
    for (const char* name : {"a", "b", "c"}) {
      Session session = sessionNamed(std::string(name) + ".bag");
      sessions.push_back(session);
    }
    const RepeatInput input = evical::repeatOf(std::move(sessions));
    const auto calibrate = [&](std::size_t k, const Session& session, const RunContext& one) {
      CalibrationOutcome outcome = runCalibration(
          session, simulatePass(kRepeatCalibrationDuration_s, briskForRepeatCalibration(k + 1)).detections,
          one);
      if (k == 1 && outcome.run) {
        CameraLens& lens = outcome.run->result.state.cameras[0].lens;
        lens.solved = lens.inUse();
        lens.solved->model = CameraModel::PinholeEquidistant;
      }
      return outcome;
    };
    const Repeatability repeat = repeatCalibration(input, calibrate, {}, {}).repeatability;
    QVERIFY(repeat.recordings[1].outcome == RepeatOutcome::Failed);
    QVERIFY2(repeat.recordings[1].reason.find("set intrinsics.model in all sessions") != std::string::npos,
             repeat.recordings[1].reason.c_str());
    QCOMPARE(repeat.columns.size(), std::size_t{2});
  }

  void unchangedRig_agrees() {
    const Repeatability& repeat = good_.repeatability;
    QVERIFY2(repeat.verdict == Verdict::Unchanged, repeat.reason.c_str());
    QCOMPARE(repeat.columns.size(), std::size_t{3});
    for (const RepeatedRecording& recording : repeat.recordings) {
      QVERIFY(recording.outcome == RepeatOutcome::Fits);
      QVERIFY(recording.freedom > 20 && recording.chi_square < recording.limit);
    }
    // Some thirty quantities of three recordings, which are correlated.
    QVERIFY2(repeat.rms_ratio > 0.5 && repeat.rms_ratio < 1.6, qPrintable(QString::number(repeat.rms_ratio)));
  }

  void joint_isNearerTheTruthThanItsSigmasSay_andSurerThanEachAlone() {
    QVERIFY(good_.joint.has_value());
    const TruthComparison comparison = compareWithTruth(*good_.joint, truthOf(briskForRepeatCalibration(3)));
    for (const QuantityDifference& each : comparison.quantities)
      QVERIFY2(std::abs(each.normalised()) < 4.0,
               (each.name + ": " + std::to_string(each.normalised()) + " sigmas").c_str());
    QVERIFY2(comparison.normalisedRms() > 0.4 && comparison.normalisedRms() < 1.6,
             qPrintable(QString::number(comparison.normalisedRms())));
    int common = 0;
    for (const RepeatedQuantity& quantity : good_.repeatability.quantities) {
      if (!quantity.common) {
        QCOMPARE(QString::fromStdString(quantity.name), QString("time_offset"));
        continue;
      }
      for (const RepeatedNumber& number : quantity.numbers) {
        QVERIFY(number.joint_sigma > 0.0);
        ++common;
        for (const double sigma : number.sigmas)
          QVERIFY2(number.joint_sigma < 1.02 * sigma, (quantity.sensor + "." + number.name).c_str());
      }
      // Three times the data: sigmas decrease by about the square root of three.
      if (quantity.name == "rotation" || quantity.name == "translation")
        for (const RepeatedNumber& number : quantity.numbers) {
          double mean = 0.0;
          for (const double sigma : number.sigmas) mean += sigma / 3.0;
          QVERIFY2(number.joint_sigma < 0.8 * mean, (quantity.sensor + "." + number.name).c_str());
        }
    }
    QVERIFY(common > 20);
  }

  // Not all four: the prior on the board's size is common to all, so its sigma does not decrease.
  void priorsCountOnce() {
    for (const RepeatedQuantity& quantity : good_.repeatability.quantities) {
      if (quantity.name != "scale") continue;
      const RepeatedNumber& number = quantity.numbers.front();
      // A prior of 0.2 % (optimisation.board_spacing_sigma): divided by the root of three it would be 0.115
      // %.
      QVERIFY(number.joint_sigma > 0.5 * number.sigmas.front());
      QVERIFY(number.mean_sigma < 0.9 * number.sigmas.front());
    }
  }

  void turnedCamera_isTheOneThatIsNamed() {
    const RepeatRun run =
        repeatOf(3, {[](std::size_t k, Scenario& scenario) { turnCamera(1, 1.0, k, scenario); }, {}});
    const Repeatability& repeat = run.repeatability;
    QVERIFY2(repeat.verdict == Verdict::Changed, repeat.reason.c_str());
    QVERIFY(repeat.recordings[0].outcome == RepeatOutcome::Fits);
    QVERIFY(repeat.recordings[1].outcome == RepeatOutcome::DoesNotFit);
    QVERIFY(repeat.recordings[2].outcome == RepeatOutcome::Fits);
    const Finding& differs = repeat.recordings[1].findings.front();
    QCOMPARE(QString::fromStdString(differs.quantity), QString("rotation"));
    QVERIFY2(std::abs(differs.change - 1.0) < 0.1, qPrintable(QString::number(differs.change)));
    QVERIFY2(repeat.reason.find("recording2: rotation of left by ") != std::string::npos,
             repeat.reason.c_str());
    // The solution equals that of the other two.
    for (const QuantityDifference& each :
         compareWithTruth(*run.joint, truthOf(briskForRepeatCalibration(3))).quantities)
      QVERIFY2(std::abs(each.normalised()) < 4.0, each.name.c_str());
  }

  void twoThatDisagree_areBothDoubtful() {
    const RepeatRun run =
        repeatOf(2, {[](std::size_t k, Scenario& scenario) { turnCamera(1, 1.0, k, scenario); }, {}});
    QVERIFY(run.repeatability.verdict == Verdict::Changed);
    QVERIFY2(run.repeatability.reason.find("which is correct") != std::string::npos,
             run.repeatability.reason.c_str());
    QVERIFY(run.joint->result->status == CalibrationStatus::Doubtful);
  }

  void failedRecording_isListedAndTheOthersGoOn() {
    const RepeatRun run = repeatOf(3, {{}, [](std::size_t k, DetectionResult& detections) {
                                         if (k == 0) detections.cameras.front().views.clear();
                                       }});
    const Repeatability& repeat = run.repeatability;
    QVERIFY2(repeat.verdict == Verdict::Unchanged, repeat.reason.c_str());
    QVERIFY(repeat.recordings[0].outcome == RepeatOutcome::Failed && !repeat.recordings[0].reason.empty());
    QCOMPARE(repeat.columns.size(), std::size_t{2});
    QVERIFY(repeat.notes.front().find("recording1") != std::string::npos);
  }

  void fewerThanTwo_isNoRepeat() {
    const RepeatRun run = repeatOf(2, {{}, [](std::size_t k, DetectionResult& detections) {
                                         if (k == 0) detections.cameras.front().views.clear();
                                       }});
    QVERIFY(run.repeatability.verdict == Verdict::CannotTell && !run.joint);
    QVERIFY2(run.repeatability.reason.find("1 of 2") != std::string::npos, run.repeatability.reason.c_str());
  }

  // With another name: its file does not identify it.
  void copyOfARecording_saysNothingNew() {
    const RepeatRun run = repeatOf(3, {[](std::size_t k, Scenario& scenario) {
                                         if (k == 2) scenario = briskForRepeatCalibration(1);
                                       },
                                       {}});
    QVERIFY(run.repeatability.recordings[2].outcome == RepeatOutcome::Failed);
    QVERIFY(run.repeatability.recordings[2].reason.find("duplicates recording1") != std::string::npos);
  }

  void camerasAlone_andOneOfThemTurned() {
    const RepeatRun good = repeatOf(3, {}, "stereo");
    // A rig of event cameras only has no pixel delay in its sigmas that could be removed.
    int offsets = 0;
    for (const RepeatedQuantity& quantity : good.repeatability.quantities)
      for (const RepeatedNumber& number : quantity.numbers) {
        if (number.name != "time_offset") continue;
        double squares = 0.0;
        for (const double sigma : number.sigmas) squares += sigma * sigma / 3.0;
        QVERIFY(std::abs(number.mean_sigma / std::sqrt(squares) - 1.0) < 1e-9);
        ++offsets;
      }
    QVERIFY(offsets == 1);
    QVERIFY2(good.repeatability.verdict == Verdict::Unchanged, good.repeatability.reason.c_str());
    for (const QuantityDifference& each :
         compareWithTruth(*good.joint, truthOf(briskForRepeatCalibration(3, "stereo"))).quantities)
      QVERIFY2(std::abs(each.normalised()) < 4.0, each.name.c_str());
    const RepeatRun turned = repeatOf(
        3, {[](std::size_t k, Scenario& scenario) { turnCamera(0, 1.0, k, scenario); }, {}}, "stereo");
    QVERIFY(turned.repeatability.recordings[0].outcome == RepeatOutcome::DoesNotFit);
    QCOMPARE(QString::fromStdString(turned.repeatability.recordings[0].findings.front().sensor),
             QString("right"));
  }

  void cancelled_isNoVerdict() {
    std::stop_source source;
    source.request_stop();
    QVERIFY_THROWS_EXCEPTION(Cancelled, repeatOf(2, {}, "davis346", {silentProgress(), source.get_token()}));
  }

  void otherRigOrBoard_isBadInput() {
    verifyRejected([](Session& s) { s.board.rows = 9; }, "9 x 4");
    verifyRejected([](Session& s) { s.cameras.front().name = "right"; }, "is right");
    verifyRejected(
        [](Session& s) {
          s.imus.clear();
          s.reference = "left";
        },
        "IMUs is none");
    verifyRejected([](Session& s) { s.reference = "left"; }, "reference");
    verifyRejected([](Session& s) { s.cameras.front().resolution_px = {640, 480}; }, "640 x 480");
    verifyRejected([](Session& s) { s.cameras.front().intrinsics->model = CameraModel::DoubleSphere; },
                   "lens");
    verifyRejected([](Session& s) { s.cameras.front().prior.time_offset = KnownNumber{0.0, 1e-3}; }, "prior");
    verifyRejected([](Session& s) { s.recording = "a.bag"; }, "twice");
    verifyRejected([](Session& s) { s.cameras.front().intrinsics->focal_length_px *= 1.01; },
                   "the given lens");
    verifyRejected([](Session& s) { s.cameras.front().intrinsics.reset(); }, "the given lens");
    verifyRejected([](Session& s) { s.cameras.front().intrinsics_uncertainty.emplace().std.setOnes(); },
                   "the given lens");
  }

  void partsOfOneRecording_mayNotOverlap() {
    Session first = sessionNamed("a.bag"), second = first;
    first.time_range_s = {0.0, 10.0};
    second.time_range_s = {10.0, 20.0};
    QCOMPARE(evical::repeatOf({first, second}).names, (std::vector<std::string>{"a", "a_2"}));
    second.time_range_s = {9.0, 20.0};
    QVERIFY_THROWS_EXCEPTION(CalibrationError, evical::repeatOf({first, second}));
  }

  void sensorsInAnotherOrder_areTheSameRig() {
    Session first = simulatePass(2.0, "stereo_two_imus").session, second = first;
    first.recording = "a.bag";
    second.recording = "b.bag";
    std::swap(second.cameras[0], second.cameras[1]);
    std::swap(second.imus[0], second.imus[1]);
    const RepeatInput input = evical::repeatOf({first, second});
    QCOMPARE(input.sessions[1].cameras[0].name, first.cameras[0].name);
    QCOMPARE(input.sessions[1].imus[1].name, first.imus[1].name);
  }

  void files_sayTheSame() {
    QTemporaryDir folder;
    const std::filesystem::path path = folder.path().toStdString();
    const RepeatInput input = evical::repeatOf(
        {sessionNamed("recording1.bag"), sessionNamed("recording2.bag"), sessionNamed("recording3.bag")});
    writeRepeatFiles(path, input, good_, "log");
    const YamlNode yaml = YamlNode::load(path / "repeat.yaml");
    QCOMPARE(yaml["evical_repeat"].integer(1, 1), 1);
    QCOMPARE(yaml["verdict"].text(), std::string("unchanged"));
    QCOMPARE(yaml["quantities"].items().size(), good_.repeatability.quantities.size());
    const NamedResult read = readResultYaml(path / "result.yaml");
    const RigidTransform &pose = read.result->state.cameras.front().reference_from_camera,
                         &joint = good_.joint->result->state.cameras.front().reference_from_camera;
    QVERIFY((pose.translation_m - joint.translation_m).norm() < 1e-9);
    QFile report(QString::fromStdString((path / "report.html").string()));
    QVERIFY(report.open(QIODevice::ReadOnly));
    const QString page = QString::fromUtf8(report.readAll());
    QVERIFY(page.contains("Do 3 recordings give the same calibration?"));
    QVERIFY(page.contains("<svg") && page.contains("plots/quantity1.csv"));
    checkRepeatFolder(path);  // its own earlier result is not an obstacle
    std::filesystem::remove(path / "repeat.yaml");
    QVERIFY_THROWS_EXCEPTION(CalibrationError, checkRepeatFolder(path));
  }
};

EVICAL_TEST(TestRepeatCalibration)
#include "tst_repeat_calibration.moc"
