// Frames in ROS recordings: readable ones are read as stored, others are refused with their encoding.
#include "core/base/error.h"
#include "tests/core/recording/bag_builder.h"
#include "tests/core/recording/picture_samples.h"
#include "tests/core/recording/recording_contents.h"
#include "tests/core/recording/ros/image_builder.h"
#include "tests/core/recording/ros/ros2_builder.h"
#include "tests/support/test_program.h"

#include <QTest>

using namespace evical;
using namespace evical::test;

namespace {

constexpr std::int64_t kRosFramesStart_ns = 1'700'000'000'000'000'000;
constexpr const char* kImageMd5 = "060021388200f6f0f447d0fcd9c64743";

TestImage someImage(const std::string& encoding, std::uint32_t pixel_bytes, std::uint32_t padding = 0) {
  TestImage image{kRosFramesStart_ns, 3, 2, encoding, false, 3 * pixel_bytes + padding, ""};
  for (std::uint32_t i = 0; i < image.step * image.height; ++i)
    image.bytes.push_back(static_cast<char>(i + 1));
  return image;
}

std::vector<std::uint8_t> asBytes(const std::string& text) {
  return {text.begin(), text.end()};
}

}  // namespace

class TestRosFrames : public QObject {
  Q_OBJECT

 private slots:
  void encodings_comeAsTheyAre_data();
  void encodings_comeAsTheyAre();
  void containers_areAlike_data();
  void containers_areAlike();
  void byDefault_framesAreNotRead();
  void otherEncodings_areRefusedByName_data();
  void otherEncodings_areRefusedByName();
  void wrongStep_isCorrectedIfTheDataAreComplete_data();
  void wrongStep_isCorrectedIfTheDataAreComplete();
  void damagedImages_areSaid_data();
  void damagedImages_areSaid();
  void packedImages_comeAsTheyAre_data();
  void packedImages_comeAsTheyAre();
  void otherTransports_areRefusedByName_data();
  void otherTransports_areRefusedByName();
  void packedBytesThatAreNoPicture_areSaid();
  void zeroStamps_giveWayToTheRecordsTimes();
  void truncationAnywhere_isSurvived();

 private:
  std::filesystem::path bag(const std::vector<std::string>& messages,
                            const std::string& type = "sensor_msgs/Image") const {
    BagBuilder builder;
    const std::uint32_t topic =
        builder.addConnection("/camera", type, type == "sensor_msgs/Image" ? kImageMd5 : "*");
    std::int64_t time_ns = kRosFramesStart_ns;
    for (const std::string& message : messages) builder.message(topic, time_ns += 50'000'000, message);
    return scratch_.write("a.bag", builder.finished());
  }
  ScratchFolder scratch_;
};

void TestRosFrames::encodings_comeAsTheyAre_data() {
  QTest::addColumn<QString>("encoding");
  QTest::addColumn<int>("pixel_bytes");
  QTest::addColumn<int>("format");
  const auto row = [](const char* encoding, int pixel_bytes, FrameFormat format) {
    QTest::newRow(encoding) << encoding << pixel_bytes << static_cast<int>(format);
  };
  row("mono8", 1, FrameFormat::Gray8);
  row("8UC1", 1, FrameFormat::Gray8);
  row("mono16", 2, FrameFormat::Gray16);
  row("16UC1", 2, FrameFormat::Gray16);
  row("rgb8", 3, FrameFormat::Rgb8);
  row("bgr8", 3, FrameFormat::Bgr8);
  row("rgba8", 4, FrameFormat::Rgba8);
  row("bgra8", 4, FrameFormat::Bgra8);
  row("bayer_rggb8", 1, FrameFormat::BayerRggb8);
  row("bayer_bggr8", 1, FrameFormat::BayerBggr8);
  row("bayer_gbrg8", 1, FrameFormat::BayerGbrg8);
  row("bayer_grbg8", 1, FrameFormat::BayerGrbg8);
  row("bayer_rggb16", 2, FrameFormat::BayerRggb16);
  row("bayer_bggr16", 2, FrameFormat::BayerBggr16);
  row("bayer_gbrg16", 2, FrameFormat::BayerGbrg16);
  row("bayer_grbg16", 2, FrameFormat::BayerGrbg16);
  row("8UC3", 3, FrameFormat::Bgr8);
  row("8UC4", 4, FrameFormat::Bgra8);
}

void TestRosFrames::encodings_comeAsTheyAre() {
  QFETCH(QString, encoding);
  QFETCH(int, pixel_bytes);
  QFETCH(int, format);
  for (const bool big_endian : {false, true}) {
    TestImage image = someImage(encoding.toStdString(), static_cast<std::uint32_t>(pixel_bytes), 5);
    image.big_endian = big_endian;
    const Contents contents = readEverything(bag({imageMessage(image, false)}));
    QCOMPARE(contents.frameCount(), 1u);
    const Frame& frame = contents.frames.at(0).front();
    QCOMPARE(frame.time_ns, kRosFramesStart_ns);
    QCOMPARE(static_cast<int>(frame.format), format);
    QCOMPARE(frame.big_endian, big_endian);
    QCOMPARE(frame.size_px.width_px, 3);
    QCOMPARE(frame.size_px.height_px, 2);
    QCOMPARE(frame.row_bytes, std::size_t{image.step});
    QVERIFY(frame.bytes == asBytes(image.bytes));
    QCOMPARE(contents.streams[0].resolution_px.width_px, 3);
    QVERIFY(contents.faults.empty());
  }
}

void TestRosFrames::containers_areAlike_data() {
  QTest::addColumn<QString>("container");
  for (const char* container : {"mcap", "mcap big endian", "mcap ros1", "db3"})
    QTest::newRow(container) << container;
}

void TestRosFrames::containers_areAlike() {
  QFETCH(QString, container);
  const bool ros1 = container == "mcap ros1", big_endian = container == "mcap big endian";
  std::vector<RosTopic> topics = {{"/camera", "sensor_msgs/msg/Image"},
                                  {"/packed", "sensor_msgs/msg/CompressedImage"}};
  if (ros1)
    topics = {{"/camera", "sensor_msgs/Image", "ros1"}, {"/packed", "sensor_msgs/CompressedImage", "ros1"}};
  std::vector<RosMessage> messages;
  for (int i = 0; i < 5; ++i) {
    TestImage image = someImage("mono16", 2);
    image.stamp_ns += i * 50'000'000;
    messages.push_back({0, image.stamp_ns, imageMessage(image, !ros1, big_endian)});
    messages.push_back({1, image.stamp_ns, compressedMessage(image.stamp_ns, "png", pngBytes(8, 6), !ros1)});
  }
  std::filesystem::path path = scratch_ / "a.db3";
  if (container == "db3")
    writeSqliteBag(path, topics, messages);
  else
    path = scratch_.write("a.mcap", mcapFile(topics, messages));
  const Contents contents = readEverything(path);
  QCOMPARE(contents.frames.size(), std::size_t{2});
  for (const auto& [stream, frames] : contents.frames) {
    QCOMPARE(frames.size(), std::size_t{5});
    QCOMPARE(frames[4].time_ns, kRosFramesStart_ns + 200'000'000);
    const bool packed = contents.streams[stream].name == "/packed";
    QCOMPARE(contents.streams[stream].resolution_px.width_px, packed ? 8 : 3);
    QCOMPARE(frames[0].format == FrameFormat::Encoded, packed);
  }
  QVERIFY(contents.faults.empty());
}

void TestRosFrames::byDefault_framesAreNotRead() {
  const auto reader = openRecording(bag({imageMessage(someImage("mono8", 1), false)}));
  QVERIFY(reader->streams()[0].type == StreamType::Frames);
  QVERIFY(reader->streams()[0].readable);
  Packet packet;
  QVERIFY(!reader->read(packet));
}

void TestRosFrames::otherEncodings_areRefusedByName_data() {
  QTest::addColumn<QString>("encoding");
  for (const char* encoding : {"yuv422", "32FC1", "bayer_rggb32", "8UC2", "MONO8"})
    QTest::newRow(encoding) << encoding;
}

void TestRosFrames::otherEncodings_areRefusedByName() {
  QFETCH(QString, encoding);
  const auto reader = openRecording(bag({imageMessage(someImage(encoding.toStdString(), 8), false)}));
  QVERIFY(!reader->streams()[0].readable);
  QVERIFY(reader->faults().front().kind == FaultKind::Encoding);
  try {
    reader->select({0});
    QFAIL("selected");
  } catch (const CalibrationError& error) {
    QVERIFY(error.problem().find(encoding.toStdString()) != std::string::npos);
    QVERIFY(error.advice().find("mono8") != std::string::npos);
  }
}

void TestRosFrames::wrongStep_isCorrectedIfTheDataAreComplete_data() {
  QTest::addColumn<int>("bytes");
  QTest::addColumn<bool>("read");
  QTest::newRow("complete") << 12 << true;
  QTest::newRow("shorter") << 11 << false;
}

void TestRosFrames::wrongStep_isCorrectedIfTheDataAreComplete() {
  QFETCH(int, bytes);
  QFETCH(bool, read);
  const TestImage image{
      kRosFramesStart_ns, 3, 2, "mono16", false, 3, std::string(static_cast<std::size_t>(bytes), '\x07')};
  const Contents contents = readEverything(bag({imageMessage(image, false)}));
  QCOMPARE(contents.frameCount(), read ? 1u : 0u);
  if (read) QCOMPARE(contents.frames.at(0).front().row_bytes, std::size_t{6});
  QCOMPARE(contents.faults.size(), std::size_t{1});
  QVERIFY2(contents.faults.front().text.find("step is 3 bytes") != std::string::npos,
           contents.faults.front().text.c_str());
}

void TestRosFrames::damagedImages_areSaid_data() {
  QTest::addColumn<quint32>("width");
  QTest::addColumn<quint32>("height");
  QTest::addColumn<quint32>("step");
  QTest::newRow("rows longer than the data") << 3u << 2u << 4u;
  QTest::newRow("rows shorter than the pixels") << 3u << 1u << 2u;
  QTest::newRow("more rows than data") << 3u << 3u << 3u;
  QTest::newRow("no rows") << 3u << 0u << 3u;
  QTest::newRow("absurd width") << 4'000'000'000u << 2u << 3u;
  QTest::newRow("absurd height and step") << 65536u << 65536u << 4'294'967'295u;
}

void TestRosFrames::damagedImages_areSaid() {
  QFETCH(quint32, width);
  QFETCH(quint32, height);
  QFETCH(quint32, step);
  const TestImage good = someImage("mono8", 1);
  TestImage bad = good;
  bad.width = width;
  bad.height = height;
  bad.step = step;
  const Contents contents =
      readEverything(bag({imageMessage(good, false), imageMessage(bad, false), imageMessage(good, false)}));
  QCOMPARE(contents.frameCount(), 2u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestRosFrames::packedImages_comeAsTheyAre_data() {
  QTest::addColumn<QString>("format");
  QTest::addColumn<bool>("png");
  QTest::newRow("jpeg") << "jpeg" << false;
  QTest::newRow("png") << "png" << true;
  QTest::newRow("jpeg of the transport") << "bgr8; jpeg compressed bgr8" << false;
  QTest::newRow("png of the transport") << "mono8; png compressed " << true;
  QTest::newRow("not said") << "" << true;
}

void TestRosFrames::packedImages_comeAsTheyAre() {
  QFETCH(QString, format);
  QFETCH(bool, png);
  const std::string bytes = png ? pngBytes(640, 480) : jpegBytes(640, 480);
  const Contents contents =
      readEverything(bag({compressedMessage(kRosFramesStart_ns, format.toStdString(), bytes, false)},
                         "sensor_msgs/CompressedImage"));
  QCOMPARE(contents.frameCount(), 1u);
  const Frame& frame = contents.frames.at(0).front();
  QVERIFY(frame.format == FrameFormat::Encoded);
  QVERIFY(frame.bytes == asBytes(bytes));
  QCOMPARE(frame.time_ns, kRosFramesStart_ns);
  QCOMPARE(contents.streams[0].resolution_px.width_px, 640);
  QCOMPARE(contents.streams[0].resolution_px.height_px, 480);
}

void TestRosFrames::otherTransports_areRefusedByName_data() {
  QTest::addColumn<QString>("format");
  for (const char* format : {"16UC1; compressedDepth png", "compressedDepth", "h264", "tiff"})
    QTest::newRow(format) << format;
}

void TestRosFrames::otherTransports_areRefusedByName() {
  QFETCH(QString, format);
  const auto reader =
      openRecording(bag({compressedMessage(kRosFramesStart_ns, format.toStdString(), pngBytes(8, 6), false)},
                        "sensor_msgs/CompressedImage"));
  QVERIFY(!reader->streams()[0].readable);
  try {
    reader->select({0});
    QFAIL("selected");
  } catch (const CalibrationError& error) {
    QVERIFY(error.problem().find(format.toStdString()) != std::string::npos);
    QVERIFY(error.advice().find("jpeg") != std::string::npos);
  }
}

void TestRosFrames::packedBytesThatAreNoPicture_areSaid() {
  const Contents contents =
      readEverything(bag({compressedMessage(kRosFramesStart_ns, "png", "no picture", false),
                          compressedMessage(kRosFramesStart_ns, "png", "", false),
                          compressedMessage(kRosFramesStart_ns, "png", pngBytes(8, 6), false)},
                         "sensor_msgs/CompressedImage"));
  QCOMPARE(contents.frameCount(), 1u);
  QVERIFY(contents.hasFault(FaultKind::Corrupt));
}

void TestRosFrames::zeroStamps_giveWayToTheRecordsTimes() {
  TestImage image = someImage("mono8", 1);
  image.stamp_ns = 0;
  const std::string message = imageMessage(image, false);
  const Contents contents = readEverything(bag({message, message, message}));
  QCOMPARE(contents.frameCount(), 3u);
  QCOMPARE(contents.frames.at(0)[1].time_ns, kRosFramesStart_ns + 100'000'000);
  QVERIFY(contents.hasFault(FaultKind::NoStamps));
}

void TestRosFrames::truncationAnywhere_isSurvived() {
  const std::string whole = imageMessage(someImage("rgb8", 3), false);
  const std::string good = imageMessage(someImage("mono8", 1), false);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Contents contents = readEverything(bag({good, whole.substr(0, size)}));
    QCOMPARE(contents.frameCount(), 1u);
    QVERIFY(contents.hasFault(FaultKind::Corrupt));
  }
}

EVICAL_TEST(TestRosFrames)
#include "tst_ros_frames.moc"
