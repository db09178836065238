#include "core/recording/live/web_socket.h"

#include "core/base/error.h"
#include "core/base/progress.h"

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/beast/websocket/stream.hpp>

#include <utility>

namespace evical {
namespace {

namespace beast = boost::beast;
namespace asio = boost::asio;
using beast::error_code;

constexpr std::size_t kMaxMessage_bytes = std::size_t{1} << 26;

// Our socket, whose waits end by a stop, as a stream of Beast.
class BeastSocket {
 public:
  using executor_type = asio::io_context::executor_type;

  explicit BeastSocket(Socket socket)
      : socket(std::move(socket)), context_(std::make_unique<asio::io_context>()) {}

  executor_type get_executor() const { return context_->get_executor(); }

  template <class Buffers>
  std::size_t read_some(const Buffers& buffers, error_code& error) {
    error = {};
    for (auto each = asio::buffer_sequence_begin(buffers); each != asio::buffer_sequence_end(buffers);
         ++each) {
      const asio::mutable_buffer buffer(*each);
      if (buffer.size() == 0) continue;
      const std::size_t got = socket.readSome(static_cast<char*>(buffer.data()), buffer.size());
      if (got == 0) error = asio::error::eof;
      return got;
    }
    return 0;
  }
  template <class Buffers>
  std::size_t read_some(const Buffers& buffers) {
    error_code error;
    const std::size_t got = read_some(buffers, error);
    if (error) throw beast::system_error(error);
    return got;
  }
  template <class Buffers>
  std::size_t write_some(const Buffers& buffers, error_code& error) {
    error = {};
    std::size_t sent = 0;
    for (auto each = asio::buffer_sequence_begin(buffers); each != asio::buffer_sequence_end(buffers);
         ++each) {
      const asio::const_buffer buffer(*each);
      if (!socket.writeAll({static_cast<const char*>(buffer.data()), buffer.size()})) {
        error = asio::error::broken_pipe;
        return sent;
      }
      sent += buffer.size();
    }
    return sent;
  }
  template <class Buffers>
  std::size_t write_some(const Buffers& buffers) {
    error_code error;
    const std::size_t sent = write_some(buffers, error);
    if (error) throw beast::system_error(error);
    return sent;
  }

  Socket socket;

 private:
  std::unique_ptr<asio::io_context> context_;
};

[[maybe_unused]] void teardown(beast::role_type /*role*/, BeastSocket& /*socket*/, error_code& error) {
  error = {};
}

namespace http = beast::http;
namespace websocket = beast::websocket;

}  // namespace

struct WebSocket::Stream {
  explicit Stream(Socket socket) : web(std::move(socket)) { web.read_message_max(kMaxMessage_bytes); }

  websocket::stream<BeastSocket> web;
  beast::flat_buffer buffer;
  std::string why;
};

WebSocket::WebSocket(std::unique_ptr<Stream> stream) : stream_(std::move(stream)) {}
WebSocket::~WebSocket() = default;
WebSocket::WebSocket(WebSocket&& other) noexcept = default;
WebSocket& WebSocket::operator=(WebSocket&& other) noexcept = default;

WebSocket WebSocket::connect(const LiveAddress& address, const std::string& subprotocols,
                             const std::stop_token& stop) {
  const std::string name = fmt::format("ws://{}:{}{}", address.host, address.port, address.path);
  auto stream = std::make_unique<Stream>(Socket(address, stop));
  stream->web.next_layer().socket.setPatience(Socket::kPatience);
  stream->web.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
    request.set(http::field::sec_websocket_protocol, subprotocols);
  }));
  websocket::response_type response;
  error_code error;
  stream->web.handshake(response, fmt::format("{}:{}", address.host, address.port),
                        address.path.empty() ? "/" : address.path, error);
  if (error && stop.stop_requested()) throw Cancelled{};
  if (error == websocket::error::upgrade_declined)
    throw badInput(name, "the server refuses this WebSocket", "Start foxglove_bridge, and give its port");
  if (error)
    throw badInput(name, "the server does not answer as a WebSocket: " + error.message(),
                   "Start foxglove_bridge, and give its port");
  stream->web.next_layer().socket.setPatience(Socket::kForever);
  return WebSocket(std::move(stream));
}

WebSocket WebSocket::accept(Socket client, const std::string& subprotocol) {
  auto stream = std::make_unique<Stream>(std::move(client));
  stream->web.next_layer().socket.setPatience(Socket::kPatience);
  http::request<http::string_body> request;
  error_code error;
  http::read(stream->web.next_layer(), stream->buffer, request, error);
  stream->buffer.clear();
  const bool offered =
      request[http::field::sec_websocket_protocol].find(subprotocol) != beast::string_view::npos;
  if (!error && offered) {
    stream->web.set_option(websocket::stream_base::decorator([&](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, subprotocol);
    }));
    stream->web.accept(request, error);
  }
  if (error || !offered) return WebSocket(nullptr);
  stream->web.next_layer().socket.setPatience(Socket::kForever);
  return WebSocket(std::move(stream));
}

bool WebSocket::isOpen() const {
  return stream_ != nullptr && stream_->web.is_open();
}

void WebSocket::setPatience(std::chrono::milliseconds patience) {
  stream_->web.next_layer().socket.setPatience(patience);
}

bool WebSocket::hasMore() const {
  return stream_->web.next_layer().socket.hasMore();
}

bool WebSocket::read(std::string& message, Content& content) {
  error_code error;
  stream_->buffer.clear();
  stream_->web.read(stream_->buffer, error);
  if (error && error != websocket::error::closed && error != asio::error::eof) stream_->why = error.message();
  if (error) return false;
  content = stream_->web.got_text() ? Content::Text : Content::Binary;
  message.assign(static_cast<const char*>(stream_->buffer.data().data()), stream_->buffer.size());
  return true;
}

bool WebSocket::write(Content content, std::string_view message) {
  error_code error;
  stream_->web.binary(content == Content::Binary);
  stream_->web.write(asio::buffer(message.data(), message.size()), error);
  return !error;
}

const std::string& WebSocket::why() const {
  return stream_->why;
}

}  // namespace evical
