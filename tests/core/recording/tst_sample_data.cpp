// Recordings of other programs, which are too large or not licensed for tests/data, in the folder
// EVICAL_DATA. Counts and sums are those of other decoders, from its manifest.
#include "core/recording/recording_reader.h"

#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <filesystem>

namespace {

using namespace evical;

struct SampleDataSums {
  quint64 events = 0, on = 0, x = 0, y = 0;

  bool operator==(const SampleDataSums&) const = default;
};

SampleDataSums sumsOfSampleData(const test::Contents& contents) {
  SampleDataSums sums;
  for (const auto& [stream, events] : contents.events) {
    for (const Event& event : events) {
      ++sums.events;
      sums.on += event.brighter;
      sums.x += event.x_px;
      sums.y += event.y_px;
    }
  }
  return sums;
}

class TestSampleData : public QObject {
  Q_OBJECT

 private slots:
  void recordings_areReadAsOtherDecodersReadThem_data() {
    QTest::addColumn<QString>("file");
    QTest::addColumn<QList<quint64>>("sums");  // events, ON events, x, y
    QTest::addColumn<int>("samples");
    const auto row = [](const char* file, const QList<quint64>& sums, int samples = 0) {
      QTest::newRow(file) << QString(file) << sums << samples;
    };
    row("real/dvxplorer_events_imu.aedat4", {111954, 55023, 18342405, 15105898}, 475);
    row("derived/npz_dvxplorer.npz", {20000, 9911, 3294224, 2695156});
    row("real/evlib_event.txt", {17, 0, 1801, 1103});
    row("real/gen3_evt2.raw", {539481, 367855, 171811022, 110162026});
    row("real/ros1_evt3_with_triggers.bag", {343474, 125183, 116731888, 80879209});
    // The format's y points up, ours down.
    row("real/sepia_dvs_first_part.es", {159996, 116617, 25258195, 159996 * 239 - 13876538});
  }

  void recordings_areReadAsOtherDecodersReadThem() {
    const QString folder = qEnvironmentVariable("EVICAL_DATA");
    if (folder.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
    QFETCH(QString, file);
    QFETCH(QList<quint64>, sums);
    QFETCH(int, samples);
    const std::filesystem::path path = (folder + "/formats/" + file).toStdString();
    const test::Contents contents = test::readAll(*openRecording(path));
    const SampleDataSums found = sumsOfSampleData(contents);
    QCOMPARE((QList<quint64>{found.events, found.on, found.x, found.y}), sums);
    QCOMPARE(static_cast<int>(contents.sampleCount()), samples);
  }

  // IMU tables of the kinds in users' reports; all contain the same motion.
  void reportedImuTables_holdTheSameMotion_data() {
    QTest::addColumn<QString>("file");
    QTest::addColumn<int>("count");
    for (const char* file : {"accuracy_column", "decimal_comma", "iso_times", "px4_sensor_combined",
                             "secs_nsecs", "vectornav_names", "xsens_export", "z_first"})
      QTest::newRow(file) << QString(file) << 2000;
    QTest::newRow("ros2_echo_csv") << QString("ros2_echo_csv") << 1000;
    QTest::newRow("rostopic_echo_p") << QString("rostopic_echo_p") << 900;
  }

  void reportedImuTables_holdTheSameMotion() {
    const QString folder = qEnvironmentVariable("EVICAL_DATA");
    if (folder.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
    QFETCH(QString, file);
    QFETCH(int, count);
    const auto reader = openRecording((folder + "/reports/imu_csv/" + file + ".csv").toStdString());
    std::vector<RawImuSample> samples;
    for (Packet packet; reader->read(packet);)
      samples.insert(samples.end(), packet.imu_samples.begin(), packet.imu_samples.end());
    QCOMPARE(static_cast<int>(samples.size()), count);
    const Eigen::Vector3d force(-0.570367, 3.621043, -11.069545), rate(0.067987, -0.449587, -0.253127);
    QVERIFY((samples.front().specific_force - force).norm() < 1e-6);
    QVERIFY((samples.front().angular_rate - rate).norm() < 1e-6);
    QCOMPARE(qlonglong(samples[1].time_ns - samples[0].time_ns), qlonglong(5'000'000));
    if (count < 2000) return;  // the manifest's means are for the whole motion
    Eigen::Vector3d mean_force = Eigen::Vector3d::Zero(), mean_rate = Eigen::Vector3d::Zero();
    for (const RawImuSample& sample : samples)
      mean_force += sample.specific_force / 2000.0, mean_rate += sample.angular_rate / 2000.0;
    QVERIFY((mean_force - Eigen::Vector3d(-0.31229, 0.28864, -9.17758)).norm() < 1e-4);
    QVERIFY((mean_rate - Eigen::Vector3d(-0.06286, 0.02382, -0.01116)).norm() < 1e-4);
  }

  void reportedEvents_haveTheirResolution() {
    const QString folder = qEnvironmentVariable("EVICAL_DATA");
    if (folder.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
    const auto reader = openRecording((folder + "/reports/events_e2vid.txt").toStdString());
    QVERIFY((reader->streams().at(0).resolution_px == Resolution{346, 260}));
    Packet packet;
    QVERIFY(reader->read(packet));
    QVERIFY(packet.events.front().x_px == 256 && packet.events.front().y_px == 168 &&
            !packet.events.front().brighter);
    while (reader->read(packet)) {
    }
    QVERIFY(reader->faults().empty());
  }
};

}  // namespace

EVICAL_TEST(TestSampleData)
#include "tst_sample_data.moc"
