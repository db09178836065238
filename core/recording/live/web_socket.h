// A WebSocket (RFC 6455) as a client or a server. Beast's headers are in its source only: they are slow to
// compile.
#pragma once

#include "core/recording/live/socket.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

class WebSocket {
 public:
  enum class Content { Text, Binary };

  // Offers all subprotocols. Throws CalibrationError (BadInput) if the server refuses, and Cancelled.
  static WebSocket connect(const LiveAddress& address, const std::string& subprotocols,
                           const std::stop_token& stop);
  // The server's part of a new connection; false if the client does not offer `subprotocol`.
  static WebSocket accept(Socket client, const std::string& subprotocol);

  ~WebSocket();
  WebSocket(WebSocket&& other) noexcept;
  WebSocket& operator=(WebSocket&& other) noexcept;

  bool isOpen() const;
  void setPatience(std::chrono::milliseconds patience);
  // The next message; false at the end. why() is then the reason, unless the other side has closed.
  bool read(std::string& message, Content& content);
  bool write(Content content, std::string_view message);
  // Something has arrived.
  bool hasMore() const;
  const std::string& why() const;

 private:
  struct Stream;
  explicit WebSocket(std::unique_ptr<Stream> stream);
  std::unique_ptr<Stream> stream_;
};

}  // namespace evical
