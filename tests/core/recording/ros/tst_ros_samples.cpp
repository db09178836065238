// Recordings from other sources are read with the same result as by an independent decoder.
#include "core/recording/inspection.h"
#include "tests/support/test_folders.h"
#include "tests/support/test_program.h"

#include <QTest>

#include <filesystem>
#include <string>

using namespace evical;

namespace {

const std::filesystem::path kRosSamplesData = test::sourcePath("tests/data/recordings");

Inspection inspect(const char* name) {
  const std::unique_ptr<RecordingReader> reader = openRecording(kRosSamplesData / name);
  return inspectRecording(*reader);
}

bool hasFault(const Inspection& inspection, FaultKind kind) {
  for (const RecordingFault& fault : inspection.faults)
    if (fault.kind == kind) return true;
  return false;
}

}  // namespace

class TestRosSamples : public QObject {
  Q_OBJECT
 private slots:
  void bagWithEvt3AndTriggers();
  void sqliteFolderWithMono_data();
  void sqliteFolderWithMono();
  void mcapWithoutEvents();
};

void TestRosSamples::bagWithEvt3AndTriggers() {
  const Inspection inspection = inspect("ros1_evt3_with_triggers.bag");
  QCOMPARE(inspection.streams.size(), std::size_t{2});
  const StreamSummary& events = inspection.streams[0];
  QCOMPARE(events.count, std::uint64_t{343474});
  QCOMPARE(events.on, std::uint64_t{125183});
  QCOMPARE(events.off, std::uint64_t{218291});
  QCOMPARE(events.first_ns, std::int64_t{7139845000});
  QCOMPARE(events.last_ns, std::int64_t{9218023000});
  QCOMPARE(events.backward_steps, std::uint64_t{0});
  QCOMPARE(events.largest_gap_ns, std::int64_t{207000});
  QCOMPARE(events.sum_x, std::uint64_t{116731888});
  QCOMPARE(events.sum_y, std::uint64_t{80879209});
  QCOMPARE(events.sum_t, std::uint64_t{2851601611994000});
  QCOMPARE(events.info.resolution_px, (Resolution{640, 480}));
  QCOMPARE(inspection.streams[1].info.type, StreamType::Triggers);
  QCOMPARE(inspection.streams[1].count, std::uint64_t{4157});
  // The first message: stamp 1675956550.318679, its first event at 7.139845 s; delays are below 5 ms.
  QVERIFY(std::abs(events.info.host_clock_offset_s.value_or(0.0) - (1675956550.318679 - 7.139845)) < 5e-3);
  QVERIFY(hasFault(inspection, FaultKind::HostClock));
  QVERIFY(!hasFault(inspection, FaultKind::LostMessages));
}

void TestRosSamples::sqliteFolderWithMono_data() {
  QTest::addColumn<QString>("name");
  QTest::newRow("folder") << "ros2_mono";
  QTest::newRow("file") << "ros2_mono/test_data_mono_cd_0.db3";
}

void TestRosSamples::sqliteFolderWithMono() {
  QFETCH(QString, name);
  const Inspection inspection = inspect(qPrintable(name));
  QCOMPARE(inspection.format, "rosbag2");
  QCOMPARE(inspection.streams.size(), std::size_t{1});
  const StreamSummary& events = inspection.streams[0];
  QCOMPARE(events.info.message, "event_array_msgs/msg/EventArray");
  QCOMPARE(events.info.messages, std::uint64_t{2});
  QCOMPARE(events.count, std::uint64_t{100});
  QCOMPARE(events.on, std::uint64_t{50});
  QCOMPARE(events.first_ns, std::int64_t{0});
  QCOMPARE(events.last_ns, std::int64_t{99000});
  QCOMPARE(events.sum_x, std::uint64_t{34450});
  QCOMPARE(events.sum_y, std::uint64_t{26450});
  QCOMPARE(events.sum_t, std::uint64_t{4950000});
}

void TestRosSamples::mcapWithoutEvents() {
  const Inspection inspection = inspect("no_event_topics_zstd.mcap");
  QCOMPARE(inspection.format, "mcap");
  QVERIFY(inspection.faults.empty());
  QCOMPARE(inspection.streams.size(), std::size_t{3});
  for (const StreamSummary& stream : inspection.streams) {
    QCOMPARE(stream.info.type, StreamType::Other);
    QCOMPARE(stream.count, std::uint64_t{stream.info.name == "/parameter_events" ? 0U : 10U});
  }
}

EVICAL_TEST(TestRosSamples)
#include "tst_ros_samples.moc"
