// iniVation's network streams: from our server, from servers of other versions, and from bad ones.
#include "core/base/error.h"
#include "core/recording/aedat/packet_compression.h"
#include "core/recording/aedat/packets.h"
#include "core/recording/live/live_player.h"
#include "core/recording/live/live_recording.h"
#include "core/recording/live/live_source.h"
#include "core/recording/live/lost_packets.h"
#include "core/recording/live/socket.h"
#include "tests/core/recording/live/one_server.h"
#include "tests/core/recording/sample_recording.h"
#include "tests/support/test_program.h"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <thread>

using namespace evical;
using namespace evical::test;

namespace {

// The description of a stream by dv-processing.
std::string description(std::string_view type, bool size) {
  return fmt::format(
      R"(<dv version="2.0">
    <node name="outInfo" path="/outInfo/">
        <node name="0" path="/outInfo/0/">
            <attr key="compression" type="string">NONE</attr>
            <attr key="originalModuleName" type="string">dv-processing</attr>
            <attr key="originalOutputName" type="string">events</attr>
            <attr key="typeIdentifier" type="string">{}</attr>
            <node name="info" path="/outInfo/0/info/">
                {}<attr key="source" type="string">DVXplorer_123</attr>
            </node>
        </node>
    </node>
</dv>
)",
      type,
      size ? R"(<attr key="sizeX" type="int">640</attr>
                <attr key="sizeY" type="int">480</attr>
                )"
           : "");
}

std::string header(aedat::Compression compression, bool size = true) {
  std::size_t unused = 0;
  return aedat::encodeHeader({static_cast<std::int32_t>(compression), -1, description("EVTS", size)}, unused);
}

std::string packet(aedat::Compression compression, const std::vector<Event>& events) {
  std::string packed;
  const std::string content = aedat::encodeEvents(events);
  if (compression == aedat::Compression::None)
    packed = content;
  else
    aedat::pack(compression, content, packed);
  return numberBytes(std::int32_t{0}) + numberBytes(static_cast<std::int32_t>(packed.size())) + packed;
}

std::string packets(aedat::Compression compression, const std::vector<Event>& events) {
  std::string bytes;
  for (std::size_t i = 0; i < events.size(); i += 1000) {
    const auto begin = events.begin() + static_cast<std::ptrdiff_t>(i);
    bytes += packet(compression, {begin, begin + std::min<std::ptrdiff_t>(1000, events.end() - begin)});
  }
  return bytes;
}

}  // namespace

class TestDvStream : public QObject {
  Q_OBJECT
 private slots:
  void initTestCase() {
    LivePatience::first_bytes = std::chrono::milliseconds(700);
    LivePatience::again = std::chrono::milliseconds(250);
  }
  void ourServer_sendsEverything_data();
  void ourServer_sendsEverything();
  void otherServers_areRead_data();
  void otherServers_areRead();
  void brokenConnection_isOpenedAgain();
  void otherStreamsAfterwards_areRefused();
  void cutAnywhere_keepsWhatArrived();
  void damagedAnywhere_doesNotCrash();
  void badServers_areExplained_data();
  void badServers_areExplained();
  void badAddresses_areExplained_data();
  void badAddresses_areExplained();
  void droppedPackets_areReported();
  void restAndFlicker_areNoLoss();

 private:
  LiveSummary record(const std::vector<std::string>& sources,
                     const std::string& output = "recorded.aedat4") const {
    LiveRequest request;
    request.sources = sources;
    request.output = folder_ / output;
    std::filesystem::remove(request.output);
    return recordLive(request, {});
  }
  // The error, if it ended with one.
  std::optional<std::string> errorOf(const std::string& address) const {
    try {
      record({address});
    } catch (const CalibrationError& error) {
      return error.what();
    }
    return std::nullopt;
  }
  ScratchFolder folder_;
};

void TestDvStream::ourServer_sendsEverything_data() {
  QTest::addColumn<QString>("output");
  for (const char* output : {"served.aedat4", "served.mcap", "served.bag"}) QTest::newRow(output) << output;
}

void TestDvStream::ourServer_sendsEverything() {
  QFETCH(QString, output);
  const Recording recording = sampleRecording(600'000);
  const std::filesystem::path path = folder_ / "source.bag";
  writeAll(*createBag(path, sampleStreams(), false), recording);
  std::vector<std::string> addresses;
  Log log;
  const int port = 21'000 + static_cast<int>(::getpid() % 10'000);
  std::jthread serving([&] {
    playRecording({path, fmt::format("tcp://127.0.0.1:{}", port), 20.0}, {log, {}});
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  const LiveSummary made =
      record({fmt::format("tcp://127.0.0.1:{}", port), fmt::format("tcp://127.0.0.1:{}", port + 1)},
             output.toStdString());
  QCOMPARE(made.events, std::uint64_t{600'000});
  QCOMPARE(made.imu_samples, recording.imu_samples.size());
  QVERIFY2(made.faults.empty(), made.faults.empty() ? "" : made.faults.front().text.c_str());
  const Contents got = readAll(folder_ / output.toStdString());
  QCOMPARE(got.eventCount(), std::size_t{600'000});
  QCOMPARE(got.sampleCount(), recording.imu_samples.size());
}

void TestDvStream::otherServers_areRead_data() {
  QTest::addColumn<int>("compression");
  QTest::addColumn<bool>("header");
  for (const bool header : {true, false})
    for (int compression = 0; compression < aedat::kCompressions; ++compression)
      QTest::addRow("%s, %s", aedat::compressionName(static_cast<aedat::Compression>(compression)).data(),
                    header ? "header" : "no header")
          << compression << header;
}

void TestDvStream::otherServers_areRead() {
  QFETCH(int, compression);
  QFETCH(bool, header);
  const auto packed = static_cast<aedat::Compression>(compression);
  const std::vector<Event> events = someEvents(50'000);
  const OneServer server({(header ? ::header(packed) : "") + packets(packed, events)});
  LiveRequest request;
  request.sources = {server.address()};
  request.output = folder_ / "other.bag";
  if (!header) request.resolution_px = {640, 480};
  recordLive(request, {});
  const Contents got = readAll(request.output);
  QCOMPARE(got.eventCount(), events.size());
  QVERIFY(sameEvents(got.events.begin()->second, events));
  QCOMPARE(got.streams.front().resolution_px, (Resolution{640, 480}));
}

void TestDvStream::brokenConnection_isOpenedAgain() {
  const auto none = aedat::Compression::None;
  const std::vector<Event> events = someEvents(50'000);
  const std::string first = header(none) + packets(none, {events.begin(), events.begin() + 20'000});
  const OneServer server({first.substr(0, first.size() - 100),  // within a packet
                          header(none) + packets(none, {events.begin() + 30'000, events.end()})});
  const LiveSummary made = record({server.address()});
  QCOMPARE(made.events, std::uint64_t{39'000});
  QVERIFY(std::ranges::any_of(made.faults, [](const RecordingFault& fault) {
    return fault.kind == FaultKind::LostMessages && fault.text.starts_with("The connection broke ") &&
           fault.text.find("opened again") != std::string::npos;
  }));
  QCOMPARE(readAll(folder_ / "recorded.aedat4").eventCount(), std::size_t{39'000});
}

void TestDvStream::otherStreamsAfterwards_areRefused() {
  const auto none = aedat::Compression::None;
  const OneServer server({header(none) + packets(none, someEvents(5'000)), header(none, false)});
  const std::optional<std::string> error = errorOf(server.address());
  QVERIFY(error && error->find("started again with other streams") != std::string::npos);
  QCOMPARE(readAll(folder_ / "recorded.aedat4").eventCount(), std::size_t{5'000});  // what came before
}

void TestDvStream::cutAnywhere_keepsWhatArrived() {
  const auto lz4 = aedat::Compression::Lz4;
  const std::string start = header(lz4), whole = start + packets(lz4, someEvents(3'000));
  const std::size_t first = whole.size() - packets(lz4, someEvents(3'000)).size();
  for (std::size_t cut = 1; cut < whole.size(); cut += cut < start.size() + 40 ? 37 : 1711) {
    const OneServer server({whole.substr(0, cut)});
    const std::optional<std::string> error = errorOf(server.address());
    QCOMPARE(error.has_value(), cut < first);
    if (error) QVERIFY2(error->starts_with(server.address()), error->c_str());
  }
}

void TestDvStream::damagedAnywhere_doesNotCrash() {
  const auto lz4 = aedat::Compression::Lz4;
  const std::string whole = header(lz4) + packets(lz4, someEvents(3'000));
  std::mt19937 random(3);
  for (int k = 0; k < 60; ++k) {
    std::string bytes = whole;
    const std::size_t end = k % 2 == 0 ? header(lz4).size() + 16 : whole.size();
    for (int i = 0; i < 3; ++i) bytes[random() % end] = static_cast<char>(random());
    const OneServer server({bytes});
    const auto begin = std::chrono::steady_clock::now();
    const std::optional<std::string> error = errorOf(server.address());
    if (error) QVERIFY2(error->starts_with(server.address()), error->c_str());
    QVERIFY(std::chrono::steady_clock::now() - begin < std::chrono::seconds(15));
  }
}

void TestDvStream::badServers_areExplained_data() {
  QTest::addColumn<QByteArray>("sent");
  QTest::addColumn<QString>("problem");
  const auto none = aedat::Compression::None;
  const auto bytes = [](const std::string& text) { return QByteArray::fromStdString(text); };
  const std::string packet_10_gb = numberBytes(std::int32_t{0}) + numberBytes(std::int32_t{0x7fffffff});
  QTest::newRow("silence") << QByteArray() << "it is connected, but nothing has arrived for 0.7 s";
  QTest::newRow("huge header")
      << bytes(numberBytes(0xffff'fff0U) + numberBytes(32U) + "IOHE")
      << "the header states 4294967280 bytes: iniVation's programs send nothing like this";
  QTest::newRow("web server") << bytes("HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n")
                              << "iniVation's programs send nothing like this";
  QTest::newRow("unknown compression")
      << bytes(header(static_cast<aedat::Compression>(9))) << "the header is damaged";
  QTest::newRow("huge packet") << bytes(header(none) + packet_10_gb)
                               << "a packet of stream 0 states 2147483647 bytes";
  QTest::newRow("negative packet") << bytes(header(none) + numberBytes(std::int32_t{0}) +
                                            numberBytes(std::int32_t{-5}))
                                   << "a packet of stream 0 states -5 bytes";
}

void TestDvStream::badServers_areExplained() {
  QFETCH(QByteArray, sent);
  QFETCH(QString, problem);
  const OneServer server({sent.toStdString()});
  const std::optional<std::string> error = errorOf(server.address());
  QVERIFY(error.has_value());
  QVERIFY2(error->starts_with(server.address()) && error->find(problem.toStdString()) != std::string::npos,
           error->c_str());
}

void TestDvStream::badAddresses_areExplained_data() {
  QTest::addColumn<QString>("address");
  QTest::addColumn<QString>("problem");
  for (const char* address :
       {"tcp://", "tcp://localhost", "tcp://:7777", "tcp://localhost:x", "tcp://localhost:123456",
        "udp://localhost:7777", "unix://relative", "http://localhost:80"})
    QTest::newRow(address) << address << "this is not the address of a stream";
  QTest::newRow("nobody") << "tcp://127.0.0.1:1"
                          << "cannot be reached: Connection refused";
  QTest::newRow("no socket") << "unix:///nowhere"
                             << "cannot be reached: No such file";
}

void TestDvStream::badAddresses_areExplained() {
  QFETCH(QString, address);
  QFETCH(QString, problem);
  const std::optional<std::string> error = errorOf(address.toStdString());
  QVERIFY(error && QString::fromStdString(*error).contains(problem));
}

void TestDvStream::droppedPackets_areReported() {
  LostPackets events, samples;
  const std::vector<Event> all = someEvents(200'000);
  const std::vector<ImuSample> imu = someSamples(2000);
  for (std::size_t i = 0; i < 200; ++i) {
    if (i == 100 || i == 101) continue;
    Packet packet;
    packet.events.assign(all.begin() + static_cast<std::ptrdiff_t>(1000 * i),
                         all.begin() + static_cast<std::ptrdiff_t>(1000 * (i + 1)));
    events.add(packet);
    packet.clear();
    for (std::size_t k = 10 * i; k < 10 * (i + 1); ++k)
      packet.imu_samples.push_back({imu[k].time_ns, {}, {}});
    samples.add(packet);
  }
  const auto lost_events = events.fault("events"), lost_samples = samples.fault("imu");
  QVERIFY(lost_events && lost_samples);
  QVERIFY2(lost_events->text.starts_with(
               "About 2000 events are missing in 1 gap of 20 ms in all, the first at 1.000 s"),
           lost_events->text.c_str());
  QVERIFY2(lost_samples->text.starts_with(
               "About 20 samples are missing in 1 gap of 21 ms in all, the first at 0.999 s"),
           lost_samples->text.c_str());
}

// A camera that comes to rest, and a lamp.
void TestDvStream::restAndFlicker_areNoLoss() {
  LostPackets rest, lamp;
  std::int64_t time_ns = 0, lamp_ns = 0;
  for (int k = 0; k < 2000; ++k) {
    Packet packet;
    const int count = k % 400 < 300 ? 2000 : 3;  // noise only
    for (int i = 0; i < count; ++i) packet.events.push_back({time_ns + i * (10'000'000 / count), 1, 1, true});
    time_ns += 10'000'000;
    rest.add(packet);
    packet.clear();
    for (int i = 0; i < 5000; ++i) packet.events.push_back({lamp_ns + i * 100, 1, 1, true});
    lamp_ns += 10'000'000;
    lamp.add(packet);
  }
  QVERIFY(!rest.fault("events") && !lamp.fault("events"));
}

EVICAL_TEST(TestDvStream)
#include "tst_dv_stream.moc"
