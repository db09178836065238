// Recordings of other programs, which are too large or not licensed for tests/data, in the folder
// EVICAL_DATA. Counts and sums are those of other decoders, from its manifest.
#include "core/recording/inspection.h"
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

  // Containers and pictures of the kinds in users' reports: their streams, and what their faults state first.
  void reportedContainers_areRead_data() {
    QTest::addColumn<QStringList>("streams");  // name:type:count, with a '-' before it without times
    QTest::addColumn<QStringList>("said");     // in faults
    const auto row = [](const char* file, const QStringList& streams, const QStringList& said = {}) {
      QTest::newRow(file) << streams << said;
    };
    const QString imu = "/dvs/imu:imu:200", events = "/dvs/events:events:4000";
    row("index_12", {"-pictures:frames:12"}, {"have no times"});
    row("date_17_ms_30fps", {"pictures:frames:12"}, {"interpreted as dates"});
    row("bagcreater_from_indices_1ns_apart.bag", {"-/cam0/image_raw:frames:8"}, {"no camera is this fast"});
    row("euroc_csv_excel", {"cam0:frames:12", "imu0:imu:600"}, {"cannot be true in any unit"});
    row("euroc_csv_times_in_s", {"cam0:frames:12", "imu0:imu:600"}, {"read as s"});
    row("euroc_no_data_csv", {"cam0:frames:12", "imu0:imu:600"});
    row("index_and_data_csv", {"pictures:frames:12"});
    row("kalibr_imu_named_imu_csv", {"imu.csv:imu:600", "cam0:frames:12"});
    row("two_cameras_on_one_topic.bag",
        {"/imu:imu:200", "/dvs/events of /left:events:4000", "/dvs/events of /right:events:4000"},
        {"Several nodes publish on /dvs/events"});
    row("old_dvs_msgs_before_2015.bag", {imu, events});
    row("cut_at_25_percent.db3", {"/dvs/events:events:2600", "/dvs/imu:imu:143"}, {"ends at byte"});
    row("split_give_r_0_only/r_0.mcap", {}, {"r_1.mcap is in the same folder"});
    row("dsec_ms_float.h5", {"events:events:12000"}, {"read as ms"});
    row("dsec_s_float32_absolute.h5", {"events:events:12000"}, {"have the same time", "float32"});
    row("all_times_us_written_as_ns.bag", {imu, events}, {"200000 samples per s", "us read as ns"});
    row("mono16_with_step_of_mono8.bag", {"/cam0/image_raw:frames:4"}, {"The step is 160 bytes"});
    row("compressed_format_JPEG_upper.bag", {"/cam0/image_raw/compressed:frames:10"});
    row("image_8UC3.bag", {"/cam0/image_raw:frames:4"});
    row("imu_as_vector3stamped.bag", {"/imu/gyro:other:200", "/imu/acc:other:200", events},
        {"/imu/gyro has messages of type geometry_msgs/Vector3Stamped"});
    row("px4_sensor_combined.mcap", {}, {"SensorCombined"});
    row("evt3_packets_with_evt21_content_genx320.bag", {"/imu:imu:200", "/event_camera/events:events:4000"},
        {"state the encoding evt3, but their content is evt21"});
    row("valid_imu_with_acc_covariance_minus1.bag", {imu, events});
  }

  void reportedContainers_areRead() {
    const QString folder = qEnvironmentVariable("EVICAL_DATA");
    if (folder.isEmpty()) QSKIP("EVICAL_DATA, the folder of sample recordings, is not set");
    QFETCH(QStringList, streams);
    QFETCH(QStringList, said);
    const QString path = folder + "/reports/containers/" + QTest::currentDataTag();
    const auto reader = openRecording(path.toStdString());
    const Inspection inspection = inspectRecording(*reader);
    QStringList found, faults;
    for (const StreamSummary& stream : inspection.streams)
      found += QString("%1%2:%3:%4")
                   .arg(stream.info.timed ? "" : "-", QString::fromStdString(stream.info.name),
                        streamTypeName(stream.info.type))
                   .arg(stream.count);
    for (const RecordingFault& fault : inspection.faults) faults += QString::fromStdString(fault.text);
    if (!streams.isEmpty())
      QVERIFY2(QSet(found.begin(), found.end()).contains(QSet(streams.begin(), streams.end())),
               qPrintable(found.join(", ")));
    for (const QString& text : said)
      QVERIFY2(faults.join(" ").contains(text), qPrintable(text + " is missing in: " + faults.join(" ")));
    QVERIFY2(!said.isEmpty() || faults.isEmpty(), qPrintable(faults.join(" ")));
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
