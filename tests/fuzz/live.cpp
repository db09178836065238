// Live streams, one program per protocol (EVICAL_FUZZ_PROTOCOL): a server sends the bytes, and closes. For
// Foxglove's protocol they are messages: kind, length in two bytes, content.
#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/recording/live/foxglove_stream.h"
#include "core/recording/live/live_source.h"
#include "core/recording/live/web_socket.h"
#include "tests/core/recording/live/one_server.h"

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

namespace {

using namespace evical;

constexpr bool kFoxglove = std::string_view(EVICAL_FUZZ_PROTOCOL) == "foxglove";

void sendMessages(Socket client, std::string_view bytes) {
  WebSocket web = WebSocket::accept(std::move(client), std::string(kFoxgloveSdk));
  constexpr std::size_t kHead_bytes = 3;
  while (web.isOpen() && bytes.size() >= kHead_bytes) {
    const auto kind = bytes[0] % 2 == 0 ? WebSocket::Content::Text : WebSocket::Content::Binary;
    const std::size_t length = static_cast<unsigned char>(bytes[1]) | static_cast<unsigned char>(bytes[2])
                                                                          << 8U;
    bytes.remove_prefix(kHead_bytes);
    if (!web.write(kind, bytes.substr(0, length))) return;
    bytes.remove_prefix(std::min(length, bytes.size()));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  LivePatience::first_bytes = std::chrono::milliseconds(500);
  LivePatience::again = std::chrono::milliseconds(0);
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const test::OneServer server({test::OneServer::Serve([&](Socket client, const std::stop_token& /*stop*/) {
    if (kFoxglove)
      sendMessages(std::move(client), bytes);
    else
      static_cast<void>(client.writeAll(bytes));
  })});
  try {
    const auto reader = openLive(server.address(kFoxglove ? "ws" : "tcp"), "/tmp", {});
    for (Packet packet; reader->read(packet);)
      if (packet.empty() || packet.stream >= reader->streams().size()) std::abort();
  } catch (const CalibrationError& error) {
    if (std::string_view(error.what()).empty()) std::abort();
  }
  return 0;
}
