// SPDX-License-Identifier: GPL-3.0-or-later
// A thread that does what it was asked for last: requests that came while it was busy are dropped but for the
// newest. Ends with its owner, after the request under way.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

namespace evical::ui {

template <class Request>
class NewestRequestWorker {
 public:
  // `handle` runs in the thread and does not throw; `begin` does so first.
  explicit NewestRequestWorker(
      std::function<void(const Request&)> handle, void (*begin)() = [] {})
      : handle_(std::move(handle)), thread_([this, begin](const std::stop_token& stop) {
          begin();
          run(stop);
        }) {}

  void post(Request request) {
    {
      const std::lock_guard lock(mutex_);
      next_ = std::move(request);
    }
    changed_.notify_one();
  }

  // For `handle`: is there something better to do?
  bool hasNewer() {
    const std::lock_guard lock(mutex_);
    return next_.has_value();
  }

 private:
  void run(const std::stop_token& stop) {
    for (;;) {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return next_.has_value(); })) return;
      const Request request = std::move(*next_);
      next_.reset();
      lock.unlock();
      handle_(request);
      if (stop.stop_requested()) return;
    }
  }

  std::function<void(const Request&)> handle_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<Request> next_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace evical::ui
