// Small valid files as seeds for fuzzing: `evical_fuzz_seeds FOLDER` creates one folder per target.
#include "core/recording/aedat/packet_compression.h"
#include "core/recording/aedat/packets.h"
#include "core/recording/aedat/stream_description.h"
#include "core/recording/recording_writer.h"
#include "core/recording/ros/compression.h"
#include "core/recording/ros/message_types.h"
#include "core/recording/ros/ros_messages.h"
#include "tests/core/recording/aedat/aedat2_builder.h"
#include "tests/core/recording/aedat/aedat3_builder.h"
#include "tests/core/recording/aedat/frame_packets.h"
#include "tests/core/recording/bag_builder.h"
#include "tests/core/recording/numpy/numpy_builder.h"
#include "tests/core/recording/picture_samples.h"
#include "tests/core/recording/ros/image_builder.h"
#include "tests/core/recording/ros/ros2_builder.h"
#include "tests/support/packed_events.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <vector>

namespace {

using namespace evical;
namespace fs = std::filesystem;

constexpr Resolution kSize_px = {64, 64};
constexpr std::int64_t kStart_ns = 1'000'000'000;

std::vector<Event> someEvents() {
  std::vector<Event> events;
  for (int i = 0; i < 60; ++i)
    events.push_back({kStart_ns + i / 3 * 40'000, static_cast<std::uint16_t>(20 + i % 3),
                      static_cast<std::uint16_t>(i), i % 2 == 0});
  return events;
}

std::vector<ImuSample> someSamples() {
  std::vector<ImuSample> samples(5);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].time_ns = kStart_ns + static_cast<std::int64_t>(i) * 1'000'000;
    samples[i].specific_force_m_s2 = {0.1, 0.2, 9.8};
    samples[i].angular_rate_rad_s = {0.01 * static_cast<double>(i), 0.5, -1.0};
  }
  return samples;
}

std::vector<RawImuSample> rawSamples() {
  std::vector<RawImuSample> samples;
  for (const ImuSample& sample : someSamples())
    samples.push_back(fromSi(sample, AccelerationUnit::Gravity, AngularRateUnit::DegreesPerSecond));
  return samples;
}

void save(const fs::path& path, const std::string& bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string contentOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void writeAll(RecordingWriter& writer) {
  writer.write(0, EventSpan(someEvents()));
  writer.write(1, std::span<const ImuSample>(someSamples()));
  writer.finish();
}

// Every format that Evical writes; for folders, their files.
void saveWritten(const fs::path& folder) {
  const std::vector<StreamInfo> streams = {{"events", StreamType::Events, "", kSize_px},
                                           {"imu", StreamType::Imu, "", {}}};
  for (const char* target : {"bag", "mcap", "aedat4", "hdf5", "text"})
    fs::create_directories(folder / target);
  writeAll(*createBag(folder / "bag/plain", streams, false));
  writeAll(*createBag(folder / "bag/lz4", streams, true));
  writeAll(*createMcap(folder / "mcap/plain", streams, McapCompression::None));
  writeAll(*createMcap(folder / "mcap/lz4", streams, McapCompression::Lz4));
  writeAll(*createMcap(folder / "mcap/zstd", streams, McapCompression::Zstd));
  writeAll(*createAedat4(folder / "aedat4/lz4", streams, false));
  writeAll(*createAedat4(folder / "aedat4/zstd", streams, true));
  writeAll(*createDsec(folder / "hdf5/dsec", streams));
  writeAll(*createText(folder / "text", streams));
  writeAll(*createCsv(folder / "text", streams));
}

// DV writes these, too; the fuzzer can modify data that are not compressed.
void savePlainAedat4(const fs::path& path) {
  const std::vector<aedat::StreamDescription> streams = {{0, "events", "EVTS", "a", kSize_px},
                                                         {1, "imu", "IMUS", "a", {}}};
  aedat::FileHeader header;
  header.description = aedat::descriptionsXml(streams, aedat::compressionName(aedat::Compression::None));
  std::size_t position_at = 0;
  std::string bytes = std::string(aedat::kMagic) + aedat::encodeHeader(header, position_at);
  const auto add = [&bytes](std::int32_t stream, const std::string& packet) {
    test::appendWord(bytes, stream);
    test::appendWord(bytes, static_cast<std::int32_t>(packet.size()));
    bytes += packet;
  };
  add(0, aedat::encodeEvents(someEvents()));
  add(1, aedat::encodeImu(rawSamples()));
  save(path, bytes);
}

// Events, an IMU sample and frames in each.
void saveAedats(const fs::path& folder) {
  std::string davis = test::aedat2Header("DAVIS240C"), unnamed = test::aedat2Header("");
  for (const Event& event : someEvents()) {
    const auto time_us = static_cast<std::int32_t>(event.time_ns / 1000);
    davis += test::aedat2Record(test::davisAddress(event, 240, 180), time_us);
    davis += test::aedat2Imu({8192, 1, 2, 3, 4, 5, 6}, time_us);
    unnamed += test::aedat2Record(test::dvs128Address(event), time_us);
  }
  save(folder / "aedat2/davis", davis + test::aedat2Record(0x8000'0011U, 1'000'000));
  save(folder / "aedat2/unnamed", unnamed);
  save(folder / "aedat3/all", test::aedat3Header() + test::aedat3Events(someEvents()) +
                                  test::aedat3Imu(1'000'000, {0.0F, 0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 25.0F}) +
                                  test::aedat3FramePacket({1, 1'000'000, 1'002'000}) +
                                  test::aedat3FramePacket({3, 1'000'000, 1'002'000}));
}

void savePictures(const fs::path& folder) {
  save(folder / "pictures/euroc", "#timestamp [ns],filename\n1403636579763555584,1.png\n-7,1.png\n");
  save(folder / "pictures/png", test::pngBytes(64, 64) + "\n5 1.png\n");
  const auto kind = [](char number) { return std::string(1, number); };
  save(folder / "payload/png", kind(5) + test::pngBytes(64, 64));
  save(folder / "payload/jpeg", kind(5) + test::jpegBytes(64, 64));
  save(folder / "payload/pgm", kind(5) + "P5\n# comment\n64 64 255\n");
  const test::TestFrame frame{1000, 900, 1100, 0, 0, 3, 2, 0, 0, "abcdef"};
  save(folder / "payload/aedat_frame", kind(2) + test::framePacket(frame));
  const test::TestImage image{kStart_ns, 3, 2, "mono8", false, 3, "abcdef"};
  save(folder / "payload/ros1_image", kind(3) + test::imageMessage(image, false));
  save(folder / "payload/cdr_image", kind(4) + test::imageMessage(image, true));
  save(folder / "payload/cdr_packed",
       kind(4) + test::compressedMessage(kStart_ns, "png", test::pngBytes(8, 6), true));
  test::BagBuilder bag;
  bag.message(bag.addConnection("/camera", "sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743"),
              kStart_ns, test::imageMessage(image, false));
  bag.message(bag.addConnection("/packed", "sensor_msgs/CompressedImage", "*"), kStart_ns,
              test::compressedMessage(kStart_ns, "jpeg", test::jpegBytes(8, 6), false));
  save(folder / "bag/frames", bag.finished());
}

void saveRos(const fs::path& folder) {
  using test::bytesOf, test::sized;
  test::BagBuilder bag("bz2"), packets;
  bag.message(bag.addEvents("/events"), kStart_ns, test::eventMessage(kStart_ns, kSize_px, someEvents()));
  save(folder / "bag/bz2", bag.finished());
  const std::uint32_t topic = packets.addConnection("/camera", "event_camera_msgs/EventPacket", "*");
  packets.message(topic, kStart_ns,
                  bytesOf(std::uint32_t{0}) + test::timeBytes(kStart_ns) + sized("camera") +
                      bytesOf(std::uint32_t{64}) + bytesOf(std::uint32_t{64}) + bytesOf(std::uint64_t{0}) +
                      bytesOf(kStart_ns) + sized("evt3") + bytesOf(std::uint8_t{0}) +
                      sized(test::encodeEvt3(someEvents())));
  save(folder / "bag/packets", packets.finished());
  const std::vector<test::RosTopic> topics = {{"/events", "dvs_msgs/msg/EventArray"},
                                              {"/imu", "sensor_msgs/msg/Imu"}};
  std::vector<test::RosMessage> messages = {{0, kStart_ns, test::cdrEvents(kSize_px, someEvents())}};
  for (const ImuSample& sample : someSamples()) messages.push_back({1, sample.time_ns, test::cdrImu(sample)});
  save(folder / "mcap/messages", test::mcapFile(topics, messages));
  save(folder / "mcap/chunks", test::mcapFile(topics, messages, 2));
  fs::create_directories(folder / "db3");
  test::writeSqliteBag(folder / "db3/bag", topics, messages);
}

void saveCameraFormats(const fs::path& folder) {
  const std::vector<Event> events = someEvents();
  const std::string size = "% geometry 64x64\n% end\n";
  save(folder / "raw/evt2", "% evt 2.0\n" + size + test::encodeEvt2(events));
  save(folder / "raw/evt21", "% evt 2.1\n% endianness little\n" + size + test::encodeEvt21(events, false));
  save(folder / "raw/evt21_legacy", "% evt 2.1\n% system_ID 49\n" + size + test::encodeEvt21(events, true));
  save(folder / "raw/evt3", "% format EVT3;height=64;width=64\n% end\n" + test::encodeEvt3(events));
  save(folder / "raw/dat", "% Version 2\n% Width 64\n% Height 64\n" + test::encodeDat(events));
  save(folder / "text/bare_dat", test::encodeDat(events));
  for (const bool atis : {false, true})
    save(folder / (atis ? "es/atis" : "es/dvs"),
         test::eventStreamHeader(64, 64, atis) + test::encodeEventStream(events, 64, atis));
  save(folder / "text/metavision", "%geometry:64,64\n20,0,1,1000000\n21,1,0,1000003\n");
  save(folder / "text/g", "time_us,acc_x [g],acc_y,acc_z,gyro_x [deg/s],gyro_y,gyro_z\n7,0,0,1,1,2,3\n");
}

void saveArrays(const fs::path& folder) {
  std::string x, y, t, p, rows, reals;
  for (const Event& event : someEvents()) {
    x += test::rawNumber(event.x_px);
    y += test::rawNumber(event.y_px);
    t += test::rawNumber(event.time_ns / 1000);
    p += static_cast<char>(event.brighter ? 1 : 0);
    rows += t.substr(t.size() - 8) + x.substr(x.size() - 2) + y.substr(y.size() - 2) + p.back();
    for (const double part :
         {1e-9 * static_cast<double>(event.time_ns), 1.0 * event.x_px, 1.0 * event.y_px, 1.0})
      reals += test::rawNumber(part);
  }
  const std::string structured =
      test::npyArray("[('t', '<i8'), ('x', '<u2'), ('y', '<u2'), ('p', '|b1')]", "(60,)", rows);
  save(folder / "npy/structured", structured);
  save(folder / "npy/nested",
       test::npyArray("[('xy', '>u2', (2,)), ('', '|V3'), ('a', [(('n', 't'), '<f4'), ('p', '?')])]", "(1,)",
                      std::string(12, '\1')));
  save(folder / "npy/rows", test::npyArray("'<f8'", "(60, 4)", reals));
  save(folder / "npy/columns", test::npyArray("'<f8'", "(60, 4)", reals, true));
  for (const bool deflate : {false, true}) {
    const std::string how = deflate ? "npz/deflated" : "npz/stored";
    const std::vector<test::ZipFile> files = {
        {"x.npy", test::npyArray("'<u2'", "(60,)", x), deflate},
        {"y.npy", test::npyArray("'<u2'", "(60,)", y), deflate},
        {"t.npy", test::npyArray("'<i8'", "(60,)", t), deflate, deflate},
        {"p.npy", test::npyArray("'|b1'", "(60,)", p), deflate}};
    save(folder / how, test::zipArchive(files, deflate));
    save(folder / (how + "_structured"), test::zipArchive({{"e.npy", structured, deflate}}));
  }
}

void savePayloads(const fs::path& folder) {
  const std::vector<Event> events = someEvents();
  const auto kind = [](char number) { return std::string(1, number); };
  save(folder / "payload/evt3", kind(0) + "\x80\x80" + test::encodeEvt3(events));
  save(folder / "payload/mono", kind(0) + "\x01\x80" + test::encodeEvt21(events, false));
  save(folder / "payload/libcaer", kind(0) + "\x03\x80" + test::encodeEvt21(events, false));
  save(folder / "payload/libcaer_cmp", kind(0) + "\x04\x80" + test::encodeEvt3(events));
  save(folder / "payload/ecf", kind(1) + std::string("\x0C\0\0\0", 4) + std::string(40, '\0'));
  save(folder / "payload/aedat_events", kind(2) + aedat::encodeEvents(events));
  save(folder / "payload/aedat_imu", kind(2) + aedat::encodeImu(rawSamples()));
  save(folder / "payload/ros1", kind(3) + test::eventMessage(kStart_ns, kSize_px, events));
  save(folder / "payload/cdr", kind(4) + test::cdrEvents(kSize_px, events));
  save(folder / "payload/cdr_imu", kind(4) + test::cdrImu(someSamples().front()));
}

// Messages of Foxglove's protocol: kind, length, content.
void saveFoxglove(const fs::path& folder) {
  const ros::MessageType& type = ros::imuType(ros::Serialization::Cdr);
  const std::string channel =
      fmt::format(R"({{"id":7,"topic":"/imu","encoding":"cdr","schemaName":"{}","schema":""}})", type.name);
  std::string session;
  const auto add = [&](char kind, const std::string& content) {
    session += kind + numberBytes(static_cast<std::uint16_t>(content.size())) + content;
  };
  add(0, R"({"op":"serverInfo","name":"bridge","capabilities":[]})");
  add(0, R"({"op":"advertise","channels":[)" + channel + "]}");
  for (const ImuSample& sample : someSamples()) {
    std::string payload;
    ros::encodeImu(sample, 0, ros::Serialization::Cdr, payload);
    add(1, "\1" + numberBytes(std::uint32_t{1}) + numberBytes(static_cast<std::uint64_t>(sample.time_ns)) +
               payload);
  }
  save(folder / "foxglove/imu", session);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const fs::path folder = argv[1];
  saveWritten(folder);
  savePlainAedat4(folder / "aedat4/plain");
  saveAedats(folder);
  savePictures(folder);
  saveRos(folder);
  saveCameraFormats(folder);
  saveArrays(folder);
  savePayloads(folder);
  saveFoxglove(folder);
  std::string packed;
  ros::packZstd(contentOf(folder / "mcap/plain"), packed);
  save(folder / "packed/mcap", packed);
}
