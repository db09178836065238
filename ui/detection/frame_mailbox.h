// SPDX-License-Identifier: GPL-3.0-or-later
// Hands the newest value of a worker to the GUI thread. Older ones that nobody took are dropped, so that a
// slow window never has a queue in front of it.
#pragma once

#include <memory>
#include <mutex>
#include <utility>

namespace evical::ui {

template <class Value>
class Mailbox {
 public:
  // True if the receiver must be told: it has taken all that was put before.
  bool put(std::shared_ptr<const Value> value) {
    const std::lock_guard lock(mutex_);
    newest_ = std::move(value);
    return !std::exchange(pending_, true);
  }

  // The newest, also if it was taken before; null if there was none.
  std::shared_ptr<const Value> take() {
    const std::lock_guard lock(mutex_);
    pending_ = false;
    return newest_;
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<const Value> newest_;
  bool pending_ = false;
};

struct SurfaceFrame;
using FrameMailbox = Mailbox<SurfaceFrame>;

}  // namespace evical::ui
