// One deviation from the session at a time: the result is not called ok if it is wrong, and the first reason
// names the deviation. Circles are those of an ideal front end, so that a case takes a second or two.
#include "core/optimisation/optimisation_options.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/rig/misfit_diagnosis.h"
#include "core/pipeline/rig/residual_consistency.h"
#include "core/pipeline/runs/result_files.h"
#include "core/report/report_options.h"
#include "core/report/truth_comparison.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/perturbations.h"
#include "tests/support/scenario_session.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

namespace {

using namespace evical;

class TestCauses : public QObject {
  Q_OBJECT

 private slots:
  void initTestCase() {
    base_.scenario = readScenario(test::scenarioPath("davis346_10s"));
    base_.session = test::sessionFor(base_.scenario);
    base_.session.options.report.edit().split_half_check = false;  // half of the time, and not tested here
    base_.detections = test::perfectPass(base_.scenario, 0.05, 0.02);
  }

  void firstReason_namesTheCause_data() {
    QTest::addColumn<QString>("name");
    QTest::addColumn<double>("size");
    QTest::addColumn<bool>("fails");  // otherwise it is doubtful
    const auto row = [](const char* name, double size, bool fails) {
      QTest::addRow("%s %g", name, size) << QString(name) << size << fails;
    };
    row("both mirrored", 1, true);
    row("both swapped", 1, true);
    row("gyroscope swapped", 1, true);
    row("gyroscope mirrored", 0, true);
    row("gyroscope permuted", 1, true);
    row("forces negated", 1, true);
    row("image mirrored in x", 1, true);
    row("image mirrored in y", 1, true);
    row("image transposed", 1, true);
    row("rates negated", 1, true);
    row("gyroscope dead", 0, true);
    row("accelerometer dead", 2, true);
    row("another IMU", 1, true);
    row("clock step", 50, false);
    row("board spacing", 2, false);
    row("board stretch", 1, false);
    row("forces clipped", 9, false);
    row("board spacing", -2.5, false);
    row("gyroscope turned", 1, false);
    row("gyroscope turned", 0.3, false);
    row("batches", 5, true);
    row("batches", 50, true);
    row("prior of rotation", 20, false);
    row("prior of time offset", 10, false);
    row("camera moved", 0.2, false);
    row("camera moved", 5, false);
    row("wandering noise", 0.01, false);
    row("walking biases", 1e-3, false);
  }
  void firstReason_namesTheCause() {
    QFETCH(QString, name);
    QFETCH(double, size);
    QFETCH(bool, fails);
    const test::Perturbation& perturbation = test::perturbation(name.toStdString());
    test::Recorded recorded = withoutAutomaticOptions();
    perturbation.apply(recorded, size);
    std::string reason;
    try {
      const CalibrationRun run = calibrate(recorded.session, recorded.detections, RunContext{});
      QVERIFY(!fails);
      QCOMPARE(run.result.status, CalibrationStatus::Doubtful);
      reason = run.result.reason;
    } catch (const CalibrationError& error) {
      QVERIFY2(fails, error.what());
      reason = error.what();
    }
    QVERIFY2(perturbation.isNamedIn(test::firstReason(reason)), reason.c_str());
  }

  // An input that is wrong by a factor is the first reason, with the value that would agree, and none of its
  // consequences is listed.
  void wrongInput_isTheOnlyReason_data() {
    QTest::addColumn<QString>("name");
    QTest::addColumn<double>("size");
    QTest::addColumn<QString>("says");
    const auto row = [](const char* name, double size, const char* says) {
      QTest::addRow("%s %g", name, size) << QString(name) << size << QString(says);
    };
    row("rates times", 57.29578, "unit seems to be deg/s.*angular_rate_unit: deg/s");
    row("rates times", 1.0 / 57.29578, "57.* times too small.*seems to be rad/s.*angular_rate_unit: rad/s");
    row("rates times", 1e3, "mrad/s.*0.001 rad/s|seems to be deg/s");
    row("rates times", 0.0572958, "17.* times too small.*deg/ms.*angular_rate_unit: 1000 deg/s");
    row("rates times", 2.0,
        "(2|1.9\\d|2.0\\d) times too large.*measuring range.*angular_rate_unit: 0.(49|50)\\d* rad/s");
    row("rates times", 0.5, "(2|1.9\\d|2.0\\d) times too small.*measuring range");
    row("forces times", 9.80665, "norm .* is 9\\d.*unit seems to be m/s\\^2");
    row("forces times", 1e3, "unit seems to be mm/s\\^2.*acceleration_unit: 0.001 m/s\\^2");
    row("forces times", 1e3 / 9.80665, "unit seems to be mg or cm/s\\^2.*acceleration_unit: 0.001 g");
    row("forces times", 1.0 / 9.80665, "unit seems to be g.*acceleration_unit: g");
    row("forces times", 2.0, "norm of the accelerations is (19|20).*measuring range");
    row("stated noise", 1e4,
        "gyroscope_noise_density .*e\\+0[34] times too large.*have about 0.0001[89].*data sheet");
    row("stated noise", 1e3, "gyroscope_noise_density .*times too large.*have about 0.0001[89]");
    row("stated noise", 1e-2, "gyroscope_noise_density .*times too small.*have about 0.0001[89].*data sheet");
    row("stated noise", 1e-3, "gyroscope_noise_density .*times too small");
    row("board spacing alone", 900,
        "spacing_m .0.5 m. is (9.|10).* times too large: accelerations agree with about 0.05");
    row("board spacing alone", 100,
        "spacing_m .0.1 m. is (1.9|2).* times too large: accelerations agree with about 0.05");
    row("board spacing alone", -50,
        "spacing_m .0.025 m. is (1.9|2).* times too small: accelerations agree with about 0.05");
    row("focal length", 100,
        "left: the given lens differs.*26\\d.* px agree.*2 times too large.*Remove intrinsics");
    row("focal length", -50,
        "left: the given lens differs.*26\\d.* px agree.*2 times too small.*Remove intrinsics");
    row("sensors exchanged", 1, "rates have the norm of gravity.*seem to be exchanged.*Exchange them");
    row("clock drift", 1e4, "clocks of left and left_imu differ by (0.9\\d|1) %.*left_imu.clock_scale: 0.99");
    row("clock drift", -5e3,
        "clocks of left and left_imu differ by 0.(4|5)\\d* %.*left_imu.clock_scale: 1.00[45]");
    row("accelerometer late", 25,
        "left_imu: the accelerometer's samples seem to be 2[3-7] ms later.*accelerometer_delay_sigma_s: 0.1");
    row("gyroscope at rest", 1, "left_imu: the IMU is at rest while left turns.*files belong together");
    row("rates clipped", 0.4, "left_imu: angular rate . is saturated in .*measuring range");
    row("distortion", -1, "left: the given lens differs.*distortion.*Remove intrinsics");
  }
  void wrongInput_isTheOnlyReason() {
    QFETCH(QString, name);
    QFETCH(double, size);
    QFETCH(QString, says);
    test::Recorded recorded = base_;
    test::perturbation(name.toStdString()).apply(recorded, size);
    QString reason;
    try {
      const CalibrationRun run = calibrate(recorded.session, recorded.detections, RunContext{});
      QCOMPARE(run.result.status, CalibrationStatus::Doubtful);
      reason = QString::fromStdString(run.result.reason);
    } catch (const CalibrationError& error) {
      reason = error.what();
    }
    QVERIFY2(reason.contains(QRegularExpression(says)), qPrintable(reason));
    for (const char* consequence :
         {"ecord again", "ecord longer", "not flat", "pixels are slow", "has a sigma of"})
      QVERIFY2(!reason.contains(consequence), qPrintable(reason));
  }
  void reasons_areRankedInOnePlace() {
    CalibrationResult result;
    flagDoubtful("weak", result, "observability");
    flagDoubtful("misfit", result, "misfit");
    flagDoubtful("late stamps", result, "stamp_jitter");
    rankReasons(result);
    QCOMPARE(QString::fromStdString(result.reason), QString("late stamps; misfit; weak"));
    CalibrationResult noise = result;
    flagDoubtful("noise", noise, "noise_density");  // too large: it explains weak results only
    rankReasons(noise);
    QCOMPARE(QString::fromStdString(noise.reason), QString("late stamps; noise; misfit"));
    flagDoubtful("spacing", result, "board_dimensions");
    flagDoubtful("lens", result, "given_lens");
    flagDoubtful("clock", result, "clock_rate");
    flagDoubtful("unit", result, "unit");
    rankReasons(result);
    QCOMPARE(QString::fromStdString(result.reason), QString("unit; clock; late stamps"));
  }
  // The weights use the estimate, so that the result may be ok: then the density is the first note.
  void noiseTooLarge_isNamedInAnyVerdict() {
    test::Recorded recorded = base_;
    test::perturbation("stated noise").apply(recorded, 30.0);
    const CalibrationResult result = calibrate(recorded.session, recorded.detections, RunContext{}).result;
    QVERIFY(!result.notes.empty());
    const QString text =
        QString::fromStdString(result.status == CalibrationStatus::Ok ? result.notes.front() : result.reason);
    QVERIFY2(text.contains(QRegularExpression("noise_density .*30.* times too large|noise_density .*29")),
             qPrintable(text));
  }

  // Seed 3 rotates more about one axis than about the others, and a mirrored gyroscope leaves a third
  // unexplained.
  void leftHandedAxes_areNamedWhereOneAxisOutweighs() {
    test::Recorded other = base_;
    other.scenario.seed = 3;
    other.detections = test::perfectPass(other.scenario, 0.05, 0.02);
    for (const char* name : {"both mirrored", "gyroscope swapped", "rates negated"}) {
      test::Recorded recorded = other;
      const test::Perturbation& perturbation = test::perturbation(name);
      perturbation.apply(recorded, 1.0);
      try {
        calibrate(recorded.session, recorded.detections, RunContext{});
        QFAIL(name);
      } catch (const CalibrationError& error) {
        QVERIFY2(perturbation.isNamedIn(test::firstReason(error.what())), error.what());
      }
    }
  }

  // Weak data have a reason then.
  void log_thatEndsEarly_isTold() {
    test::Recorded recorded = base_;
    std::vector<ImuSample>& samples = recorded.detections.imus.front().samples;
    samples.resize(samples.size() / 2);
    const CalibrationResult result = calibrate(recorded.session, recorded.detections, RunContext{}).result;
    const auto told = std::ranges::count_if(result.notes, [](const std::string& note) {
      return note.find("left_imu: its samples cover 5.0 s, those of left ") == 0;
    });
    QCOMPARE(told, 1);
  }

  // The initial board scale uses accelerations at their stamps: in seed 5 the board seems 3 % smaller.
  void lateAccelerometer_isNoWrongBoard() {
    test::Recorded recorded = base_;
    recorded.scenario.seed = 5;
    recorded.detections = test::perfectPass(recorded.scenario, 0.05, 0.02);
    test::perturbation("accelerometer late").apply(recorded, 5.0);
    const CalibrationRun run = calibrate(recorded.session, recorded.detections, RunContext{});
    QVERIFY2(run.result.status == CalibrationStatus::Ok, run.result.reason.c_str());
    expectRight(recorded, run);
  }

  // Deviations that are estimated with a sigma are corrected instead of reported.
  void whatIsAnUnknown_isRepaired_data() {
    QTest::addColumn<QString>("name");
    QTest::addColumn<double>("size");
    const auto row = [](const char* name, double size) {
      QTest::addRow("%s %g", name, size) << QString(name) << size;
    };
    row("board spacing", 0.5);
    row("board spacing", -0.5);
    row("board stretch", 0.25);
    row("board stretch", 0.5);
    row("board bow", 0.5);
    row("board bow", 2);
    row("gravity", 9.78);
    row("focal length", 0.3);
    row("focal length", 1);
    row("focal length x", 1);
    row("centre", 2);
    row("distortion", 0.9);
    row("clock drift", 50);
  }
  void whatIsAnUnknown_isRepaired() {
    QFETCH(QString, name);
    QFETCH(double, size);
    test::Recorded recorded = base_;
    test::perturbation(name.toStdString()).apply(recorded, size);
    const CalibrationRun run = calibrate(recorded.session, recorded.detections, RunContext{});
    QVERIFY2(run.result.status == CalibrationStatus::Ok, run.result.reason.c_str());
    expectRight(recorded, run);
  }

  // A repair that is given as data is applied, and is correct.
  void repair_mendsIt_data() {
    QTest::addColumn<QString>("name");
    QTest::addColumn<double>("size");
    QTest::addColumn<QString>("repair");
    const auto row = [](const char* name, double size, const char* repair) {
      QTest::addRow("%s %g", name, size) << QString(name) << size << QString(repair);
    };
    row("forces in g", 1, "imus.left_imu.acceleration_unit=g");
    row("rates in deg/s", 1, "imus.left_imu.angular_rate_unit=deg/s");
    row("rates negated", 1, "imus.left_imu.gyroscope_axes=-x,-y,-z");
    row("gyroscope swapped", 1, "imus.left_imu.gyroscope_axes=y,x,z");
    row("gyroscope mirrored", 2, "imus.left_imu.gyroscope_axes=x,y,-z");
    row("gyroscope permuted", 1, "imus.left_imu.gyroscope_axes=z,x,y");
    row("gyroscope turned", 1, "optimisation.model.gyroscope_rotation=true");
    row("accelerometer late", 25, "optimisation.priors.accelerometer_delay_sigma_s=0.1");
  }
  void repair_mendsIt() {
    QFETCH(QString, name);
    QFETCH(double, size);
    test::Recorded recorded = withoutAutomaticOptions();
    test::perturbation(name.toStdString()).apply(recorded, size);
    const std::optional<Repair> repair = repairOf(recorded);
    QVERIFY(repair);
    QTEST(QString::fromStdString(repair->text()), "repair");
    setInSession(recorded.session, repair->key, repair->value);
    const SessionImu& imu = recorded.session.imus[0];
    for (ImuSample& sample :
         recorded.detections.imus[0].samples) {  // which were converted by the session before
      sample.angular_rate_rad_s =
          readAs(imu.gyroscope_axes, sample.angular_rate_rad_s) *
          radiansPerSecond(imu.angular_rate_unit.value_or(AngularRateUnit::RadiansPerSecond));
      sample.specific_force_m_s2 =
          readAs(imu.accelerometer_axes, sample.specific_force_m_s2) *
          metresPerSecond2(imu.acceleration_unit.value_or(AccelerationUnit::MetresPerSecond2));
    }
    const CalibrationRun run = calibrate(recorded.session, recorded.detections, RunContext{});
    QVERIFY(!run.result.repair);
    expectRight(recorded, run);
  }

  // Clock offsets of several seconds are found, and everything else is unchanged.
  void timeOffsetBeyondTheSearch_isFound() {
    test::Recorded recorded = base_;
    test::perturbation("time offset").apply(recorded, 5.0);
    const CalibrationRun run = calibrate(recorded.session, recorded.detections, RunContext{});
    QVERIFY2(run.result.status == CalibrationStatus::Ok, run.result.reason.c_str());
    expectRight(recorded, run);
  }

  // The part that the repair keeps is ok or too short to be ok, and correct.
  void cameraThatMoved_isRightInTheLargerPart() {
    test::Recorded recorded = base_;
    test::perturbation("camera moved").apply(recorded, 1.0);
    const std::optional<Repair> repair = repairOf(recorded);
    QVERIFY(repair);
    setInSession(recorded.session, repair->key, repair->value);
    const std::array<double, 2> range_s = recorded.session.time_range_s.value();
    constexpr double kMoved_s = 6.0;
    QVERIFY2(range_s[0] < 0.5 && range_s[1] > kMoved_s - 1.5 && range_s[1] < kMoved_s,
             repair->text().c_str());
    test::cutTo(range_s, recorded);
    expectRight(recorded, calibrate(recorded.session, recorded.detections, RunContext{}));
  }

  // A hundred times as fast as assumed: the sigmas account for the rest.
  void walkingBiases_areRepaired() {
    test::Recorded recorded = base_;
    test::perturbation("walking biases").apply(recorded, 1e-3);
    const CalibrationRun run = calibrate(recorded.session, recorded.detections, RunContext{});
    QVERIFY(!run.result.repair);
    QCOMPARE(freedBy(run), QStringList{"optimisation.model.bias_model=linear"});
    const double sigmas = comparisonOf(recorded, run).normalisedRms();
    QVERIFY2(sigmas < 2.5, qPrintable(QString::number(sigmas)));
  }

  // A parameter that is certainly needed is estimated without asking, and the result lists it.
  void misalignedGyroscope_isEstimated_data() {
    QTest::addColumn<double>("size_deg");
    for (const double size_deg : {0.3, 1.0, 3.0}) QTest::addRow("%g deg", size_deg) << size_deg;
  }
  void misalignedGyroscope_isEstimated() {
    QFETCH(double, size_deg);
    test::Recorded recorded = base_;
    test::perturbation("gyroscope turned").apply(recorded, size_deg);
    const CalibrationRun run = calibrate(recorded.session, recorded.detections, RunContext{});
    QVERIFY2(run.result.status == CalibrationStatus::Ok, run.result.reason.c_str());
    QCOMPARE(freedBy(run), QStringList{"optimisation.model.gyroscope_rotation=true"});
    expectRight(recorded, run);
  }
  void nothingSpoilt_freesNothing() {
    QVERIFY(calibrate(base_.session, base_.detections, RunContext{}).result.freed.empty());
  }

  // If a clock steps, the larger part is used, and the result is correct.
  void clockThatSteps_isRightInTheLargerPart() {
    test::Recorded recorded = base_;
    test::perturbation("clock step").apply(recorded, 50.0);
    expectRight(recorded, calibrate(recorded.session, recorded.detections, RunContext{}));
  }

  // A bow of a board that is assumed flat is found by the score test and, for the larger bow, by a trial.
  void bentBoardTakenForFlat_isTheFirstReason() {
    for (const double height_mm : {0.5, 2.0}) {
      test::Recorded recorded = base_;
      const test::Perturbation& bow = test::perturbation("board bow");
      bow.apply(recorded, height_mm);
      recorded.session.options.optimisation.edit().board_bow = false;
      const CalibrationRun run = calibrate(recorded.session, recorded.detections, RunContext{});
      QCOMPARE(run.result.status, CalibrationStatus::Doubtful);
      QVERIFY2(bow.isNamedIn(test::firstReason(run.result.reason)), run.result.reason.c_str());
    }
  }

  void nothingSpoilt_isOk() {
    const CalibrationRun run = calibrate(base_.session, base_.detections, RunContext{});
    QVERIFY2(run.result.status == CalibrationStatus::Ok, run.result.reason.c_str());
    expectRight(base_, run);
  }

 private:
  test::Recorded withoutAutomaticOptions() const {
    test::Recorded recorded = base_;
    recorded.session.options.optimisation.edit().gyroscope_rotation = Estimated::No;
    recorded.session.options.optimisation.edit().bias_model = BiasModel::Constant;
    return recorded;
  }
  static QStringList freedBy(const CalibrationRun& run) {
    QStringList options;
    for (const QualityWarning& freed : run.result.freed)
      options << QString::fromStdString(freed.repair->text());
    return options;
  }
  static std::optional<Repair> repairOf(const test::Recorded& recorded) {
    try {
      return calibrate(recorded.session, recorded.detections, RunContext{}).result.repair;
    } catch (const CalibrationError& error) {
      return error.repair();
    }
  }
  static TruthComparison comparisonOf(const test::Recorded& recorded, const CalibrationRun& run) {
    return compareWithTruth(
        namedResult(recorded.session, std::make_shared<CalibrationResult>(run.result), "test"),
        test::truthOf(recorded.scenario));
  }
  void expectRight(const test::Recorded& recorded, const CalibrationRun& run) const {
    const TruthComparison comparison = comparisonOf(recorded, run);
    const CameraError& error = comparison.cameras.front();
    QVERIFY2(error.rotation_deg < 0.1, qPrintable(QString::number(error.rotation_deg)));
    QVERIFY2(error.translation_mm < 3.0, qPrintable(QString::number(error.translation_mm)));
    QVERIFY2(error.time_offset_ms < 1.0, qPrintable(QString::number(error.time_offset_ms)));
  }

  test::Recorded base_;
};

}  // namespace

EVICAL_TEST(TestCauses)
#include "tst_misfit_diagnosis.moc"
