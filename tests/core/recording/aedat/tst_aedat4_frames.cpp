// Frames in AEDAT4, in packets encoded by hand after dv-processing's frame.fbs.
#include "core/recording/aedat/packet_compression.h"
#include "core/recording/aedat/packets.h"
#include "core/recording/aedat/stream_description.h"
#include "tests/core/recording/aedat/frame_packets.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/support/test_program.h"

using namespace evical;
using namespace evical::test;

namespace {

TestFrame grayFrame(std::int64_t middle_us, std::int64_t exposure_us) {
  return {middle_us, middle_us - exposure_us / 2, middle_us + exposure_us / 2, 0, 0, 3, 2, 0, 0, "abcdef"};
}

std::string fileOf(const std::vector<std::string>& frames, bool described = true) {
  const std::vector<aedat::StreamDescription> streams = {{0, "events", "EVTS", "a", {64, 48}},
                                                         {1, "frames", "FRME", "a", {}}};
  aedat::FileHeader header;
  if (described) header.description = aedat::descriptionsXml(streams, "NONE");
  std::size_t position_at = 0;
  std::string bytes = std::string(aedat::kMagic) + aedat::encodeHeader(header, position_at);
  const auto add = [&bytes](std::int32_t stream, const std::string& packet) {
    bytes += bytesOf(stream) + bytesOf(static_cast<std::int32_t>(packet.size())) + packet;
  };
  add(0, aedat::encodeEvents(someEvents(100, 1'000'000'000)));
  for (const std::string& frame : frames) add(1, frame);
  return bytes;
}

}  // namespace

class TestAedat4Frames : public QObject {
  Q_OBJECT

 private slots:
  void frames_haveTheMiddleOfTheExposure();
  void exposureAsALength_isUsedWithoutItsEnds();
  void withoutExposure_theTimeIsTheFrames();
  void colours_comeAsTheyAre();
  void byDefault_framesAreNotRead();
  void withoutXml_framesAreFound();
  void otherFormatsAndParts_areLeftOutAndSaid();
  void damagedFrames_areSaid();
  void truncationAnywhere_isSurvived();

 private:
  Contents read(const std::vector<TestFrame>& frames) const {
    std::vector<std::string> packets;
    for (const TestFrame& frame : frames) packets.push_back(framePacket(frame));
    return readEverything(folder_.write("a.aedat4", fileOf(packets)));
  }
  ScratchFolder folder_;
};

void TestAedat4Frames::frames_haveTheMiddleOfTheExposure() {
  const Contents contents = read({grayFrame(1'000'000, 4000), grayFrame(1'040'000, 4000)});
  QCOMPARE(contents.frameCount(), 2u);
  const Frame& frame = contents.frames.at(1)[1];
  QCOMPARE(frame.time_ns, 1'040'000'000);
  QCOMPARE(frame.exposure_s, 0.004);
  QVERIFY(frame.format == FrameFormat::Gray8);
  QCOMPARE(frame.size_px.width_px, 3);
  QCOMPARE(frame.size_px.height_px, 2);
  QCOMPARE(frame.row_bytes, 3u);
  QCOMPARE(std::string(frame.bytes.begin(), frame.bytes.end()), std::string("abcdef"));
  QCOMPARE(contents.streams[1].resolution_px.width_px, 3);
  QCOMPARE(contents.eventCount(), 100u);
  QVERIFY(contents.faults.empty());
}

// An odd length: the middle is exact to half a microsecond.
void TestAedat4Frames::exposureAsALength_isUsedWithoutItsEnds() {
  TestFrame frame = grayFrame(0, 0);
  frame.time_us = 1'000'000;
  frame.exposure_us = 4001;
  const Contents contents = read({frame});
  QCOMPARE(contents.frames.at(1)[0].time_ns, 1'002'000'500);
  QCOMPARE(contents.frames.at(1)[0].exposure_s, 0.004001);
}

void TestAedat4Frames::withoutExposure_theTimeIsTheFrames() {
  TestFrame frame = grayFrame(0, 0);
  frame.time_us = 1'000'000;
  const Contents contents = read({frame});
  QCOMPARE(contents.frames.at(1)[0].time_ns, 1'000'000'000);
  QCOMPARE(contents.frames.at(1)[0].exposure_s, 0.0);
}

void TestAedat4Frames::colours_comeAsTheyAre() {
  TestFrame bgr = grayFrame(1'000'000, 10), bgra = bgr;
  bgr.format = 16;
  bgr.pixels.assign(18, 'x');
  bgra.format = 24;
  bgra.pixels.assign(24, 'y');
  const Contents contents = read({bgr, bgra});
  QVERIFY(contents.frames.at(1)[0].format == FrameFormat::Bgr8);
  QCOMPARE(contents.frames.at(1)[0].row_bytes, 9u);
  QVERIFY(contents.frames.at(1)[1].format == FrameFormat::Bgra8);
  QCOMPARE(contents.frames.at(1)[1].bytes.size(), 24u);
}

void TestAedat4Frames::byDefault_framesAreNotRead() {
  const Contents contents =
      readAll(folder_.write("a.aedat4", fileOf({framePacket(grayFrame(1'000'000, 4000))})));
  QCOMPARE(contents.frameCount(), 0u);
  QCOMPARE(contents.eventCount(), 100u);
}

void TestAedat4Frames::withoutXml_framesAreFound() {
  const Contents contents =
      readEverything(folder_.write("a.aedat4", fileOf({framePacket(grayFrame(1'000'000, 4000))}, false)));
  QCOMPARE(contents.frameCount(), 1u);
  QCOMPARE(QString::fromStdString(contents.streams[1].name), QString("frames"));
}

void TestAedat4Frames::otherFormatsAndParts_areLeftOutAndSaid() {
  TestFrame sixteen_bit = grayFrame(1'000'000, 10), part = sixteen_bit;
  sixteen_bit.format = 2;
  part.left = 5;
  for (const TestFrame& bad : {sixteen_bit, part}) {
    const Contents contents = read({bad, grayFrame(1'040'000, 10)});
    QCOMPARE(contents.frameCount(), 1u);
    QVERIFY(contents.hasFault(FaultKind::Encoding));
  }
}

void TestAedat4Frames::damagedFrames_areSaid() {
  TestFrame few_pixels = grayFrame(1'000'000, 10), negative = few_pixels, late = few_pixels;
  few_pixels.height = 300;
  negative.width = -3;
  late.time_us = late.exposure_begin_us = late.exposure_end_us = std::int64_t{1} << 53;  // in the year 2255
  for (const TestFrame& bad : {few_pixels, negative, late}) {
    const Contents contents = read({bad, grayFrame(1'040'000, 10)});
    QCOMPARE(contents.frameCount(), 1u);
    QVERIFY(contents.hasFault(FaultKind::Corrupt));
  }
}

void TestAedat4Frames::truncationAnywhere_isSurvived() {
  const std::string whole = framePacket(grayFrame(1'000'000, 4000));
  Frame frame;
  std::string unusable;
  QVERIFY(aedat::decodeFrame(whole, frame, unusable));
  for (std::size_t size = 0; size < whole.size(); ++size)
    QVERIFY(!aedat::decodeFrame(whole.substr(0, size), frame, unusable));
}

EVICAL_TEST(TestAedat4Frames)
#include "tst_aedat4_frames.moc"
