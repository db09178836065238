// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/plots/latest_job.h"

#include "core/base/error.h"

#include <exception>
#include <utility>

namespace evical::ui {

LatestJob::~LatestJob() {
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void LatestJob::start(Work work) {
  if (!running_) return launch(std::move(work));
  thread_.request_stop();
  next_ = std::move(work);
}

void LatestJob::cancel() {
  thread_.request_stop();
  next_ = nullptr;
}

void LatestJob::launch(Work work) {
  running_ = true;
  thread_ = std::jthread([this, work = std::move(work)](const std::stop_token& stop) {
    std::function<void()> done;
    QString error;
    try {
      done = work(stop);
    } catch (const Cancelled&) {
    } catch (const std::exception& exception) {
      error = QString::fromStdString(exception.what());
    }
    QMetaObject::invokeMethod(
        this, [this, done, error] { finish(done, error); }, Qt::QueuedConnection);
  });
}

void LatestJob::finish(const std::function<void()>& done, const QString& error) {
  const bool wanted = !thread_.get_stop_token().stop_requested();
  running_ = false;
  if (next_) return launch(std::exchange(next_, nullptr));
  if (!wanted) return;
  if (!error.isEmpty()) emit failed(error);
  if (done) done();
}

}  // namespace evical::ui
