// SPDX-License-Identifier: GPL-3.0-or-later
// Work in a thread of the pool, one at a time, whose result comes back in the GUI thread. What is asked for
// while it runs waits, and only the latest of that is done. Work owns its inputs and does not throw.
#pragma once

#include <QFutureWatcher>
#include <QtConcurrent>

#include <functional>
#include <stop_token>
#include <utility>

namespace evical::ui {

template <class Result>
class LatestJob {
 public:
  using Work = std::function<Result(std::stop_token)>;

  explicit LatestJob(std::function<void(Result)> done) : done_(std::move(done)) {
    QObject::connect(&watcher_, &QFutureWatcher<Result>::finished, &watcher_, [this] { finish(); });
  }
  // Does not wait: work that is still going stops by itself and reaches nobody.
  ~LatestJob() { stop_.request_stop(); }
  LatestJob(const LatestJob&) = delete;
  LatestJob& operator=(const LatestJob&) = delete;

  void start(Work work) {
    waiting_ = std::move(work);
    if (!running_) startWaiting();
  }
  // What runs or waits will not be delivered.
  void discard() {
    waiting_ = nullptr;
    discarded_ = running_;
    stop_.request_stop();
  }
  bool busy() const { return running_ || waiting_; }

 private:
  void startWaiting() {
    running_ = static_cast<bool>(waiting_);
    if (!running_) return;
    discarded_ = false;
    stop_ = std::stop_source();
    watcher_.setFuture(QtConcurrent::run(std::exchange(waiting_, nullptr), stop_.get_token()));
  }
  void finish() {
    running_ = false;
    if (!discarded_) done_(watcher_.result());
    if (!running_) startWaiting();
  }

  std::function<void(Result)> done_;
  Work waiting_;
  bool running_ = false, discarded_ = false;
  std::stop_source stop_;
  QFutureWatcher<Result> watcher_;
};

}  // namespace evical::ui
