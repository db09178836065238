#include "core/base/in_parallel.h"

#include "tests/support/test_program.h"

#include <atomic>
#include <latch>
#include <stdexcept>
#include <vector>

using namespace evical;

class TestInParallel : public QObject {
  Q_OBJECT

 private slots:
  void everyPart_isWorkedOnOnce() {
    for (const int threads : {0, 1, 2, 7}) {
      std::vector<std::atomic<int>> times(50);
      inParallel(threads, times.size(), [&](std::size_t part) { ++times[part]; });
      for (const std::atomic<int>& each : times) QCOMPARE(each.load(), 1);
    }
    inParallel(2, 0, [](std::size_t) { QFAIL("there is no part"); });
  }

  // Neither part could end if the other did not run at the same time.
  void twoThreads_workAtTheSameTime() {
    std::latch both(2);
    inParallel(2, 2, [&](std::size_t) { both.arrive_and_wait(); });
  }

  void firstException_isThrownAgain() {
    std::atomic<int> begun = 0;
    const auto fail = [&](std::size_t part) {
      ++begun;
      if (part == 3) throw std::runtime_error("3");
    };
    QVERIFY_THROWS_EXCEPTION(std::runtime_error, inParallel(1, 1000, fail));
    QCOMPARE(begun.load(), 4);
    QVERIFY_THROWS_EXCEPTION(std::runtime_error, inParallel(2, 1000, fail));
  }
};

EVICAL_TEST(TestInParallel)
#include "tst_in_parallel.moc"
