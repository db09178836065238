// A server of a test: what it sends, and to whom, is up to the test.
#pragma once

#include "core/recording/live/socket.h"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace evical::test {

// Serves one client after the other, then closes.
class OneServer {
 public:
  using Serve = std::function<void(Socket client, const std::stop_token& stop)>;

  // Sends bytes to each; nothing, and stays open, if they are empty.
  explicit OneServer(const std::vector<std::string>& sent) : OneServer(sending(sent)) {}
  explicit OneServer(std::vector<Serve> serves)
      : listener_({"tcp", "127.0.0.1", "0", ""}, stop_.get_token()) {
    thread_ = std::jthread([this, serves = std::move(serves)](const std::stop_token& stop) {
      for (const Serve& serve : serves) {
        std::optional<Socket> client;
        while (!client && !stop.stop_requested()) {
          client = listener_.accept();
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        if (!client) return;
        serve(std::move(*client), stop);
      }
      listener_ = Listener();
    });
  }
  ~OneServer() {
    thread_.request_stop();
    stop_.request_stop();
  }
  OneServer(const OneServer&) = delete;
  OneServer& operator=(const OneServer&) = delete;
  std::string address(const std::string& scheme = "tcp") const { return scheme + address_; }

 private:
  static std::vector<Serve> sending(const std::vector<std::string>& sent) {
    std::vector<Serve> serves;
    for (const std::string& bytes : sent)
      serves.emplace_back([bytes](Socket client, const std::stop_token& stop) {
        static_cast<void>(client.writeAll(bytes));
        if (bytes.empty())
          while (!stop.stop_requested()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      });
    return serves;
  }

  std::stop_source stop_;
  Listener listener_;
  std::string address_ = fmt::format("://127.0.0.1:{}", listener_.port());
  std::jthread thread_;
};

}  // namespace evical::test
