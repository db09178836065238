// A connection to a server, by TCP or a local socket. Waits end by a stop or after a time.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

namespace evical {

// Parts of "tcp://host:port", "ws://host:port/path" or "unix:///path".
struct LiveAddress {
  std::string scheme, host, port, path;  // path: of a local socket, or of the request
};

// Throws CalibrationError (BadInput) that says how addresses are written.
LiveAddress liveAddress(const std::string& address);

class Socket {
 public:
  static constexpr std::chrono::seconds kPatience{5};  // for a connection
  static constexpr std::chrono::milliseconds kForever{std::chrono::hours{24 * 365}};

  Socket() = default;
  // Throws CalibrationError (BadInput) if nobody answers, and Cancelled.
  Socket(const LiveAddress& address, std::stop_token stop);
  ~Socket();
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&& other) noexcept;

  // Bytes that have arrived, at least one; 0 if the server has closed, the connection is broken, or a stop is
  // requested.
  std::size_t readSome(char* bytes, std::size_t count);
  // Longest wait of a read from now on; after it the connection counts as broken.
  void setPatience(std::chrono::milliseconds patience) { patience_ = patience; }
  bool hasMore() const;  // a read would not wait
  // False if the end came before.
  bool readAll(char* bytes, std::size_t count);
  bool writeAll(std::string_view bytes);

 private:
  friend class Listener;
  bool connectTo(const void* place, std::size_t size, int family);
  bool awaits(short what, std::chrono::milliseconds patience) const;
  void close();

  int socket_ = -1;
  std::stop_token stop_;
  std::chrono::milliseconds patience_{kForever};
};

// Waits for connections at an address of this machine.
class Listener {
 public:
  Listener() = default;
  // Port 0: any free one. Throws CalibrationError (BadInput) if it cannot be used.
  Listener(const LiveAddress& address, std::stop_token stop);

  int port() const { return port_; }
  std::optional<Socket> accept();  // the next client that waits

 private:
  Socket socket_;
  int port_ = 0;
};

}  // namespace evical
