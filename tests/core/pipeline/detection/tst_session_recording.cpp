#include "core/base/error.h"
#include "core/format/gray_png.h"
#include "core/frames/gray_image.h"
#include "core/numerics/angles.h"
#include "core/pipeline/detection/recording_pass.h"
#include "core/pipeline/detection/session_recording.h"
#include "core/pipeline/simulate/simulation.h"
#include "core/synthetic/scenario_yaml.h"
#include "tests/core/recording/sample_recording.h"
#include "tests/support/real_recordings.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QTemporaryDir>

#include <array>
#include <cmath>

using namespace evical;
using namespace evical::test;

namespace {

constexpr std::size_t kEvents = 40'000;

// Steps back in time between packets, over all streams.
std::int64_t largestStepBack_ns(SessionRecording& recording) {
  SensorPacket packet;
  std::int64_t last_ns = recording.start_ns(), largest_ns = 0;
  while (recording.read(packet)) {
    const std::int64_t first_ns =
        packet.events.empty() ? packet.imu_samples.front().time_ns : packet.events.front().time_ns;
    largest_ns = std::max(largest_ns, last_ns - first_ns);
    last_ns = first_ns;
  }
  return largest_ns;
}

}  // namespace

class TestSessionRecording : public QObject {
  Q_OBJECT

 private slots:
  void init();
  void oneFile_isReadAsItIs();
  void twoFiles_areReadTogether();
  void clockOffset_isAdded();
  void clockScale_isApplied();
  void clockScale_startsBehindStrays();
  void absurdClocks_areRefused();
  void mirroredImages_areReversed_data();
  void mirroredImages_areReversed();
  void mirroredFrames_areReversed();
  void columns_areThoseOfTheSession();
  void units_areThoseOfTheSession();
  void twoFilesOfOneImu_areJoined();
  void twoImusOfOneTable_areRead();
  void realCheckerboard_isFoundInSingleEvents();
  void clocksWithoutRelation_areRefused();
  void clockInAnotherUnit_isNamed();
  void wrongTimesOfAnImu_areRefusedWithTheUnit();
  void wrongTimesOfACameraAlone_areReplacedByNumbers_data();
  void wrongTimesOfACameraAlone_areReplacedByNumbers();
  void reportedFramesOneNsApart_areAllUsed();
  void missingStream_namesFileAndStreams();
  void intrinsicsOfAnotherResolution_areRefused();
  void samplesThatAreNoMeasurements_stayOutside();
  void strayStamps_moveNeitherBeginningNorEnd();
  void simulatedRawFiles_haveTheirImuBeside();
  void simulatedRawFiles_haveFramesOnTheirClock();

 private:
  std::filesystem::path path(const char* name) const { return folder_.filePath(name).toStdString(); }
  Recording readSession(std::size_t& imu_sensor) const {
    SessionRecording recording(session_);
    imu_sensor = recording.imuSensor(0);
    Recording all;
    SensorPacket packet;
    while (recording.read(packet)) {
      auto& events = all.events;
      auto& samples = all.imu_samples;
      if (packet.sensor == 0) events.insert(events.end(), packet.events.begin(), packet.events.end());
      if (packet.sensor == 1)
        samples.insert(samples.end(), packet.imu_samples.begin(), packet.imu_samples.end());
    }
    return all;
  }
  // Events in one bag, IMU samples in another.
  void useTwoFiles() {
    const std::vector<StreamInfo> streams = sampleStreams();
    Recording events = written_, samples = written_;
    events.imu_samples.resize(1);
    samples.events.resize(1);
    writeAll(*createBag(path("events.bag"), streams, false), events);
    writeAll(*createBag(path("imu.bag"), streams, false), samples);
    session_.recording = path("events.bag");
    session_.imus[0].recording = path("imu.bag");
  }

  QTemporaryDir folder_;
  Recording written_ = sampleRecording(kEvents);
  Session session_;
};

void TestSessionRecording::init() {
  session_ = {};
  SessionCamera camera;
  camera.name = "camera";
  camera.stream = "/dvs/events";
  SessionImu imu;
  imu.name = "imu";
  imu.stream = "/dvs/imu";
  session_.cameras = {camera};
  session_.imus = {imu};
  session_.recording = path("whole.bag");
  writeAll(*createBag(path("whole.bag"), sampleStreams(), false), written_);
}

void TestSessionRecording::oneFile_isReadAsItIs() {
  std::size_t imu_sensor = 0;
  const Recording read = readSession(imu_sensor);
  QCOMPARE(imu_sensor, std::size_t{1});
  QVERIFY(same(read.events, written_.events));
  QVERIFY(same(read.imu_samples, written_.imu_samples));
  SessionRecording recording(session_);
  QCOMPARE(qint64(recording.start_ns()), qint64(written_.events.front().time_ns));
  QVERIFY((recording.resolution_px(0) == Resolution{346, 260}));
}

void TestSessionRecording::twoFiles_areReadTogether() {
  useTwoFiles();
  std::size_t imu_sensor = 0;
  const Recording read = readSession(imu_sensor);
  QVERIFY(same(read.events, written_.events));
  QVERIFY(same(read.imu_samples, written_.imu_samples));
  SessionRecording recording(session_);
  QVERIFY(largestStepBack_ns(recording) < 20'000'000);
  QCOMPARE(recording.fractionRead(), 1.0);
}

void TestSessionRecording::clockOffset_isAdded() {
  useTwoFiles();
  session_.imus[0].clock_offset_s = -0.25;
  session_.cameras[0].clock_offset_s = 1e-6;
  std::size_t imu_sensor = 0;
  const Recording read = readSession(imu_sensor);
  QCOMPARE(qint64(read.imu_samples[7].time_ns), qint64(written_.imu_samples[7].time_ns - 250'000'000));
  QCOMPARE(qint64(read.events[7].time_ns), qint64(written_.events[7].time_ns + 1000));
  QCOMPARE(qint64(SessionRecording(session_).start_ns()), qint64(read.imu_samples.front().time_ns));
}

// Counted from the sensor's first stamp; the offset is added then.
void TestSessionRecording::clockScale_isApplied() {
  useTwoFiles();
  session_.imus[0].clock_scale = 0.5;
  session_.imus[0].clock_offset_s = 0.25;
  std::size_t imu_sensor = 0;
  const Recording read = readSession(imu_sensor);
  const std::int64_t first_ns = written_.imu_samples.front().time_ns;
  QCOMPARE(qint64(read.imu_samples[0].time_ns), qint64(first_ns + 250'000'000));
  QVERIFY(std::abs(read.imu_samples[30].time_ns -
                   (first_ns + (written_.imu_samples[30].time_ns - first_ns) / 2 + 250'000'000)) <= 1);
  QVERIFY(same(read.events, written_.events));
}

// If a first sample that is stamped 0 were the fixed point, all others would move by days.
void TestSessionRecording::clockScale_startsBehindStrays() {
  Recording spoilt = written_;
  spoilt.imu_samples.front().time_ns = 0;
  writeAll(*createBag(path("whole.bag"), sampleStreams(), false), spoilt);
  session_.imus[0].clock_scale = 1.001;
  std::size_t imu_sensor = 0;
  const Recording read = readSession(imu_sensor);
  QCOMPARE(read.imu_samples.size(), written_.imu_samples.size() - 1);
  const std::int64_t first_ns = written_.imu_samples[1].time_ns;
  QCOMPARE(qint64(read.imu_samples[0].time_ns), qint64(first_ns));
  const double whole_ns = 1.001 * static_cast<double>(written_.imu_samples.back().time_ns - first_ns);
  QVERIFY(std::abs(static_cast<double>(read.imu_samples.back().time_ns - first_ns) - whole_ns) <= 1.0);
  SessionRecording recording(session_);
  SensorPacket packet;
  while (recording.read(packet)) {
  }
  QVERIFY(recording.faults().front().text.find("1 IMU sample excluded") != std::string::npos);
  QVERIFY(std::abs(recording.faults().front().at_s) < 1.0);
}

void TestSessionRecording::absurdClocks_areRefused() {
  useTwoFiles();
  session_.imus[0].clock_offset_s = 4.5e9;  // from 2020 on that is in the year 2162
  QVERIFY_THROWS_EXCEPTION(CalibrationError, SessionRecording recording(session_));
}

// The driver's image is the mirror image of the written one, also of a sensor that is not square.
void TestSessionRecording::mirroredImages_areReversed_data() {
  QTest::addColumn<int>("how");
  for (std::size_t how = 0; how < kMirroringNames.size(); ++how)
    QTest::addRow("%s", kMirroringNames[how]) << static_cast<int>(how);
}
void TestSessionRecording::mirroredImages_areReversed() {
  QFETCH(int, how);
  const auto mirroring = static_cast<Mirroring>(how);
  Recording mirrored = written_;
  for (Event& event : mirrored.events) {
    const Event straight = event;
    if (mirroring == Mirroring::X) event.x_px = static_cast<std::uint16_t>(345 - straight.x_px);
    if (mirroring == Mirroring::Y) event.y_px = static_cast<std::uint16_t>(259 - straight.y_px);
    if (mirroring == Mirroring::Transposed) event.x_px = straight.y_px, event.y_px = straight.x_px;
  }
  std::vector<StreamInfo> streams = sampleStreams();
  if (mirroring == Mirroring::Transposed) streams[0].resolution_px = {260, 346};
  writeAll(*createBag(path("mirrored.bag"), streams, false), mirrored);
  session_.recording = path("mirrored.bag");
  setInSession(session_, "cameras.camera.mirrored", kMirroringNames[static_cast<std::size_t>(how)]);
  std::size_t imu_sensor = 0;
  const Recording read = readSession(imu_sensor);
  QVERIFY(same(read.events, written_.events));
  QVERIFY(same(read.imu_samples, written_.imu_samples));
  QVERIFY((SessionRecording(session_).resolution_px(0) == Resolution{346, 260}));
}

void TestSessionRecording::mirroredFrames_areReversed() {
  std::filesystem::create_directory(path("frames"));
  for (const char* const name : {"frames/1600000000000000000.png", "frames/1600000000050000000.png"}) {
    GrayPng picture(3, 2, 72.0);
    picture.addRow(std::vector<std::uint8_t>{1, 2, 3});
    picture.addRow(std::vector<std::uint8_t>{4, 5, 6});
    writeFile(path(name), picture.finish());
  }
  session_.imus.clear();
  session_.cameras[0].stream = "pictures";
  session_.recording = path("frames");
  const std::pair<Mirroring, std::vector<std::uint8_t>> kExpected[] = {
      {Mirroring::None, {1, 2, 3, 4, 5, 6}},
      {Mirroring::X, {3, 2, 1, 6, 5, 4}},
      {Mirroring::Y, {4, 5, 6, 1, 2, 3}},
      {Mirroring::Transposed, {1, 4, 2, 5, 3, 6}}};
  for (const auto& [mirroring, bytes] : kExpected) {
    session_.cameras[0].mirrored = mirroring;
    SessionRecording recording(session_);
    SensorPacket packet;
    QVERIFY(recording.read(packet));
    const GrayImage image = decodeFrame(packet.frames.at(0), "frame");
    QVERIFY(image.pixels == bytes);
    QVERIFY(image.size_px == mirroredSize(mirroring, {3, 2}));
  }
}

void TestSessionRecording::columns_areThoseOfTheSession() {
  std::string table = "t_us,ax,ay,az,gx,gy,gz\n";
  for (int i = 0; i < 100; ++i)
    table += std::to_string(1'600'000'000'123'456 + 5000 * i) + ",1,2,3,7,8,9.8\n";
  writeFile(path("table.csv"), table);
  session_.imus[0].recording = path("table.csv");
  session_.imus[0].stream = "table.csv";
  session_.imus[0].columns = "t_us,gz,gy,gx,ax,ay,az";
  SessionRecording recording(session_);
  SensorPacket packet;
  while (recording.read(packet) && packet.imu_samples.empty()) {
  }
  QVERIFY(!packet.imu_samples.empty());
  QVERIFY((packet.imu_samples[0].angular_rate_rad_s == Eigen::Vector3d(3, 2, 1)));
  QVERIFY((packet.imu_samples[0].specific_force_m_s2 == Eigen::Vector3d(7, 8, 9.8)));
}

// Gyroscope and accelerometer with their own files and stamps, as raw counts.
void TestSessionRecording::twoFilesOfOneImu_areJoined() {
  std::string gyroscope = "time_us,z,y,x\n", accelerometer = gyroscope;
  for (int i = 0; i < 100; ++i) {
    gyroscope += std::to_string(1200 + 5000 * i) + ",300,200,100\n";
    accelerometer += std::to_string(10'000 * i) + ",1000,20,10\n";
  }
  writeFile(path("phone_a.csv"), gyroscope);
  writeFile(path("phone_b.csv"), accelerometer);
  Session session = session_;
  session.cameras.clear();
  SessionImu imu;
  imu.name = "phone";
  imu.recording = path("phone_a.csv");
  imu.accelerometer_recording = path("phone_b.csv");
  imu.stream = "phone_a.csv";
  imu.accelerometer_stream = "phone_b.csv";
  imu.columns = "t_us,gz,gy,gx";
  imu.accelerometer_columns = "t_us,az,ay,ax";
  imu.acceleration_unit = AccelerationUnit::Gravity;
  imu.acceleration_factor = 0.001;
  imu.angular_rate_factor = 0.01;
  session.imus = {imu};
  SessionRecording recording(session);
  std::size_t rates = 0, forces = 0;
  for (SensorPacket packet; recording.read(packet);)
    for (const ImuSample& sample : packet.imu_samples) {
      if (measuresRate(sample)) {
        QVERIFY((sample.angular_rate_rad_s - Eigen::Vector3d(1.0, 2.0, 3.0)).norm() < 1e-12);
        QCOMPARE(qlonglong((sample.time_ns - 1'200'000) % 5'000'000), qlonglong(0));
        ++rates;
      } else {
        QVERIFY(
            (sample.specific_force_m_s2 / kStandardGravity_m_s2 - Eigen::Vector3d(0.01, 0.02, 1.0)).norm() <
            1e-12);
        ++forces;
      }
    }
  QVERIFY(rates == 100 && forces == 100);
}

// Two IMUs in one table, whose columns the session names.
void TestSessionRecording::twoImusOfOneTable_areRead() {
  std::string table = "time_us,a,b,c,d,e,f,g,h,i,j,k,l\n";
  for (int i = 0; i < 50; ++i) table += std::to_string(5000 * i) + ",1,2,9,4,5,6,7,8,9,10,11,12\n";
  writeFile(path("both.csv"), table);
  Session session = session_;
  session.cameras.clear();
  session.imus.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    session.imus[i].name = "imu" + std::to_string(i);
    session.imus[i].stream = "both.csv";
    session.imus[i].recording = path("both.csv");
  }
  session.imus[0].columns = "t_us,ax,ay,az,gx,gy,gz,-,-,-,-,-,-";
  session.imus[1].columns = "t_us,-,-,-,-,-,-,ax,ay,az,gx,gy,gz";
  SessionRecording recording(session);
  std::array<std::size_t, 2> counts{};
  for (SensorPacket packet; recording.read(packet);)
    for (const ImuSample& sample : packet.imu_samples) {
      const std::size_t imu = packet.sensor == recording.imuSensor(0) ? 0 : 1;
      QVERIFY(
          (sample.angular_rate_rad_s == (imu == 0 ? Eigen::Vector3d(4, 5, 6) : Eigen::Vector3d(10, 11, 12))));
      ++counts[imu];
    }
  QVERIFY(counts[0] == 50 && counts[1] == 50);
}

void TestSessionRecording::units_areThoseOfTheSession() {
  session_.imus[0].acceleration_unit = AccelerationUnit::MinusGravity;
  session_.imus[0].angular_rate_unit = AngularRateUnit::DegreesPerSecond;
  std::size_t imu_sensor = 0;
  const ImuSample read = readSession(imu_sensor).imu_samples.at(3), &written = written_.imu_samples.at(3);
  QVERIFY((read.specific_force_m_s2 + 9.80665 * written.specific_force_m_s2).norm() < 1e-12);
  QVERIFY((kDegPerRad * read.angular_rate_rad_s - written.angular_rate_rad_s).norm() < 1e-12);
}

void TestSessionRecording::clocksWithoutRelation_areRefused() {
  useTwoFiles();
  Recording samples = written_;
  samples.events.resize(1);
  const std::int64_t start_ns = written_.events.front().time_ns;
  for (ImuSample& sample : samples.imu_samples) sample.time_ns -= start_ns;
  samples.events[0].time_ns = 0;
  writeAll(*createBag(path("imu.bag"), sampleStreams(), false), samples);
  try {
    SessionRecording recording(session_);
    QFAIL("accepted");
  } catch (const CalibrationError& error) {
    QVERIFY(QString(error.what()).contains("imu.bag"));
    QVERIFY2(QString(error.what()).contains("1600000000.12"), error.what());
  }
  session_.imus[0].clock_offset_s = 1e-9 * static_cast<double>(start_ns);  // the advised value
  std::size_t imu_sensor = 0;
  const Recording read = readSession(imu_sensor);
  QVERIFY(std::abs(read.imu_samples.front().time_ns - written_.imu_samples.front().time_ns) < 1000);
}

void TestSessionRecording::clockInAnotherUnit_isNamed() {
  useTwoFiles();
  Recording samples = written_;
  samples.events.clear();
  for (ImuSample& sample : samples.imu_samples)
    sample.time_ns /= 1000;  // microseconds that are called nanoseconds
  writeAll(*createBag(path("imu.bag"), sampleStreams(), false), samples);
  try {
    SessionRecording recording(session_);
    QFAIL("accepted");
  } catch (const CalibrationError& error) {
    QVERIFY2(QString(error.what()).contains("1000 times too small: correct their unit"), error.what());
  }
}

void TestSessionRecording::wrongTimesOfAnImu_areRefusedWithTheUnit() {
  Recording wrong = written_;
  for (ImuSample& sample : wrong.imu_samples) sample.time_ns /= 1000;
  for (Event& event : wrong.events) event.time_ns /= 1000;
  writeAll(*createBag(path("whole.bag"), sampleStreams(), false), wrong);
  SessionRecording recording(session_);
  SensorPacket packet;
  try {
    while (recording.read(packet)) {
    }
    QFAIL("accepted");
  } catch (const CalibrationError& error) {
    QVERIFY2(QString(error.what()).contains("1000 times too small (us read as ns"), error.what());
  }
}

void TestSessionRecording::wrongTimesOfACameraAlone_areReplacedByNumbers_data() {
  QTest::addColumn<qint64>("step_ns");
  QTest::addColumn<qint64>("expected_ns");
  QTest::newRow("a count") << qint64{1} << qint64{1'000'000'000};
  QTest::newRow("all equal") << qint64{0} << qint64{0};  // one view
  QTest::newRow("hours") << qint64{3'600'000'000'000} << qint64{1'000'000'000};
  QTest::newRow("pictures by hand") << qint64{7'000'000'000} << qint64{7'000'000'000};
  QTest::newRow("a camera") << qint64{50'000'000} << qint64{50'000'000};
}

// Views of points; frames are handled alike.
void TestSessionRecording::wrongTimesOfACameraAlone_areReplacedByNumbers() {
  QFETCH(qint64, step_ns);
  QFETCH(qint64, expected_ns);
  constexpr int kViews = 40, kPoints = 30;
  std::string table = "time_ns,point,x_px,y_px\n";
  for (int view = 0; view < kViews; ++view)
    for (int point = 0; point < kPoints; ++point)
      table +=
          QString("%1,%2,%3,20\n").arg(1'000'000'000 + view * step_ns).arg(point).arg(point).toStdString();
  writeFile(path("points.csv"), table);
  session_.imus.clear();
  session_.recording = path("points.csv");
  session_.cameras[0].stream = "points.csv";
  session_.cameras[0].resolution_px = {640, 480};
  SessionRecording recording(session_);
  SensorPacket packet;
  std::vector<std::int64_t> times_ns;
  while (recording.read(packet))
    for (const MeasuredPoint& point : packet.points) times_ns.push_back(point.time_ns);
  QCOMPARE(times_ns.size(), std::size_t{kViews * kPoints});
  for (std::size_t i = kPoints; i < times_ns.size(); i += kPoints)
    QCOMPARE(qint64(times_ns[i] - times_ns[i - kPoints]), expected_ns);
}

void TestSessionRecording::reportedFramesOneNsApart_areAllUsed() {
  const QString folder = qEnvironmentVariable("EVICAL_DATA");
  if (folder.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
  session_.recording = (folder + "/reports/containers/bagcreater_from_indices_1ns_apart.bag").toStdString();
  session_.imus.clear();
  session_.cameras[0].stream = "/cam0/image_raw";
  SessionRecording recording(session_);
  SensorPacket packet;
  int count = 0;
  while (recording.read(packet))
    for (const Frame& frame : packet.frames) QCOMPARE(qint64(frame.time_ns), 1'000'000'000 * qint64{count++});
  QCOMPARE(count, 8);
}

void TestSessionRecording::missingStream_namesFileAndStreams() {
  useTwoFiles();
  session_.imus[0].stream = "/dvs/imo";
  try {
    SessionRecording recording(session_);
    QFAIL("accepted");
  } catch (const CalibrationError& error) {
    QVERIFY(error.kind() == ErrorKind::BadInput);
    QVERIFY(QString(error.what()).contains("imu.bag"));
    QVERIFY(QString(error.what()).contains("/dvs/imu"));
  }
}

void TestSessionRecording::intrinsicsOfAnotherResolution_areRefused() {
  CameraIntrinsics intrinsics;
  intrinsics.resolution_px = {640, 480};
  intrinsics.focal_length_px = {500.0, 500.0};
  intrinsics.principal_point_px = {320.0, 240.0};
  session_.cameras[0].intrinsics = intrinsics;
  try {
    SessionRecording(session_).resolution_px(0);
    QFAIL("accepted");
  } catch (const CalibrationError& error) {
    QVERIFY(error.kind() == ErrorKind::BadInput);
    QVERIFY2(QString(error.what()).contains("for 640 x 480 px, but the recording has 346 x 260"),
             error.what());
  }
}

void TestSessionRecording::samplesThatAreNoMeasurements_stayOutside() {
  Recording spoilt = written_;
  spoilt.imu_samples[5].specific_force_m_s2.x() = std::nan("");
  spoilt.imu_samples[9].angular_rate_rad_s.z() = 1e22;
  writeAll(*createBag(path("whole.bag"), sampleStreams(), false), spoilt);
  std::size_t imu_sensor = 0;
  const Recording read = readSession(imu_sensor);
  QCOMPARE(read.imu_samples.size(), written_.imu_samples.size() - 2);
  QCOMPARE(qint64(read.imu_samples[5].time_ns), qint64(written_.imu_samples[6].time_ns));
  SessionRecording recording(session_);
  SensorPacket packet;
  while (recording.read(packet)) continue;
  QCOMPARE(recording.faults().size(), std::size_t{1});
  const RecordingFault fault = recording.faults().front();
  QVERIFY(fault.kind == FaultKind::NotFinite);
  QCOMPARE(fault.stream, std::string("/dvs/imu"));
  QVERIFY2(fault.text.find("2 IMU samples excluded") != std::string::npos, fault.text.c_str());
}

void TestSessionRecording::strayStamps_moveNeitherBeginningNorEnd() {
  constexpr std::int64_t kDay_ns = 86'400LL * 1'000'000'000;
  Recording spoilt = written_;
  spoilt.events.front().time_ns = 0;
  spoilt.events[20'000].time_ns += kDay_ns;
  spoilt.events.back().time_ns += kDay_ns;
  spoilt.imu_samples.front().time_ns = 0;
  writeAll(*createBag(path("whole.bag"), sampleStreams(), false), spoilt);
  SessionRecording recording(session_);
  // Start of the sensor whose stamps are trusted first.
  const std::int64_t late_ns = recording.start_ns() - written_.events[1].time_ns;
  QVERIFY2(late_ns >= 0 && late_ns < 10'000'000, qPrintable(QString::number(late_ns)));
  std::size_t events = 0, samples = 0;
  SensorPacket packet;
  while (recording.read(packet)) {
    for (const Event& event : packet.events)
      QVERIFY(event.time_ns >= written_.events.front().time_ns &&
              event.time_ns <= written_.events.back().time_ns);
    events += packet.events.size();
    samples += packet.imu_samples.size();
  }
  QCOMPARE(events, written_.events.size() - 3);
  QCOMPARE(samples, written_.imu_samples.size() - 1);
  QCOMPARE(recording.faults().size(), std::size_t{2});
  QVERIFY(recording.faults().front().kind == FaultKind::Corrupt);
  QVERIFY2(recording.faults().front().text.find("3 events excluded") != std::string::npos,
           recording.faults().front().text.c_str());
}

void TestSessionRecording::simulatedRawFiles_haveFramesOnTheirClock() {
  Scenario scenario = readScenario(test::scenarioPath("davis346_frames"));
  scenario.duration_s = 0.5;
  const Session session =
      evical::readSession(simulate(scenario, path("frames"), RunContext{}, "raw").session);
  SessionRecording recording(session);  // refuses unrelated clocks
  std::uint64_t frames = 0;
  SensorPacket packet;
  while (recording.read(packet)) frames += packet.frames.size();
  QVERIFY(frames > 3);
}

// Users of Prophesee cameras have these two files. Both use one clock and contain everything that was
// simulated.
void TestSessionRecording::simulatedRawFiles_haveTheirImuBeside() {
  Scenario scenario = readScenario(test::scenarioPath("davis346"));
  scenario.duration_s = 0.5;
  for (const char* const format : {"raw", "dat"}) {
    const SimulationSummary made = simulate(scenario, path(format), RunContext{}, format);
    QCOMPARE(made.recording, path(format) / (std::string("recording.") + format));
    const Session session = evical::readSession(made.session);
    QCOMPARE(session.imus.at(0).recording.filename(), std::filesystem::path("imu.csv"));
    SessionRecording recording(session);
    std::uint64_t events = 0, samples = 0;
    SensorPacket packet;
    while (recording.read(packet)) {
      events += packet.events.size();
      samples += packet.imu_samples.size();
    }
    QVERIFY(events > 10'000);
    QCOMPARE(events, made.events);
    QCOMPARE(samples, made.imu_samples);
    QVERIFY(recording.faults().empty());
  }
}

// Its place is not known, but it does not jump: the camera was never turned by 60 deg, nor the
// board's middle moved by a square in the other direction than its corners' velocities.
void TestSessionRecording::realCheckerboard_isFoundInSingleEvents() {
  const QString folder = realRecordings();
  if (folder.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
  const Session session = dvs128Moving(folder);
  const BoardObservations found = readAndDetect(session, {CameraLens{}}, RunContext{}).cameras.front();
  QVERIFY(found.single_events);
  double found_s = 0.0;
  for (const WindowReport& window : found.windows)
    if (window.time_s > 8.0 && window.time_s < 35.0 && window.outcome == WindowOutcome::Partial)
      found_s += 2.0 * window.half_width_s;
  qInfo("found in %.1f of 27 s", found_s);
  QVERIFY2(found_s > 0.5 * 27.0, qPrintable(QString::number(found_s)));
  const BoardView* before = nullptr;
  for (const BoardView& view : found.views) {
    if (before && view.time_s - before->time_s < 0.12) {
      int same = 0, jumps = 0;
      for (const CircleObservation& corner : view.circles)
        for (const CircleObservation& last : before->circles) {
          if (last.circle != corner.circle) continue;
          const Eigen::Vector2d velocity = 0.5 * (last.velocity_px_s + corner.velocity_px_s),
                                moved = corner.centre_px - last.centre_px;
          constexpr double kSquare_px = 7.0;
          ++same;
          jumps += (moved - (corner.time_s - last.time_s) * velocity).norm() > kSquare_px;
        }
      QVERIFY2(2 * jumps <= same, qPrintable(QString::number(view.time_s)));
    }
    before = &view;
  }
}

EVICAL_TEST(TestSessionRecording)
#include "tst_session_recording.moc"
