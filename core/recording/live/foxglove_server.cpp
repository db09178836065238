#include "core/recording/live/foxglove_server.h"

#include "core/base/error.h"
#include "core/recording/live/foxglove_stream.h"
#include "core/recording/live/web_socket.h"
#include "core/recording/recording_writer.h"
#include "core/recording/ros/message_types.h"
#include "core/recording/ros/ros_messages.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <thread>
#include <utility>

namespace evical {
namespace {

constexpr ros::Serialization kSerialization = ros::Serialization::Cdr;

class FoxgloveServer : public LiveServer {
 public:
  FoxgloveServer(const LiveAddress& address, std::vector<StreamInfo> streams, const std::stop_token& stop)
      : stop_(stop),
        listener_(address, stop),
        host_(address.host),
        streams_(std::move(streams)),
        sequences_(streams_.size()) {
    for (const StreamInfo& stream : streams_)
      if (stream.type == StreamType::Events && !stream.resolution_px.known())
        throw badInput(stream.name, "the recording does not contain the resolution of its sensor",
                       "Convert it to a format that has the resolution first");
  }

  std::vector<std::string> addresses() const override {
    return {fmt::format("ws://{}:{}", host_, listener_.port())};
  }

  bool awaitClients() override {
    while (!stop_.stop_requested()) {
      accept();
      for (Client& client : clients_)
        if (client.streams.size() == streams_.size()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  void send(std::size_t stream, const Packet& packet, std::uint64_t time_ns) override {
    accept();
    if (!packet.events.empty()) {
      message_.clear();
      encodeEventArray(packet.events, sequences_[stream]++, streams_[stream].resolution_px, kSerialization,
                       message_);
      sendMessage(stream, time_ns);
    }
    std::vector<ImuSample> samples;
    toSi(packet.imu_samples, AccelerationUnit::Gravity, AngularRateUnit::DegreesPerSecond, samples);
    for (const ImuSample& sample : samples) {
      message_.clear();
      encodeImu(sample, sequences_[stream]++, kSerialization, message_);
      sendMessage(stream, static_cast<std::uint64_t>(sample.time_ns));
    }
  }

 private:
  struct Client {
    WebSocket socket;
    std::map<std::size_t, std::uint32_t> streams;  // subscribed ones, with the subscription
  };

  void accept() {
    while (std::optional<Socket> socket = listener_.accept()) {
      WebSocket web = WebSocket::accept(std::move(*socket), std::string(kFoxgloveSdk));
      if (web.isOpen() && greet(web)) clients_.push_back({std::move(web), {}});
    }
    for (Client& client : clients_) takeRequests(client);
    std::erase_if(clients_, [](const Client& client) { return !client.socket.isOpen(); });
  }

  bool greet(WebSocket& web) const {
    const nlohmann::json info = {{"op", "serverInfo"},
                                 {"name", "evical"},
                                 {"capabilities", nlohmann::json::array()},
                                 {"supportedEncodings", {"cdr"}},
                                 {"sessionId", "1"}};
    nlohmann::json channels = nlohmann::json::array();
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      const ros::MessageType& type = streams_[i].type == StreamType::Events
                                         ? ros::eventArrayType(kSerialization)
                                         : ros::imuType(kSerialization);
      channels.push_back({{"id", i + 1},
                          {"topic", streams_[i].name},
                          {"encoding", "cdr"},
                          {"schemaName", type.name},
                          {"schema", type.definition},
                          {"schemaEncoding", "ros2msg"}});
    }
    return web.write(WebSocket::Content::Text, info.dump()) &&
           web.write(WebSocket::Content::Text,
                     nlohmann::json{{"op", "advertise"}, {"channels", channels}}.dump());
  }

  void takeRequests(Client& client) const {
    std::string text;
    WebSocket::Content content{};
    while (client.socket.isOpen() && client.socket.hasMore() && client.socket.read(text, content)) {
      const nlohmann::json request = nlohmann::json::parse(text, nullptr, false);
      if (!request.is_object() || request.value("op", "") != "subscribe") continue;
      for (const nlohmann::json& each : request.value("subscriptions", nlohmann::json::array())) {
        const std::size_t channel = each.value("channelId", std::size_t{0});
        if (channel >= 1 && channel <= streams_.size()) client.streams[channel - 1] = each.value("id", 0U);
      }
    }
  }

  void sendMessage(std::size_t stream, std::uint64_t time_ns) {
    for (Client& client : clients_) {
      const auto subscription = client.streams.find(stream);
      if (subscription == client.streams.end()) continue;
      frame_ = numberBytes(std::uint8_t{1}) + numberBytes(subscription->second) + numberBytes(time_ns);
      frame_ += message_;
      static_cast<void>(client.socket.write(WebSocket::Content::Binary, frame_));
    }
  }

  std::stop_token stop_;
  Listener listener_;
  std::string host_;
  std::vector<StreamInfo> streams_;
  std::vector<std::uint32_t> sequences_;
  std::vector<Client> clients_;
  std::string message_, frame_;
};

}  // namespace

std::unique_ptr<LiveServer> createFoxgloveServer(const LiveAddress& address,
                                                 const std::vector<StreamInfo>& streams,
                                                 const std::stop_token& stop) {
  return std::make_unique<FoxgloveServer>(address, streams, stop);
}

}  // namespace evical
