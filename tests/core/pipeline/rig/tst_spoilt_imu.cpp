// Implausible IMU samples do not reduce the accuracy, and are reported.
#include "core/data/imu_stamps.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/report/report_options.h"
#include "core/report/truth_comparison.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/perturbations.h"
#include "tests/support/scenario_session.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace {

using namespace evical;

using Samples = std::vector<ImuSample>;
using Spoil = std::function<void(Samples&)>;

// At random moments, in both sensors.
Spoil spikes(int count) {
  return [count](Samples& samples) {
    std::mt19937 random(7);
    for (int k = 0; k < count; ++k) {
      ImuSample& sample = samples[samples.size() / 10 + random() % (samples.size() * 8 / 10)];
      sample.angular_rate_rad_s += Eigen::Vector3d(30.0, -20.0, 10.0);
      sample.specific_force_m_s2 += Eigen::Vector3d(-100.0, 150.0, 50.0);
    }
  };
}

void clip(Samples& samples, Eigen::Vector3d ImuSample::*value, double limit) {
  for (ImuSample& sample : samples) sample.*value = (sample.*value).cwiseMax(-limit).cwiseMin(limit);
}

double peakOf(const Samples& samples, Eigen::Vector3d ImuSample::*value) {
  double peak = 0.0;
  for (const ImuSample& sample : samples) peak = std::max(peak, (sample.*value).cwiseAbs().maxCoeff());
  return peak;
}

class TestSpoiltImu : public QObject {
  Q_OBJECT

 private slots:
  void spoiltSamples_areLeftOutAndNamed_data();
  void spoiltSamples_areLeftOutAndNamed();
  void scatteringStamps_areTheFirstReason();
  void coarseStamps_widenTheTimeOffset_data();
  void coarseStamps_widenTheTimeOffset();
};

}  // namespace

Q_DECLARE_METATYPE(Spoil)

namespace {

void TestSpoiltImu::spoiltSamples_areLeftOutAndNamed_data() {
  QTest::addColumn<Spoil>("spoil");
  QTest::addColumn<QString>("note");
  const QString neighbours = "contradict their neighbours";
  QTest::newRow("one spike") << spikes(1) << "1 of \\d+ samples of the gyroscope " + neighbours;
  QTest::newRow("three spikes") << spikes(3) << "3 of \\d+ samples of the accelerometer " + neighbours;
  QTest::newRow("fifty spikes") << spikes(50) << "\\d\\d of \\d+ samples of the accelerometer " + neighbours;
  QTest::newRow("one of the accelerometer")
      << Spoil([](Samples& samples) { samples[samples.size() / 2].specific_force_m_s2.x() += 40.0; })
      << "1 of \\d+ samples of the accelerometer " + neighbours + " \\(at 5\\.\\d+ s\\)";
  // A disturbance so small and so long that only the batch can detect it.
  QTest::newRow("a step of six samples") << Spoil([](Samples& samples) {
    for (std::size_t k = 0; k < 6; ++k) {
      const double ramp = std::sin((static_cast<double>(k) + 1.0) / 7.0 * 3.14159);
      samples[samples.size() / 2 + k].specific_force_m_s2.y() += 6.0 * ramp * ramp;
    }
  }) << "samples of the accelerometer contradict";
  QTest::newRow("accelerometer at its limit")
      << Spoil([](Samples& samples) { clip(samples, &ImuSample::specific_force_m_s2, 11.0); })
      << "specific force . is at its limit of 11 ";
  QTest::newRow("accelerometer values repeated by the driver") << Spoil([](Samples& samples) {
    for (std::size_t k = 0; k < samples.size(); ++k)
      samples[k].specific_force_m_s2 = samples[k - k % 4].specific_force_m_s2;
  }) << "The accelerometer measures at .* but its samples are repeated";
  QTest::newRow("gyroscope at its limit") << Spoil([](Samples& samples) {
    clip(samples, &ImuSample::angular_rate_rad_s, 0.8 * peakOf(samples, &ImuSample::angular_rate_rad_s));
  }) << "angular rate . is at its limit of ";
}

void TestSpoiltImu::spoiltSamples_areLeftOutAndNamed() {
  QFETCH(Spoil, spoil);
  QFETCH(QString, note);
  Scenario scenario = readScenario(test::scenarioPath("davis346"));
  scenario.duration_s = 10.0;
  Session session = test::sessionFor(scenario);
  session.options.report.edit().split_half_check = false;
  DetectionResult detections = test::perfectPass(scenario, 0.05, 0.015);
  spoil(detections.imus.front().samples);
  const CalibrationRun run = calibrate(session, std::move(detections), RunContext{});
  QString notes;
  for (const std::string& each : run.result.notes) notes += QString::fromStdString(each) + "\n";
  QVERIFY2(notes.contains(QRegularExpression(note)), qPrintable(notes));
  const TruthComparison comparison = compareWithTruth(
      namedResult(session, std::make_shared<CalibrationResult>(run.result), "test"), test::truthOf(scenario));
  for (const QuantityDifference& quantity : comparison.quantities) {
    QVERIFY2(std::abs(quantity.normalised()) <= 3.5,
             qPrintable(QString("%1: error %2, sigma %3\n%4")
                            .arg(QString::fromStdString(quantity.name))
                            .arg(quantity.difference)
                            .arg(quantity.sigma)
                            .arg(notes)));
  }
}

// Residuals beyond the noise density and large sigmas are only symptoms.
void TestSpoiltImu::scatteringStamps_areTheFirstReason() {
  test::Recorded recorded;
  recorded.scenario = readScenario(test::scenarioPath("davis346_10s"));
  recorded.scenario.imus.front().rate_hz = 200.0;
  recorded.session = test::sessionFor(recorded.scenario);
  recorded.detections = test::perfectPass(recorded.scenario, 0.05, 0.015);
  test::perturbation("stamp jitter").apply(recorded, 5.0);
  const CalibrationRun run = calibrate(recorded.session, recorded.detections, RunContext{});
  const QString reason = QString::fromStdString(run.result.reason);
  QVERIFY(run.result.status == CalibrationStatus::Doubtful);
  QVERIFY2(reason.contains(QRegularExpression("^[^;]*: Sample intervals scatter by ")), qPrintable(reason));
}

void TestSpoiltImu::coarseStamps_widenTheTimeOffset_data() {
  QTest::addColumn<double>("rate_hz");
  QTest::addColumn<double>("step_ms");
  QTest::addColumn<double>("part");  // of a step that is added before stamps are rounded down
  for (const auto& [name, part] : {std::pair("down", 0.0), std::pair("nearest", 0.5), std::pair("up", 1.0)}) {
    QTest::addRow("10 ms at 200 Hz, %s", name) << 200.0 << 10.0 << part;
    QTest::addRow("1 ms at 1 kHz, %s", name) << 1000.7 << 1.0 << part;
  }
  QTest::newRow("4 ms at 200 Hz, down") << 200.0 << 4.0 << 0.0;
}

void TestSpoiltImu::coarseStamps_widenTheTimeOffset() {
  QFETCH(double, rate_hz);
  QFETCH(double, step_ms);
  QFETCH(double, part);
  test::Recorded recorded;
  recorded.scenario = readScenario(test::scenarioPath("davis346_10s"));
  recorded.scenario.imus.front().rate_hz = rate_hz;
  recorded.session = test::sessionFor(recorded.scenario);
  recorded.session.options.report.edit().split_half_check = false;
  recorded.detections = test::perfectPass(recorded.scenario, 0.05, 0.015);
  const std::int64_t step_ns = std::llround(1e6 * step_ms);
  ImuData& imu = recorded.detections.imus.front();
  for (ImuSample& sample : imu.samples) {
    const std::int64_t shifted_ns = sample.time_ns + std::llround(part * static_cast<double>(step_ns));
    sample.time_ns = shifted_ns - shifted_ns % step_ns;
  }
  recorded.detections.imu_stamp_steps_s = {
      putInOrder("/imu", imu.samples.front().time_ns, imu.samples, recorded.detections.faults)};
  const CalibrationRun run = calibrate(recorded.session, recorded.detections, RunContext{});
  QString notes;
  for (const std::string& each : run.result.notes) notes += QString::fromStdString(each) + "\n";
  QVERIFY2(notes.contains(QString("steps of %1 ms").arg(step_ms)), qPrintable(notes));
  const bool doubtful = run.result.status == CalibrationStatus::Doubtful;
  QVERIFY(doubtful);  // half a step is more than the offset may be uncertain by
  QVERIFY2(run.result.reason.find("time stamps of left_imu have steps of") == std::size_t{4},
           run.result.reason.c_str());
  const TruthComparison comparison =
      compareWithTruth(namedResult(recorded.session, std::make_shared<CalibrationResult>(run.result), "test"),
                       test::truthOf(recorded.scenario));
  for (const QuantityDifference& quantity : comparison.quantities)
    QVERIFY2(std::abs(quantity.normalised()) < 3.0, qPrintable(QString("%1: error %2, sigma %3")
                                                                   .arg(QString::fromStdString(quantity.name))
                                                                   .arg(quantity.difference)
                                                                   .arg(quantity.sigma)));
}

}  // namespace

EVICAL_TEST(TestSpoiltImu)
#include "tst_spoilt_imu.moc"
