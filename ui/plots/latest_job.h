// SPDX-License-Identifier: GPL-3.0-or-later
// Prepares what a screen draws, in a thread of its own. A new job stops the one before it, whose outcome is
// dropped.
#pragma once

#include <QObject>

#include <functional>
#include <stop_token>
#include <thread>

namespace evical::ui {

class LatestJob : public QObject {
  Q_OBJECT

 public:
  // Runs in the thread and returns what is to be done in the GUI thread afterwards. May throw.
  using Work = std::function<std::function<void()>(const std::stop_token& stop)>;

  explicit LatestJob(QObject* parent = nullptr) : QObject(parent) {}
  ~LatestJob() override;  // waits for the thread, after telling it to stop

  void start(Work work);
  void cancel();

 signals:
  void failed(const QString& reason);

 private:
  void launch(Work work);
  void finish(const std::function<void()>& done, const QString& error);

  std::jthread thread_;
  Work next_;
  bool running_ = false;
};

}  // namespace evical::ui
