// SPDX-License-Identifier: GPL-3.0-or-later
// Stalls of the event loop: the gap between two beats of a fast timer in the GUI thread. Time in which the
// thread was ready to run but other programs had the processor is not counted; waiting for locks and files
// is.
#pragma once

#include "tests/support/processor_time.h"

#include <QElapsedTimer>
#include <QFile>
#include <QObject>
#include <QTimer>

#include <algorithm>

namespace evical::ui::test {

class StallMeter : public QObject {
 public:
  StallMeter() {
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, &StallMeter::beat);
    wall_.start();
    last_ = now();
    timer_.start(1);
  }

  double longest_ms() const { return longest_ms_; }
  // Longest computing time of the thread within one gap, not necessarily the longest gap.
  double longestWork_ms() const { return longest_work_ms_; }
  int beats() const { return beats_; }

  // Resets the meter; returns its value.
  double restart_ms() {
    beat();
    const double longest_ms = longest_ms_;
    longest_ms_ = longest_work_ms_ = 0.0;
    beats_ = 0;
    return longest_ms;
  }

 private:
  struct Clocks {
    double wall_ms = 0.0, work_ms = 0.0, queued_ms = 0.0;
  };

  Clocks now() const {
    Clocks clocks;
    clocks.wall_ms = 1e-6 * static_cast<double>(wall_.nsecsElapsed());
    clocks.work_ms = 1e3 * evical::test::threadCpu_s();
    QFile file("/proc/thread-self/schedstat");  // ns on a processor, ns ready for one, times
    if (file.open(QIODevice::ReadOnly))
      clocks.queued_ms = 1e-6 * file.readAll().split(' ').value(1).toDouble();
    return clocks;
  }

  void beat() {
    const Clocks clocks = now();
    const double gap_ms = (clocks.wall_ms - last_.wall_ms) - (clocks.queued_ms - last_.queued_ms);
    longest_ms_ = std::max(longest_ms_, gap_ms);
    longest_work_ms_ = std::max(longest_work_ms_, clocks.work_ms - last_.work_ms);
    last_ = clocks;
    ++beats_;
  }

  QTimer timer_;
  QElapsedTimer wall_;
  Clocks last_;
  double longest_ms_ = 0.0, longest_work_ms_ = 0.0;
  int beats_ = 0;
};

}  // namespace evical::ui::test
