#include "core/recording/live/socket.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/base/progress.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

namespace evical {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPiece{50};  // of waits

[[noreturn]] void refuse(const std::string& address) {
  throw badInput(
      address, "this is not the address of a stream",
      "Write tcp://HOST:PORT or unix:///PATH for iniVation's streams, ws://HOST:PORT for foxglove_bridge");
}

bool isPort(std::string_view text) {
  return !text.empty() && text.size() <= 5 && text.find_first_not_of("0123456789") == std::string_view::npos;
}

}  // namespace

LiveAddress liveAddress(const std::string& address) {
  const std::size_t colon = address.find("://");
  if (colon == std::string::npos) refuse(address);
  LiveAddress parts{address.substr(0, colon), "", "", ""};
  if (parts.scheme != "unix" && parts.scheme != "tcp" && parts.scheme != "ws") refuse(address);
  std::string rest = address.substr(colon + 3);
  if (parts.scheme == "unix") {
    if (rest.empty() || rest.front() != '/' || rest.size() >= sizeof(sockaddr_un::sun_path)) refuse(address);
    parts.path = std::move(rest);
    return parts;
  }
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  parts.path = rest.substr(slash);
  rest.resize(slash);
  const std::size_t port = rest.rfind(':');
  if (port == std::string::npos || port == 0 || !isPort(rest.substr(port + 1))) refuse(address);
  parts.port = rest.substr(port + 1);
  parts.host = rest.substr(0, port);
  if (parts.host.size() > 2 && parts.host.front() == '[' && parts.host.back() == ']')
    parts.host = parts.host.substr(1, parts.host.size() - 2);
  return parts;
}

Socket::Socket(const LiveAddress& address, std::stop_token stop) : stop_(std::move(stop)) {
  if (address.scheme == "unix") {
    sockaddr_un place{};
    place.sun_family = AF_UNIX;
    address.path.copy(place.sun_path, sizeof place.sun_path - 1);
    if (connectTo(&place, sizeof place, AF_UNIX)) return;
    throw badInput("unix://" + address.path, fmt::format("cannot be reached: {}", std::strerror(errno)),
                   "Start the program that sends, and check the path of its socket");
  }
  addrinfo wanted{}, *found = nullptr;
  wanted.ai_socktype = SOCK_STREAM;
  const std::string name = address.host + ":" + address.port;
  const int failure = ::getaddrinfo(address.host.c_str(), address.port.c_str(), &wanted, &found);
  if (failure != 0)
    throw badInput(name, fmt::format("this host cannot be found: {}", ::gai_strerror(failure)),
                   "Check the name and the network");
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, ::freeaddrinfo);
  for (const addrinfo* each = found; each != nullptr; each = each->ai_next)
    if (connectTo(each->ai_addr, each->ai_addrlen, each->ai_family)) return;
  throw badInput(name, fmt::format("cannot be reached: {}", std::strerror(errno)),
                 "Start the program that sends, and check its address and port");
}

Socket::~Socket() {
  close();
}

Socket::Socket(Socket&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), stop_(std::move(other.stop_)), patience_(other.patience_) {}

Socket& Socket::operator=(Socket&& other) noexcept {
  close();
  socket_ = std::exchange(other.socket_, -1);
  stop_ = std::move(other.stop_);
  patience_ = other.patience_;
  return *this;
}

void Socket::close() {
  if (socket_ >= 0) ::close(std::exchange(socket_, -1));
}

bool Socket::connectTo(const void* place, std::size_t size, int family) {
  close();
  socket_ = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) return false;
  const int large_bytes = 1 << 23;  // servers drop packets if a client is slow
  static_cast<void>(::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &large_bytes, sizeof large_bytes));
  const int outcome = ::connect(socket_, static_cast<const sockaddr*>(place), static_cast<socklen_t>(size));
  if (outcome == 0) return true;
  if (errno != EINPROGRESS) return false;
  if (!awaits(POLLOUT, kPatience)) {
    if (stop_.stop_requested()) throw Cancelled{};
    errno = ETIMEDOUT;
    return false;
  }
  socklen_t length = sizeof errno;
  return ::getsockopt(socket_, SOL_SOCKET, SO_ERROR, &errno, &length) == 0 && errno == 0;
}

bool Socket::awaits(short what, std::chrono::milliseconds patience) const {
  const Clock::time_point end = Clock::now() + patience;
  while (!stop_.stop_requested() && Clock::now() < end) {
    pollfd waiting{socket_, what, 0};
    const int ready = ::poll(&waiting, 1, static_cast<int>(kPiece.count()));
    if (ready > 0) return true;
    if (ready < 0 && errno != EINTR) return false;
  }
  return false;
}

bool Socket::hasMore() const {
  pollfd waiting{socket_, POLLIN, 0};
  return ::poll(&waiting, 1, 0) > 0;
}

std::size_t Socket::readSome(char* bytes, std::size_t count) {
  while (awaits(POLLIN, patience_)) {
    const ssize_t got = ::recv(socket_, bytes, count, 0);
    if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    return got < 0 ? 0 : static_cast<std::size_t>(got);
  }
  return 0;
}

bool Socket::readAll(char* bytes, std::size_t count) {
  while (count > 0) {
    const std::size_t got = readSome(bytes, count);
    if (got == 0) return false;
    bytes += got;
    count -= got;
  }
  return true;
}

bool Socket::writeAll(std::string_view bytes) {
  while (!bytes.empty() && awaits(POLLOUT, kForever)) {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (sent < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(sent));
  }
  return bytes.empty();
}

Listener::Listener(const LiveAddress& address, std::stop_token stop) {
  addrinfo wanted{}, *found = nullptr;
  wanted.ai_socktype = SOCK_STREAM;
  const std::string name = fmt::format("{}:{}", address.host, address.port);
  const int failure = ::getaddrinfo(address.host.c_str(), address.port.c_str(), &wanted, &found);
  if (failure != 0)
    throw badInput(name, fmt::format("this host cannot be found: {}", ::gai_strerror(failure)),
                   "Use localhost, or an address of this machine");
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, ::freeaddrinfo);
  socket_.stop_ = std::move(stop);
  socket_.socket_ = ::socket(found->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int yes = 1;
  static_cast<void>(::setsockopt(socket_.socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes));
  sockaddr_storage place{};
  socklen_t size = sizeof place;
  if (::bind(socket_.socket_, found->ai_addr, found->ai_addrlen) != 0 || ::listen(socket_.socket_, 8) != 0 ||
      ::getsockname(socket_.socket_, reinterpret_cast<sockaddr*>(&place), &size) != 0)
    throw badInput(name, fmt::format("cannot be used: {}", std::strerror(errno)), "Choose another port");
  port_ = ntohs(place.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6&>(place).sin6_port
                                            : reinterpret_cast<const sockaddr_in&>(place).sin_port);
}

std::optional<Socket> Listener::accept() {
  const int client = ::accept4(socket_.socket_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (client < 0) return std::nullopt;
  Socket socket;
  socket.socket_ = client;
  socket.stop_ = socket_.stop_;
  return socket;
}

}  // namespace evical
