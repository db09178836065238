// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "tests/support/processor_time.h"
#include "tests/ui/slowdown.h"

#include <QElapsedTimer>
#include <QFile>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace evical::ui::test {

// Ratio of the current time of plain computing to that on the reference machine of the limits (two cores of a
// server of 2020); at least 1.
inline double slowness() {
  constexpr double kUsual_ms = 18.0;
  std::vector<std::uint32_t> numbers(300'000);
  const double begin_s = evical::test::threadCpu_s();
  std::uint32_t state = 1;
  for (std::uint32_t& number : numbers) number = state = state * 1664525u + 1013904223u;
  std::sort(numbers.begin(), numbers.end());
  const double took_ms = 1e3 * (evical::test::threadCpu_s() - begin_s);
  return std::max<double>(kSlowdown, took_ms / kUsual_ms);
}

// Computing time of this process from here on. Unlike wall time, it does not depend on concurrent tests.
class ComputedTime {
 public:
  double elapsed_ms() const { return 1e3 * (evical::test::processCpu_s() - begin_s_); }

 private:
  double begin_s_ = evical::test::processCpu_s();
};

// A cancelled job ends after half a second at most. Computing time counts, so that tests can run in parallel;
// tst_main_window measures wall time.
inline double maxAfterCancel_ms() {
  return 500.0 * slowness();
}

// Number of processors kept busy by others since construction: with such load, rates in wall time mean
// little, and software rendering waits for its threads, which are not scheduled.
class OtherLoad {
 public:
  OtherLoad() : begin_(now()) { wall_.start(); }
  bool quiet() const { return processors() < 0.3; }
  double processors() const {
    const Seconds end = now();
    return ((end.everybody - begin_.everybody) - (end.own - begin_.own)) /
           (1e-3 * static_cast<double>(wall_.elapsed()));
  }

 private:
  struct Seconds {
    double everybody = 0.0, own = 0.0;
  };
  static Seconds now() {
    Seconds seconds;
    QFile file("/proc/stat");
    if (file.open(QIODevice::ReadOnly)) {
      const QByteArrayList fields =
          file.readLine().simplified().split(' ');  // cpu user nice system idle iowait ...
      const double per_second = static_cast<double>(sysconf(_SC_CLK_TCK));
      for (const int busy : {1, 2, 3, 6, 7, 8})
        seconds.everybody += fields.value(busy).toDouble() / per_second;
    }
    rusage own{};
    getrusage(RUSAGE_SELF, &own);
    const auto inSeconds = [](const timeval& time) {
      return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    seconds.own = inSeconds(own.ru_utime) + inSeconds(own.ru_stime);
    return seconds;
  }
  Seconds begin_;
  QElapsedTimer wall_;
};

}  // namespace evical::ui::test
