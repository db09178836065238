// Frames that Evical writes into ROS recordings: read back unchanged, by Evical and by ROS's own library.
#include "core/base/error.h"
#include "core/recording/recording_writer.h"
#include "tests/core/recording/picture_samples.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

#include <QProcess>
#include <QTest>

using namespace evical;
using namespace evical::test;

namespace {

constexpr std::int64_t kFramesWrittenStart_ns = 1'700'000'000'000'000'000;

Frame plainFrame(FrameFormat format, std::size_t pixel_bytes, int number = 0) {
  Frame frame;
  frame.time_ns = kFramesWrittenStart_ns + number * 50'000'000LL;
  frame.format = format;
  frame.size_px = {3, 2};
  frame.row_bytes = 3 * pixel_bytes + 1;  // rows with a gap
  frame.big_endian = format == FrameFormat::Gray16;
  for (std::size_t i = 0; i < 2 * frame.row_bytes; ++i)
    frame.bytes.push_back(static_cast<std::uint8_t>(i + 1 + static_cast<std::size_t>(number)));
  return frame;
}

Frame encodedFrame(const std::string& bytes, int number = 0) {
  Frame frame;
  frame.time_ns = kFramesWrittenStart_ns + number * 50'000'000LL;
  frame.format = FrameFormat::Encoded;
  frame.bytes.assign(bytes.begin(), bytes.end());
  return frame;
}

bool sameForFramesWritten(const Frame& a, const Frame& b) {
  const bool layout = a.format == FrameFormat::Encoded ||
                      (a.size_px == b.size_px && a.row_bytes == b.row_bytes && a.big_endian == b.big_endian);
  return a.time_ns == b.time_ns && a.format == b.format && a.bytes == b.bytes && layout;
}

StreamInfo streamOf(const char* name, StreamType type) {
  StreamInfo info;
  info.name = name;
  info.type = type;
  info.resolution_px = {64, 48};
  return info;
}

}  // namespace

class TestFramesWritten : public QObject {
  Q_OBJECT

 private slots:
  void roundTrip_isExact_data() {
    QTest::addColumn<QString>("format");
    for (const RecordingFormat& format : recordingFormats())
      if (format.frames) QTest::newRow(format.name) << QString(format.name);
  }
  void roundTrip_isExact();
  void otherFormats_refuseThem();
  void whatHasNoPlace_isRefused_data();
  void whatHasNoPlace_isRefused();
  void rosReadsThem();

 private:
  std::unique_ptr<RecordingWriter> writer(const QString& format) const {
    return createRecording(scratch_ / "frames", format.toStdString(),
                           {streamOf("/camera/image_raw", StreamType::Frames),
                            streamOf("/camera/image_raw/compressed", StreamType::Frames),
                            streamOf("/imu", StreamType::Imu), streamOf("/events", StreamType::Events)});
  }
  ScratchFolder scratch_;
};

void TestFramesWritten::roundTrip_isExact() {
  QFETCH(QString, format);
  const std::pair<FrameFormat, std::size_t> kinds[] = {
      {FrameFormat::Gray8, 1},      {FrameFormat::Gray16, 2},     {FrameFormat::Rgb8, 3},
      {FrameFormat::Bgr8, 3},       {FrameFormat::Rgba8, 4},      {FrameFormat::Bgra8, 4},
      {FrameFormat::BayerRggb8, 1}, {FrameFormat::BayerBggr8, 1}, {FrameFormat::BayerGbrg8, 1},
      {FrameFormat::BayerGrbg8, 1}};
  for (const auto& [kind, pixel_bytes] : kinds) {
    std::vector<Frame> plain, packed;
    for (int i = 0; i < 3; ++i) {
      plain.push_back(plainFrame(kind, pixel_bytes, i));
      packed.push_back(encodedFrame(i == 1 ? jpegBytes(8, 6) : pngBytes(8, 6), i));
    }
    const auto samples = someSamples(150, kFramesWrittenStart_ns);
    const auto events = someEvents(2000, kFramesWrittenStart_ns);
    const auto written = writer(format);
    for (std::size_t i = 0; i < 3; ++i) {
      written->write(2, std::span(samples).subspan(50 * i, 50));
      written->writeFrame(0, plain[i]);
      written->writeFrame(1, packed[i]);
      written->write(3, EventSpan(events).subspan(500 * i, 500));
    }
    written->finish();
    const Contents contents = readEverything(scratch_ / "frames");
    QVERIFY(contents.faults.empty());
    QCOMPARE(contents.streams.size(), std::size_t{4});
    QCOMPARE(contents.eventCount(), std::size_t{1500});
    QCOMPARE(contents.sampleCount(), std::size_t{150});
    QCOMPARE(contents.frameCount(), std::size_t{6});
    for (const auto& [stream, frames] : contents.frames) {
      const std::vector<Frame>& expected =
          contents.streams[stream].name == "/camera/image_raw" ? plain : packed;
      QVERIFY(
          std::equal(frames.begin(), frames.end(), expected.begin(), expected.end(), sameForFramesWritten));
    }
  }
}

void TestFramesWritten::otherFormats_refuseThem() {
  for (const RecordingFormat& format : recordingFormats()) {
    if (format.frames || format.isFolder()) continue;
    StreamInfo events = streamOf("events", StreamType::Events);
    events.resolution_px = {346, 260};
    const auto written = createRecording(scratch_ / "none", format.name, {events});
    QVERIFY_THROWS_EXCEPTION(CalibrationError, written->writeFrame(0, plainFrame(FrameFormat::Gray8, 1)));
  }
}

void TestFramesWritten::whatHasNoPlace_isRefused_data() {
  QTest::addColumn<bool>("packed_before");
  QTest::addColumn<QByteArray>("file");
  QTest::newRow("a bitmap") << true << QByteArray("BM and so on");
  QTest::newRow("an empty file") << true << QByteArray("");
  QTest::newRow("a file after pixels") << false << QByteArray::fromStdString(pngBytes(8, 6));
}

void TestFramesWritten::whatHasNoPlace_isRefused() {
  QFETCH(bool, packed_before);
  QFETCH(QByteArray, file);
  const auto written = writer("bag");
  written->writeFrame(0, packed_before ? encodedFrame(pngBytes(8, 6)) : plainFrame(FrameFormat::Gray8, 1));
  try {
    written->writeFrame(0, encodedFrame(file.toStdString(), 1));
    QFAIL("written");
  } catch (const CalibrationError& error) {
    QVERIFY(error.problem().find("/camera/image_raw") != std::string::npos);
    QVERIFY(error.advice().find("PNG") != std::string::npos);
  }
}

void TestFramesWritten::rosReadsThem() {
  if (QProcess::execute("/usr/bin/python3", {"-c", "import rosbag"}) != 0)
    QSKIP("python3-rosbag is not installed");
  const auto written = writer("bag");
  const Frame plain = plainFrame(FrameFormat::Bgr8, 3);
  written->writeFrame(0, plain);
  written->writeFrame(1, encodedFrame(jpegBytes(8, 6), 1));
  written->finish();
  const char* script =
      "import rosbag, sys\n"
      "for topic, m, stamp in rosbag.Bag(sys.argv[1]).read_messages():\n"
      "    if topic.endswith('compressed'): print(m._type, m.format, len(m.data), m.header.stamp.to_nsec())\n"
      "    else: print(m._type, m.encoding, m.width, m.height, m.step, sum(bytearray(m.data)))\n"
      "import genpy.dynamic\n"
      "for c in rosbag.Bag(sys.argv[1])._get_connections():\n"
      "    types = genpy.dynamic.generate_dynamic(c.datatype, c.msg_def)\n"
      "    assert types[c.datatype]._md5sum == c.md5sum, c.datatype\n";
  QProcess process;
  process.start("/usr/bin/python3", {"-c", script, QString::fromStdString((scratch_ / "frames").string())});
  QVERIFY(process.waitForFinished(60'000));
  int sum = 0;
  for (const std::uint8_t byte : plain.bytes) sum += byte;
  const QString expected =
      QString("sensor_msgs/Image bgr8 3 2 10 %1\nsensor_msgs/CompressedImage jpeg %2 %3\n")
          .arg(sum)
          .arg(jpegBytes(8, 6).size())
          .arg(kFramesWrittenStart_ns + 50'000'000);
  const QString printed = process.readAllStandardOutput();
  QVERIFY2(process.exitCode() == 0 && printed == expected,
           qPrintable(printed + process.readAllStandardError()));
}

EVICAL_TEST(TestFramesWritten)
#include "tst_frames_written.moc"
