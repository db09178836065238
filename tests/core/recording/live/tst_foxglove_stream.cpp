// Foxglove's WebSocket protocol: from our server, from servers of other versions, and from bad ones.
#include "core/base/error.h"
#include "core/recording/live/foxglove_stream.h"
#include "core/recording/live/live_player.h"
#include "core/recording/live/live_recording.h"
#include "core/recording/live/live_source.h"
#include "core/recording/live/web_socket.h"
#include "core/recording/ros/message_types.h"
#include "core/recording/ros/ros_messages.h"
#include "tests/core/recording/live/one_server.h"
#include "tests/core/recording/sample_recording.h"
#include "tests/support/test_program.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

using namespace evical;
using namespace evical::test;

namespace {

const std::string kInfo = R"({"op":"serverInfo","name":"bridge","capabilities":[],"sessionId":"x"})";

std::string advertise(ros::Serialization serialization, int id = 1) {
  const ros::MessageType& type = ros::imuType(serialization);
  const bool ros1 = serialization == ros::Serialization::Ros1;
  nlohmann::json channel = {{"id", id},
                            {"topic", "/imu"},
                            {"encoding", ros1 ? "ros1" : "cdr"},
                            {"schemaName", type.name},
                            {"schema", type.definition}};
  if (!ros1) channel["schemaEncoding"] = "ros2msg";  // older servers leave it out
  const nlohmann::json other = {
      {"id", 77}, {"topic", "/tf"}, {"encoding", "json"}, {"schemaName", "tf"}, {"schema", "{}"}};
  return nlohmann::json{{"op", "advertise"}, {"channels", {other, channel}}}.dump();
}

std::string message(std::uint32_t subscription, const ImuSample& sample, ros::Serialization serialization) {
  std::string bytes = "\x01";
  bytes += numberBytes(subscription) + numberBytes(static_cast<std::uint64_t>(sample.time_ns));
  std::string payload;
  ros::encodeImu(sample, 0, serialization, payload);
  return bytes + payload;
}

// A bridge that sends text first, waits for a subscription, and then sends the samples.
OneServer::Serve bridge(const std::string& subprotocol, const std::vector<std::string>& texts,
                        const std::vector<ImuSample>& samples, ros::Serialization serialization) {
  return [=](Socket client, const std::stop_token& /*stop*/) {
    WebSocket web = WebSocket::accept(std::move(client), subprotocol);
    if (!web.isOpen()) return;
    web.setPatience(std::chrono::milliseconds(2000));
    for (const std::string& text : texts)
      if (!web.write(WebSocket::Content::Text, text)) return;
    std::string request;
    WebSocket::Content content{};
    if (!web.read(request, content)) return;
    const nlohmann::json wanted = nlohmann::json::parse(request);
    if (wanted.at("op") != "subscribe" || wanted.at("subscriptions").size() != 1) return;
    const auto subscription = wanted.at("subscriptions").front().at("id").get<std::uint32_t>();
    web.write(WebSocket::Content::Binary,
              std::string("\x02", 1) + std::string(8, '\0'));  // the server's time
    web.write(WebSocket::Content::Text, R"({"op":"status","level":0,"message":"hello"})");
    for (const ImuSample& sample : samples)
      if (!web.write(WebSocket::Content::Binary, message(subscription, sample, serialization))) return;
  };
}

}  // namespace

class TestFoxgloveStream : public QObject {
  Q_OBJECT
 private slots:
  void initTestCase() {
    LivePatience::first_bytes = std::chrono::milliseconds(700);
    LivePatience::again = std::chrono::milliseconds(250);
  }
  void ourServer_sendsEverything();
  void otherServers_areRead_data();
  void otherServers_areRead();
  void brokenConnection_isOpenedAgain();
  void cutAnywhere_endsWell();
  void badServers_areExplained_data();
  void badServers_areExplained();
  void badMessages_areExplained_data();
  void badMessages_areExplained();

 private:
  LiveSummary record(const std::string& source) const {
    LiveRequest request;
    request.sources = {source};
    request.output = folder_ / "recorded.mcap";
    std::filesystem::remove(request.output);
    return recordLive(request, {});
  }
  std::string errorOf(const std::string& address) const {
    try {
      record(address);
    } catch (const CalibrationError& error) {
      return error.what();
    }
    return {};
  }
  ScratchFolder folder_;
};

void TestFoxgloveStream::ourServer_sendsEverything() {
  const Recording recording = sampleRecording(300'000);
  const std::filesystem::path path = folder_ / "source.bag";
  writeAll(*createBag(path, sampleStreams(), false), recording);
  const std::string address = fmt::format("ws://127.0.0.1:{}", 11'000 + ::getpid() % 10'000);
  const std::jthread serving([&] { playRecording({path, address, 20.0}, {}); });
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  const LiveSummary made = record(address);
  QVERIFY2(made.faults.empty(), made.faults.empty() ? "" : made.faults.front().text.c_str());
  const Contents got = readAll(folder_ / "recorded.mcap");
  QCOMPARE(got.streams.size(), std::size_t{2});
  for (std::size_t i = 0; i < 2; ++i) {
    const bool events = got.streams[i].type == StreamType::Events;
    QCOMPARE(got.streams[i].name, events ? "/dvs/events" : "/dvs/imu");
    if (events) QVERIFY(sameEvents(got.events.at(i), recording.events));
    if (!events) QCOMPARE(got.imu.at(i).size(), recording.imu_samples.size());
  }
  QCOMPARE(made.events, std::uint64_t{300'000});
}

void TestFoxgloveStream::otherServers_areRead_data() {
  QTest::addColumn<QString>("subprotocol");
  QTest::addColumn<bool>("ros1");
  for (const std::string_view subprotocol : {kFoxgloveSdk, kFoxgloveWebSocket})
    for (const bool ros1 : {false, true})
      QTest::addRow("%s, %s", subprotocol.data(), ros1 ? "ROS 1" : "ROS 2")
          << QString(subprotocol.data()) << ros1;
}

void TestFoxgloveStream::otherServers_areRead() {
  QFETCH(QString, subprotocol);
  QFETCH(bool, ros1);
  const auto serialization = ros1 ? ros::Serialization::Ros1 : ros::Serialization::Cdr;
  const std::vector<ImuSample> samples = someSamples(500);
  const OneServer server(
      {bridge(subprotocol.toStdString(), {kInfo, advertise(serialization)}, samples, serialization)});
  record(server.address("ws"));
  const Contents got = readAll(folder_ / "recorded.mcap");
  QCOMPARE(got.streams.size(), std::size_t{1});
  QVERIFY(sameSamples(got.imu.at(0), samples));
}

void TestFoxgloveStream::brokenConnection_isOpenedAgain() {
  const auto cdr = ros::Serialization::Cdr;
  const std::vector<ImuSample> samples = someSamples(400);
  const std::string sdk(kFoxgloveSdk);
  // The restarted server has other numbers.
  const OneServer server(
      {bridge(sdk, {kInfo, advertise(cdr, 1)}, {samples.begin(), samples.begin() + 200}, cdr),
       bridge(sdk, {kInfo, advertise(cdr, 9)}, {samples.begin() + 300, samples.end()}, cdr)});
  const LiveSummary made = record(server.address("ws"));
  QCOMPARE(made.imu_samples, std::uint64_t{300});
  const auto isKind = [&](std::string_view begin) {
    return std::ranges::any_of(made.faults,
                               [&](const RecordingFault& fault) { return fault.text.starts_with(begin); });
  };
  QVERIFY(isKind("The connection broke "));
  QVERIFY(isKind("About 100 samples are missing in 1 gap of 101 ms"));
}

// The bytes of a session, cut after each of them.
void TestFoxgloveStream::cutAnywhere_endsWell() {
  const std::string response =
      "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: "
      "Upgrade\r\nSec-WebSocket-Accept: "
      "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n\r\n";
  for (std::size_t cut = 1; cut <= response.size(); cut += 9) {
    const OneServer server({std::vector<std::string>{response.substr(0, cut)}});
    const std::string error = errorOf(server.address("ws"));
    QVERIFY2(error.find("the server does not answer as a WebSocket") != std::string::npos, error.c_str());
  }
}

void TestFoxgloveStream::badServers_areExplained_data() {
  QTest::addColumn<QByteArray>("sent");
  QTest::addColumn<QString>("problem");
  QTest::newRow("silence") << QByteArray() << "it is connected, but nothing has arrived for 0.7 s";
  QTest::newRow("refusal") << QByteArray("HTTP/1.1 400 Bad Request\r\nContent-Length: 0\r\n\r\n")
                           << "the server refuses this WebSocket";
  QTest::newRow("header without an end") << ("HTTP/1.1 200 OK\r\n" + QByteArray("X: 1\r\n").repeated(5000))
                                         << "the server does not answer as a WebSocket";
  QTest::newRow("noise") << QByteArray(3000, '\x8f') << "the server does not answer as a WebSocket";
}

void TestFoxgloveStream::badServers_areExplained() {
  QFETCH(QByteArray, sent);
  QFETCH(QString, problem);
  const OneServer server({std::vector<std::string>{sent.toStdString()}});
  const std::string error = errorOf(server.address("ws"));
  QVERIFY2(error.find(problem.toStdString()) != std::string::npos, error.c_str());
}

void TestFoxgloveStream::badMessages_areExplained_data() {
  QTest::addColumn<QStringList>("texts");
  QTest::addColumn<QString>("problem");
  const QString info = QString::fromStdString(kInfo);
  QTest::newRow("no JSON") << QStringList{"hello"} << "a message cannot be understood";
  QTest::newRow("deep JSON") << QStringList{QString(100'000, '[')} << "a message cannot be understood";
  QTest::newRow("a list") << QStringList{"[]"} << "a message cannot be understood";
  QTest::newRow("other program") << QStringList{R"({"op":"publish"})"}
                                 << "the first message is not serverInfo";
  QTest::newRow("bad channel") << QStringList{info, R"({"op":"advertise","channels":[{"id":1}]})"}
                               << "a message cannot be understood";
  QTest::newRow("bad id")
      << QStringList{info,
                     R"({"op":"advertise","channels":[{"id":1,"topic":[],"encoding":"cdr","schemaName":"x"}]})"}
      << "a message cannot be understood";
  QTest::newRow("no sensor")
      << QStringList{info,
                     R"({"op":"advertise","channels":[{"id":1,"topic":"/a","encoding":"json","schemaName":"x"}]})"}
      << "the server closed before it offered a topic with events or IMU samples";
}

void TestFoxgloveStream::badMessages_areExplained() {
  QFETCH(QStringList, texts);
  QFETCH(QString, problem);
  std::vector<std::string> sent;
  for (const QString& text : texts) sent.push_back(text.toStdString());
  const OneServer server({OneServer::Serve([&](Socket client, const std::stop_token& /*stop*/) {
    WebSocket web = WebSocket::accept(std::move(client), std::string(kFoxgloveSdk));
    for (const std::string& text : sent) web.write(WebSocket::Content::Text, text);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
  })});
  const std::string error = errorOf(server.address("ws"));
  QVERIFY2(error.find(problem.toStdString()) != std::string::npos, error.c_str());
}

EVICAL_TEST(TestFoxgloveStream)
#include "tst_foxglove_stream.moc"
