#include "core/recording/live/foxglove_stream.h"

#include "core/base/error.h"
#include "core/recording/byte_cursor.h"
#include "core/recording/live/live_source.h"
#include "core/recording/live/reconnection.h"
#include "core/recording/live/web_socket.h"
#include "core/recording/recording_writer.h"
#include "core/recording/ros/mcap_records.h"
#include "core/recording/ros/message_cursor.h"
#include "core/recording/ros/message_types.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <map>
#include <optional>
#include <string>
#include <utility>

namespace evical {
namespace {

using ros::sized;

// A topic of the server, and its place in the file.
struct FoxgloveTopic {
  std::uint16_t id = 0;
  std::string description;  // schema and channel; equal after a new connection
  std::uint32_t sequence = 0;
};

class FoxgloveStream {
 public:
  FoxgloveStream(const std::string& address, Spool& spool, const std::stop_token& stop)
      : address_(address), spool_(spool), stop_(stop) {}

  void run();

 private:
  WebSocket connect() const;
  bool readAll(WebSocket& server);
  void takeText(const std::string& text, WebSocket& server);
  void takeChannel(const nlohmann::json& channel, nlohmann::json& subscriptions);
  void takeMessage(std::string_view bytes);
  [[noreturn]] void refuse(const std::string& problem) const;

  const std::string& address_;
  Spool& spool_;
  const std::stop_token& stop_;
  bool began_ = false, is_foxglove_ = false;
  std::map<std::string, FoxgloveTopic> topics_;              // by name
  std::map<std::uint32_t, FoxgloveTopic*> of_subscription_;  // of this connection
};

void FoxgloveStream::refuse(const std::string& problem) const {
  throw badInput(address_, problem + ": servers of Foxglove's protocol send nothing like this",
                 "Start foxglove_bridge, and give its port");
}

WebSocket FoxgloveStream::connect() const {
  return WebSocket::connect(liveAddress(address_), fmt::format("{}, {}", kFoxgloveSdk, kFoxgloveWebSocket),
                            stop_);
}

// u8 1, u32 subscription, u64 time, payload.
void FoxgloveStream::takeMessage(std::string_view bytes) {
  ByteCursor cursor(bytes);
  if (cursor.number<std::uint8_t>() != 1) return;  // a kind that no subscription asked for
  const auto subscription = cursor.number<std::uint32_t>();
  const auto time_ns = cursor.number<std::uint64_t>();
  if (!cursor.ok()) refuse("a message is cut off");
  const auto found = of_subscription_.find(subscription);
  if (found == of_subscription_.end()) return;
  FoxgloveTopic& topic = *found->second;
  const std::string_view payload = bytes.substr(cursor.position());
  std::string head =
      numberBytes(topic.id) + numberBytes(topic.sequence++) + numberBytes(time_ns) + numberBytes(time_ns);
  spool_.append(numberBytes(mcap::Op::Message) + numberBytes(std::uint64_t{head.size() + payload.size()}) +
                head);
  spool_.append(payload);
}

// Other topics are neither read nor requested.
void FoxgloveStream::takeChannel(const nlohmann::json& channel, nlohmann::json& subscriptions) {
  const std::string topic = channel.at("topic"), encoding = channel.at("encoding"),
                    type = channel.at("schemaName"), schema = channel.value("schema", "");
  const bool ros1 = encoding == "ros1";
  if (!ros1 && encoding != "cdr") return;
  const std::string language = channel.value("schemaEncoding", ros1 ? "ros1msg" : "ros2msg");
  if (ros::contentOf(type, "", language.ends_with("msg") ? schema : "") == ros::Content::Other) return;
  const auto [known, is_new] = topics_.try_emplace(topic);
  FoxgloveTopic& entry = known->second;
  if (is_new) entry.id = static_cast<std::uint16_t>(topics_.size());
  const std::string id = numberBytes(entry.id);
  const std::string description =
      mcap::record(mcap::Op::Schema, id + sized(type) + sized(language) + sized(schema)) +
      mcap::record(mcap::Op::Channel, id + id + sized(topic) + sized(encoding) + sized(""));
  if (!is_new && entry.description != description)
    throw badInput(address_, fmt::format("the topic {} now has another type", topic), "Record again");
  if (is_new) spool_.append(description);
  entry.description = description;
  of_subscription_[entry.id] = &entry;
  subscriptions.push_back({{"id", entry.id}, {"channelId", channel.at("id")}});
}

void FoxgloveStream::takeText(const std::string& text, WebSocket& server) {
  constexpr std::size_t kMaxTopics = 1000;
  try {
    const nlohmann::json message = nlohmann::json::parse(text);
    const std::string op = message.at("op");
    if (op == "serverInfo") is_foxglove_ = true;
    if (op == "status" && message.value("level", 0) == 2)
      spool_.note(FaultKind::Metadata, "The server reports: " + message.value("message", ""));
    if (op != "advertise") return;
    nlohmann::json subscriptions = nlohmann::json::array();
    for (const nlohmann::json& channel : message.at("channels"))
      if (topics_.size() < kMaxTopics) takeChannel(channel, subscriptions);
    if (subscriptions.empty()) return;
    const nlohmann::json request = {{"op", "subscribe"}, {"subscriptions", subscriptions}};
    static_cast<void>(server.write(WebSocket::Content::Text, request.dump()));
  } catch (const nlohmann::json::exception& error) {
    refuse(fmt::format("a message cannot be understood ({})", error.what()));
  }
}

// False if the connection broke, rather than was closed.
bool FoxgloveStream::readAll(WebSocket& server) {
  std::string message;
  WebSocket::Content content{};
  of_subscription_.clear();
  is_foxglove_ = false;
  server.setPatience(LivePatience::first_bytes);
  while (server.read(message, content)) {
    if (content == WebSocket::Content::Text) takeText(message, server);
    if (!is_foxglove_) refuse("the first message is not serverInfo");
    if (content == WebSocket::Content::Binary) takeMessage(message);
    server.setPatience(Socket::kForever);
  }
  return server.why().empty();
}

void FoxgloveStream::run() {
  keepConnected<WebSocket>(
      spool_, stop_, [this] { return connect(); },
      [this](WebSocket& server) {
        if (!began_) {
          spool_.append(mcap::kMagic);
          spool_.append(mcap::record(mcap::Op::Header, sized("") + sized("foxglove")));
        }
        began_ = true;
        const bool closed = readAll(server);
        if (closed && topics_.empty() && !stop_.stop_requested())
          throw badInput(address_, "the server closed before it offered a topic with events or IMU samples",
                         "Check which topics it sends");
        return closed ? Ended::Closed : Ended::Broken;
      });
}

}  // namespace

void storeFoxgloveStream(const std::string& address, Spool& spool, const std::stop_token& stop) {
  FoxgloveStream(address, spool, stop).run();
}

}  // namespace evical
