// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/latest_job.h"

#include "core/base/error.h"

#include <exception>
#include <utility>

namespace evical::ui {

LatestJob::LatestJob(OutdatedWork outdated, QObject* parent) : QObject(parent), outdated_(outdated) {}

LatestJob::~LatestJob() {
  discard();
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void LatestJob::start(Work work) {
  if (outdated_ == OutdatedWork::Dropped) discard();
  {
    const std::lock_guard lock(mutex_);
    waiting_ = {std::move(work), ++newest_};
  }
  changed_.notify_one();
  if (!thread_.joinable()) thread_ = std::jthread([this](const std::stop_token& end) { run(end); });
}

void LatestJob::discard() {
  settled_ = newest_;
  const std::lock_guard lock(mutex_);
  waiting_ = {};
  stop_.request_stop();
}

bool LatestJob::hasNewer() const {
  const std::lock_guard lock(mutex_);
  return static_cast<bool>(waiting_.work);
}

void LatestJob::run(const std::stop_token& end) {
  for (;;) {
    Piece piece;
    std::stop_token stop;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, end, [this] { return static_cast<bool>(waiting_.work); })) return;
      if (end.stop_requested()) return;
      piece = std::exchange(waiting_, {});
      stop_ = std::stop_source();
      stop = stop_.get_token();
    }
    perform(piece, stop);
  }
}

void LatestJob::perform(const Piece& piece, const std::stop_token& stop) {
  std::function<void()> done;
  QString error;
  try {
    done = piece.work(stop);
  } catch (const Cancelled&) {
  } catch (const std::exception& exception) {
    error = QString::fromStdString(exception.what());
  }
  QMetaObject::invokeMethod(
      this, [this, number = piece.number, done, error] { deliver(number, done, error); },
      Qt::QueuedConnection);
}

void LatestJob::deliver(int number, const std::function<void()>& done, const QString& error) {
  if (number <= settled_) return;
  settled_ = number;
  if (!error.isEmpty()) emit failed(error);
  if (done) done();
}

}  // namespace evical::ui
