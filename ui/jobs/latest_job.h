// SPDX-License-Identifier: GPL-3.0-or-later
// Runs work for a screen in a separate thread, one piece at a time, and delivers its outcome in the GUI
// thread. Of the pieces that are requested meanwhile, only the latest is run.
#pragma once

#include <QObject>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace evical::ui {

// Treatment of running work when newer work is requested.
enum class OutdatedWork {
  Dropped,   // stopped and not delivered, since it is obsolete
  Delivered  // completed: something is shown even if requests come faster than results
};

class LatestJob : public QObject {
  Q_OBJECT

 public:
  // Runs in the thread, owns its inputs, and returns an action for the GUI thread; may be empty. May throw.
  using Work = std::function<std::function<void()>(const std::stop_token& stop)>;

  explicit LatestJob(OutdatedWork outdated, QObject* parent = nullptr);
  ~LatestJob() override;  // requests a stop and waits; delivers nothing more

  void start(Work work);
  void discard();  // stops running work; neither that nor waiting work is delivered
  bool busy() const { return settled_ != newest_; }

  // For running work, from its thread: whether newer work waits.
  bool hasNewer() const;

 signals:
  void failed(const QString& reason);

 private:
  struct Piece {
    Work work;  // none: no piece waits
    int number = 0;
  };
  void run(const std::stop_token& end);
  void perform(const Piece& piece, const std::stop_token& stop);
  void deliver(int number, const std::function<void()>& done, const QString& error);

  // Used by the GUI thread: pieces are numbered in order.
  OutdatedWork outdated_;
  int newest_ = 0;   // last requested piece
  int settled_ = 0;  // no piece up to this one will be delivered

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  Piece waiting_;
  std::stop_source stop_;  // of the running piece
  std::jthread thread_;    // started with the first piece
};

}  // namespace evical::ui
