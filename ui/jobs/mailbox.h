// SPDX-License-Identifier: GPL-3.0-or-later
// Passes the newest value of a worker to the GUI thread. Older values that were not taken are dropped, so
// that a slow window never builds up a queue.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>

namespace evical::ui {

template <class Value>
class Mailbox {
 public:
  // For receivers that poll.
  Mailbox() = default;
  // `tell` is called from the sending thread when there is a new value, once until it is taken; it must only
  // forward the message.
  explicit Mailbox(std::function<void()> tell) : tell_(std::move(tell)) {}

  void put(std::shared_ptr<const Value> value) {
    const std::lock_guard lock(mutex_);
    newest_ = std::move(value);
    if (!std::exchange(pending_, true) && tell_) tell_();
  }

  // The newest value, even if it was taken before; null if there was none.
  std::shared_ptr<const Value> take() {
    const std::lock_guard lock(mutex_);
    pending_ = false;
    return newest_;
  }
  // Null if the newest value was taken before.
  std::shared_ptr<const Value> takeNew() {
    const std::lock_guard lock(mutex_);
    return std::exchange(pending_, false) ? newest_ : nullptr;
  }

  void clear() {
    const std::lock_guard lock(mutex_);
    newest_ = nullptr;
    pending_ = false;
  }
  // Ends the notifications: the receiver is about to be destroyed.
  void close() {
    const std::lock_guard lock(mutex_);
    tell_ = nullptr;
  }

 private:
  std::mutex mutex_;
  std::function<void()> tell_;
  std::shared_ptr<const Value> newest_;
  bool pending_ = false;
};

}  // namespace evical::ui
