#include "core/recording/live/dv_server.h"

#include "core/recording/aedat/packet_compression.h"
#include "core/recording/aedat/packets.h"
#include "core/recording/aedat/stream_description.h"
#include "core/recording/recording_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <thread>
#include <utility>

namespace evical {
namespace {

constexpr aedat::Compression kCompression = aedat::Compression::Lz4;
constexpr std::int32_t kId = 0;  // of the only stream of a connection

class DvServer : public LiveServer {
 public:
  DvServer(const LiveAddress& address, const std::vector<StreamInfo>& streams, const std::stop_token& stop)
      : stop_(stop) {
    const std::vector<aedat::DeviceName> names = aedat::deviceNames(streams);
    int port = std::stoi(address.port);
    for (std::size_t i = 0; i < streams.size(); ++i, ++port) {
      Stream& stream = streams_.emplace_back();
      LiveAddress own = address;
      own.port = std::to_string(port);
      stream.listener = Listener(own, stop);
      stream.address = fmt::format("tcp://{}:{}", address.host, stream.listener.port());
      stream.header = headerOf(streams[i], names[i]);
    }
  }

  std::vector<std::string> addresses() const override {
    std::vector<std::string> all;
    for (const Stream& stream : streams_) all.push_back(stream.address);
    return all;
  }

  bool awaitClients() override {
    while (!stop_.stop_requested()) {
      for (Stream& stream : streams_) accept(stream);
      if (std::ranges::none_of(streams_, [](const Stream& stream) { return stream.clients.empty(); }))
        return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  void send(std::size_t index, const Packet& packet, std::uint64_t /*time_ns*/) override {
    Stream& stream = streams_[index];
    accept(stream);
    const std::string content =
        packet.events.empty() ? aedat::encodeImu(packet.imu_samples) : aedat::encodeEvents(packet.events);
    aedat::pack(kCompression, content, packed_);
    const std::string head = numberBytes(kId) + numberBytes(static_cast<std::int32_t>(packed_.size()));
    std::erase_if(stream.clients,
                  [&](Socket& client) { return !client.writeAll(head) || !client.writeAll(packed_); });
  }

 private:
  struct Stream {
    Listener listener;
    std::string address, header;
    std::vector<Socket> clients;
  };

  static std::string headerOf(const StreamInfo& stream, const aedat::DeviceName& name) {
    aedat::StreamDescription description;
    description.id = kId;
    description.name = name.output;
    description.type = stream.type == StreamType::Events ? "EVTS" : "IMUS";
    description.source = name.source;
    description.size_px = stream.resolution_px;
    aedat::FileHeader header;
    header.compression = static_cast<std::int32_t>(kCompression);
    header.description = aedat::descriptionsXml({description}, aedat::compressionName(kCompression));
    std::size_t unused = 0;
    return aedat::encodeHeader(header, unused);
  }

  static void accept(Stream& stream) {
    while (std::optional<Socket> client = stream.listener.accept())
      if (client->writeAll(stream.header)) stream.clients.push_back(std::move(*client));
  }

  std::stop_token stop_;
  std::vector<Stream> streams_;
  std::string packed_;
};

}  // namespace

std::unique_ptr<LiveServer> createDvServer(const LiveAddress& address, const std::vector<StreamInfo>& streams,
                                           const std::stop_token& stop) {
  return std::make_unique<DvServer>(address, streams, stop);
}

}  // namespace evical
