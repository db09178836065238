// SPDX-License-Identifier: GPL-3.0-or-later
// Work for a screen in a thread of its own, one piece at a time, whose outcome comes back in the GUI thread.
// What is asked for while it runs waits, and only the latest of that is done.
#pragma once

#include <QObject>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace evical::ui {

// What becomes of work that runs when newer work comes.
enum class OutdatedWork {
  Dropped,   // told to stop, and not delivered: it would show what nobody asks for any more
  Delivered  // goes on to its end: while wishes come faster than work is done, something is shown
};

class LatestJob : public QObject {
  Q_OBJECT

 public:
  // Runs in the thread, owns its inputs, and returns what is to be done in the GUI thread afterwards;
  // nothing, if there is nothing. May throw.
  using Work = std::function<std::function<void()>(const std::stop_token& stop)>;

  explicit LatestJob(OutdatedWork outdated, QObject* parent = nullptr);
  ~LatestJob() override;  // waits for what runs, after telling it to stop; nothing is delivered any more

  void start(Work work);
  void discard();  // what runs is told to stop; neither that nor what waits is delivered
  bool busy() const { return settled_ != newest_; }

  // For work under way, from its thread: is there something better to do?
  bool hasNewer() const;

 signals:
  void failed(const QString& reason);

 private:
  struct Piece {
    Work work;  // none: nothing waits
    int number = 0;
  };
  void run(const std::stop_token& end);
  void perform(const Piece& piece, const std::stop_token& stop);
  void deliver(int number, const std::function<void()>& done, const QString& error);

  // The GUI thread's: pieces are numbered as they come.
  OutdatedWork outdated_;
  int newest_ = 0;   // asked for
  int settled_ = 0;  // no piece up to this one is delivered any more

  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  Piece waiting_;
  std::stop_source stop_;  // of what runs
  std::jthread thread_;    // from the first piece on
};

}  // namespace evical::ui
