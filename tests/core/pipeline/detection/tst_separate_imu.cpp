// Gyroscope and accelerometer as separate streams, with different rates and times: as accurate as joint
// messages.
#include "core/base/error.h"
#include "core/initialisation/agreement_check.h"
#include "core/pipeline/maintain/imu_logs.h"
#include "core/pipeline/rig/calibration_pipeline.h"
#include "core/pipeline/runs/result_files.h"
#include "core/pipeline/session/session_guess.h"
#include "core/pipeline/session/session_keys.h"
#include "core/recording/conversion.h"
#include "core/recording/recording_writer.h"
#include "core/recording/separate_imu.h"
#include "core/report/report_options.h"
#include "core/report/truth_comparison.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/support/scenario_session.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <cmath>
#include <fstream>
#include <sstream>

using namespace evical;

namespace {

const std::string kGyroscope = "/camera/gyro/sample", kAccelerometer = "/camera/accel/sample",
                  kBoth = "/camera/imu";

using Samples = std::vector<ImuSample>;

// From 1000 Hz: 200 Hz of rates, 62.5 Hz of specific forces, never at the same time.
Samples ratesOf(const Samples& all) {
  Samples rates;
  for (std::size_t i = 0; i < all.size(); i += 5) rates.push_back(all[i]);
  for (ImuSample& sample : rates) sample.measured_by = MeasuredBy::Gyroscope;
  return rates;
}
Samples forcesOf(const Samples& all) {
  Samples forces;
  for (std::size_t i = 3; i + 1 < all.size(); i += 16) forces.push_back(all[i % 5 == 0 ? i + 1 : i]);
  for (ImuSample& sample : forces) sample.measured_by = MeasuredBy::Accelerometer;
  return forces;
}

Samples inOrder(Samples a, const Samples& b) {
  a.insert(a.end(), b.begin(), b.end());
  std::ranges::stable_sort(a, {}, &ImuSample::time_ns);
  return a;
}

StreamInfo imuStream(const std::string& name) {
  StreamInfo info;
  info.name = name;
  info.type = StreamType::Imu;
  return info;
}

Samples readStream(RecordingReader& reader, const std::string& name) {
  const std::size_t stream = findStream(reader, name, StreamType::Imu);
  reader.select({stream});
  Samples samples;
  Packet packet;
  while (reader.read(packet))
    toSi(packet.imu_samples, AccelerationUnit::MetresPerSecond2, AngularRateUnit::RadiansPerSecond, samples);
  return samples;
}

double gapBetween(const ImuSample& a, const ImuSample& b) {
  return std::max((a.angular_rate_rad_s - b.angular_rate_rad_s).norm(),
                  (a.specific_force_m_s2 - b.specific_force_m_s2).norm());
}

}  // namespace

class TestSeparateImu : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;
  Scenario scenario_;
  DetectionResult pass_;

  std::filesystem::path path(const std::string& name) const {
    return folder_.filePath(name.c_str()).toStdString();
  }
  const Samples& all() const { return pass_.imus.front().samples; }

  void writeTwoTopics() {
    const auto bag = createBag(path("two.bag"), {imuStream(kGyroscope), imuStream(kAccelerometer)}, false);
    for (const ImuSample& sample : inOrder(ratesOf(all()), forcesOf(all())))
      bag->write(sample.measured_by == MeasuredBy::Gyroscope ? 0 : 1, std::span(&sample, 1));
    bag->finish();
  }
  void writeOneTopic() {
    const auto bag = createBag(path("one.bag"), {imuStream(kBoth)}, false);
    for (const ImuSample& sample : inOrder(ratesOf(all()), forcesOf(all())))
      bag->write(0, std::span(&sample, 1));
    bag->finish();
  }
  Samples readTwoTopics() const {
    const auto reader = withSeparateImus(openRecording(path("two.bag")), {{kGyroscope, kAccelerometer}});
    return readStream(*reader, nameOf({kGyroscope, kAccelerometer}));
  }

 private slots:
  void init() {
    scenario_ = readScenario(test::scenarioPath("davis346"));
    scenario_.duration_s = 10.0;
    pass_ = test::perfectPass(scenario_, 0.05, 0.015);
  }

  void topics_areJoinedInOrderOfTime() {
    writeTwoTopics();
    const Samples read = readTwoTopics(), expected = inOrder(ratesOf(all()), forcesOf(all()));
    QCOMPARE(read.size(), expected.size());
    double furthest = 0.0;
    for (std::size_t i = 0; i < read.size(); ++i) {
      QCOMPARE(qint64(read[i].time_ns), qint64(expected[i].time_ns));
      QVERIFY(read[i].measured_by == expected[i].measured_by);
      if (read[i].measured_by == MeasuredBy::Gyroscope)
        QVERIFY(read[i].angular_rate_rad_s == expected[i].angular_rate_rad_s);
      else
        QVERIFY(read[i].specific_force_m_s2 == expected[i].specific_force_m_s2);
      if (i > 16 && i + 16 < read.size()) furthest = std::max(furthest, gapBetween(read[i], expected[i]));
    }
    QVERIFY2(furthest < 0.6, qPrintable(QString::number(furthest)));  // the interpolated values
  }

  void oneTopic_isTakenApart() {
    writeTwoTopics();
    writeOneTopic();
    const auto reader = withSeparateImus(openRecording(path("one.bag")), {{kBoth, kBoth}});
    const Samples read = readStream(*reader, nameOf({kBoth, kBoth})), expected = readTwoTopics();
    QCOMPARE(read.size(), expected.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
      QVERIFY(read[i].measured_by == expected[i].measured_by);
      QVERIFY(gapBetween(read[i], expected[i]) == 0.0);
    }
  }

  // The other sensor's values are then the last ones, and only the covariance marks them.
  void staleNumbers_areTakenApartByTheirCovariances() {
    std::vector<RawImuSample> raw(2);
    for (RawImuSample& sample : raw) {
      sample.angular_rate = {0.1, 0.2, 0.3};
      sample.specific_force = {0.0, 0.0, 9.8};
    }
    raw[0].measured_by = MeasuredBy::Gyroscope;
    raw[1].measured_by = MeasuredBy::Accelerometer;
    QVERIFY(lacksForce(raw[0]) && !lacksRate(raw[0]));
    QVERIFY(lacksRate(raw[1]) && !lacksForce(raw[1]));
  }

  void init_proposesBothStreams_data() {
    QTest::addColumn<QString>("bag");
    QTest::addColumn<QString>("gyroscope");
    QTest::addColumn<QString>("accelerometer");
    QTest::addColumn<QString>("name");
    QTest::newRow("two topics") << "two.bag"
                                << "/camera/gyro/sample"
                                << "/camera/accel/sample"
                                << "camera_imu";
    QTest::newRow("one topic") << "one.bag"
                               << "/camera/imu"
                               << "/camera/imu"
                               << "camera_imu";
  }
  void init_proposesBothStreams() {
    QFETCH(QString, bag);
    QFETCH(QString, gyroscope);
    QFETCH(QString, accelerometer);
    QFETCH(QString, name);
    writeTwoTopics();
    writeOneTopic();
    const auto reader = openRecording(path(bag.toStdString()));
    const Inspection inspection = inspectRecording(*reader);
    for (const RecordingFault& fault : inspection.faults)  // the forces' times are on a grid of 1 ms
      QVERIFY2(fault.kind == FaultKind::Encoding, fault.text.c_str());
    Session session = guessedSession(path(bag.toStdString()), inspection);
    QCOMPARE(session.imus.size(), std::size_t{1});
    QCOMPARE(QString::fromStdString(session.imus[0].stream), gyroscope);
    QCOMPARE(QString::fromStdString(session.imus[0].accelerometer_stream), accelerometer);
    QCOMPARE(QString::fromStdString(session.imus[0].name), name);
    // The same in a file.
    session.cameras = test::sessionFor(scenario_).cameras;
    const Session again = written(session);
    QCOMPARE(again.imus[0].stream, session.imus[0].stream);
    QCOMPARE(again.imus[0].accelerometer_stream, session.imus[0].accelerometer_stream);
  }

  // Each sensor has separate stamps and residuals: pairs of stamps 20 us apart are not batches.
  void equalRates_areNoBatches() {
    ImuData imu = pass_.imus.front();
    imu.samples.clear();
    for (std::size_t i = 0; i < 2000; i += 5) {
      imu.samples.push_back(all()[i]);
      imu.samples.back().measured_by = MeasuredBy::Gyroscope;
      imu.samples.push_back(all()[i]);
      imu.samples.back().measured_by = MeasuredBy::Accelerometer;
      imu.samples.back().time_ns += 20'000;
    }
    for (const std::size_t left_out : {std::size_t{0}, std::size_t{1}}) {
      imu.samples.resize(imu.samples.size() - left_out);
      checkStampsApart(imu);
      QVERIFY(std::abs(imu.rate_hz() - 200.0) < 0.1);
      QVERIFY(std::abs(imu.accelerometerRate_hz() - 200.0) < 0.1);
    }
  }

  // A message's flag for a missing measurement counts only in sessions that name the streams: conversions
  // keep the values.
  void conversion_keepsValuesBehindACovarianceOfMinusOne() {
    ImuSample sample = all().front();
    sample.measured_by = MeasuredBy::Gyroscope;
    const auto bag = createBag(path("claim.bag"), {imuStream(kBoth)}, false);
    bag->write(0, std::span(&sample, 1));
    bag->finish();
    ConversionRequest request;
    request.input = path("claim.bag");
    request.output = path("claim.mcap");
    convertRecording(request, RunContext{});
    const Samples read = readStream(*openRecording(path("claim.mcap")), kBoth);
    QCOMPARE(read.size(), std::size_t{1});
    QVERIFY(read[0].measured_by == MeasuredBy::Gyroscope);
    QVERIFY(gapBetween(read[0], sample) == 0.0);
  }

  // A log with the name of the IMU then has three streams, of which one is the IMU.
  void logCalledLikeTheImu_isTheJoinedStream() {
    writeTwoTopics();
    std::filesystem::rename(path("two.bag"), path("left_imu.bag"));
    NamedResult before;
    before.imus.push_back({});
    before.imus.back().name = "left_imu";
    before.imus.back().stream = nameOf({kGyroscope, kAccelerometer});
    ImuReadings readings;
    readings["left_imu"].stream = kGyroscope;
    readings["left_imu"].accelerometer_stream = kAccelerometer;
    ImuLogs logs({path("left_imu.bag")}, before, {}, readings, {});
    std::size_t rates = 0, forces = 0;
    SensorPacket packet;
    while (logs.read(packet))
      for (const ImuSample& sample : packet.imu_samples) {
        QVERIFY(sample.measured_by != MeasuredBy::Both);
        (sample.measured_by == MeasuredBy::Gyroscope ? rates : forces) += 1;
      }
    QCOMPARE(rates, ratesOf(all()).size());
    QCOMPARE(forces, forcesOf(all()).size());
  }

  void exchangedOrApartStreams_areSaid_data() {
    QTest::addColumn<bool>("exchanged");
    QTest::addColumn<QString>("problem");
    QTest::newRow("exchanged") << true << "has no measurements of the gyroscope";
    QTest::newRow("apart in time") << false << "overlap for only 0.00 s";
  }
  void exchangedOrApartStreams_areSaid() {
    QFETCH(bool, exchanged);
    QFETCH(QString, problem);
    Session session = test::sessionFor(scenario_);
    session.imus[0].stream = exchanged ? kAccelerometer : kGyroscope;
    session.imus[0].accelerometer_stream = exchanged ? kGyroscope : kAccelerometer;
    Samples rates = ratesOf(all()), forces = forcesOf(all());
    for (ImuSample& sample : rates) {
      if (!exchanged) continue;
      sample.measured_by = MeasuredBy::Accelerometer;
      sample.specific_force_m_s2.setZero();
      sample.angular_rate_rad_s.setZero();
    }
    for (ImuSample& sample : forces) {
      if (exchanged) sample.measured_by = MeasuredBy::Gyroscope;
      sample.angular_rate_rad_s.setZero();
      if (!exchanged) sample.time_ns += 20'000'000'000;
    }
    pass_.imus.front().samples = inOrder(rates, forces);
    try {
      calibrate(session, pass_, RunContext{});
      QFAIL("it was not refused");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains(problem), error.what());
    }
  }

  // Four recordings: each error within 3.5 sigmas, and their RMS in agreement with the sigmas.
  void calibration_isAsAccurateAsItsSigmasSay() {
    double squares = 0.0, count = 0.0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      scenario_.seed = seed;
      pass_ = test::perfectPass(scenario_, 0.05, 0.015);
      writeTwoTopics();
      Session session = test::sessionFor(scenario_);
      session.options.report.edit().split_half_check = false;
      session.imus[0].stream = kGyroscope;
      session.imus[0].accelerometer_stream = kAccelerometer;
      pass_.imus.front().samples = readTwoTopics();
      const CalibrationRun run = calibrate(session, pass_, RunContext{});
      const TruthComparison comparison =
          compareWithTruth(namedResult(session, std::make_shared<CalibrationResult>(run.result), "test"),
                           test::truthOf(scenario_));
      for (const QuantityDifference& quantity : comparison.quantities) {
        QVERIFY2(std::abs(quantity.normalised()) <= 3.5,
                 qPrintable(QString("%1: error %2, sigma %3")
                                .arg(QString::fromStdString(quantity.name))
                                .arg(quantity.difference)
                                .arg(quantity.sigma)));
        squares += quantity.normalised() * quantity.normalised();
        count += 1.0;
      }
      QVERIFY2(comparison.cameras[0].rotation_deg < 0.1,
               qPrintable(QString::number(comparison.cameras[0].rotation_deg)));
      QVERIFY2(comparison.cameras[0].translation_mm < 4.0,
               qPrintable(QString::number(comparison.cameras[0].translation_mm)));
    }
    const double ratio = std::sqrt(squares / count);
    QVERIFY2(ratio > 0.6 && ratio < 1.4, qPrintable(QString::number(ratio)));
  }

  // A session that names one stream, as for other IMUs, is refused with the required line.
  void oneStreamOfTwo_isRefusedWithTheLine_data() {
    QTest::addColumn<bool>("rates");
    QTest::addColumn<bool>("forces");
    QTest::addColumn<QString>("advice");
    QTest::newRow("gyroscope") << true << false << "gyroscope: /imu and accelerometer: STREAM";
    QTest::newRow("accelerometer") << false << true << "gyroscope: STREAM and accelerometer: /imu";
    QTest::newRow("in turn") << true << true << "gyroscope: /imu and accelerometer: /imu";
  }
  void oneStreamOfTwo_isRefusedWithTheLine() {
    QFETCH(bool, rates);
    QFETCH(bool, forces);
    QFETCH(QString, advice);
    Session session = test::sessionFor(scenario_);
    session.imus[0].stream = "/imu";
    Samples samples = inOrder(rates ? ratesOf(all()) : Samples{}, forces ? forcesOf(all()) : Samples{});
    for (ImuSample& sample : samples) {
      if (sample.measured_by == MeasuredBy::Gyroscope) sample.specific_force_m_s2.setZero();
      if (sample.measured_by == MeasuredBy::Accelerometer) sample.angular_rate_rad_s.setZero();
      sample.measured_by = MeasuredBy::Both;
    }
    pass_.imus.front().samples = samples;
    try {
      calibrate(session, pass_, RunContext{});
      QFAIL("it was not refused");
    } catch (const CalibrationError& error) {
      QVERIFY(error.kind() == ErrorKind::BadInput);
      QVERIFY2(QString(error.what()).contains(advice), error.what());
    }
  }

  void halfOfTheLine_isRefused() {
    Session session = test::sessionFor(scenario_);
    session.recording = path("two.bag");
    session.imus[0].accelerometer_stream = kAccelerometer;
    writeTwoTopics();
    std::string text = sessionYaml(session, folder_.path().toStdString());
    const std::size_t at = text.find("    accelerometer: ");
    QVERIFY(at != std::string::npos);
    text.erase(at, text.find('\n', at) + 1 - at);
    std::ofstream(path("half.yaml")) << text;
    try {
      readSession(path("half.yaml"));
      QFAIL("it was not refused");
    } catch (const CalibrationError& error) {
      QVERIFY2(QString(error.what()).contains("accelerometer"), error.what());
    }
  }

 private:
  Session written(const Session& session) const {
    writeSession(session, path("session.yaml"));
    return readSession(path("session.yaml"));
  }
};

EVICAL_TEST(TestSeparateImu)
#include "tst_separate_imu.moc"
