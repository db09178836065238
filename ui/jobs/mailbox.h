// SPDX-License-Identifier: GPL-3.0-or-later
// Hands the newest value of a worker to the GUI thread. Older ones that nobody took are dropped, so that a
// slow window never has a queue in front of it.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>

namespace evical::ui {

template <class Value>
class Mailbox {
 public:
  // For receivers that look into it by themselves.
  Mailbox() = default;
  // `tell` is called when there is something new, once until that is taken, from whatever thread put it
  // there; it does no more than hand on the message.
  explicit Mailbox(std::function<void()> tell) : tell_(std::move(tell)) {}

  void put(std::shared_ptr<const Value> value) {
    const std::lock_guard lock(mutex_);
    newest_ = std::move(value);
    if (!std::exchange(pending_, true) && tell_) tell_();
  }

  // The newest, also if it was taken before; null if there was none.
  std::shared_ptr<const Value> take() {
    const std::lock_guard lock(mutex_);
    pending_ = false;
    return newest_;
  }
  // Null where the newest was taken before.
  std::shared_ptr<const Value> takeNew() {
    const std::lock_guard lock(mutex_);
    return std::exchange(pending_, false) ? newest_ : nullptr;
  }

  void clear() {
    const std::lock_guard lock(mutex_);
    newest_ = nullptr;
    pending_ = false;
  }
  // The receiver goes: nobody is told any more, whoever may still put something.
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
