// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/jobs/latest_job.h"

#include "core/base/error.h"
#include "tests/support/test_program.h"
#include "ui/jobs/live_view.h"

#include <QSignalSpy>

#include <atomic>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>

using namespace evical;
using namespace evical::ui;

namespace {

using Done = std::function<void()>;

// Works until a stop is requested.
Done waitForStop(const std::stop_token& stop, std::atomic<int>& begun) {
  ++begun;
  while (!stop.stop_requested()) std::this_thread::yield();
  return nullptr;
}

}  // namespace

class TestLatestJob : public QObject {
  Q_OBJECT

 private slots:
  void latestJob_dropsWhatIsOutdated() {
    LatestJob job(OutdatedWork::Dropped);
    std::atomic<int> begun = 0;
    int done = 0;
    for (int k = 1; k <= 3; ++k) {
      job.start([&begun, &done, k](const std::stop_token& stop) {
        ++begun;
        while (k < 3 && !stop.stop_requested()) std::this_thread::yield();
        return [&done, k] { done += k; };
      });
      if (k == 1) QTRY_COMPARE(begun.load(), 1);
    }
    QTRY_COMPARE(done, 3);
    QVERIFY(!job.busy());
    QVERIFY(begun <= 3);
  }

  void latestJob_saysWhatWentWrong() {
    LatestJob job(OutdatedWork::Dropped);
    QSignalSpy failed(&job, &LatestJob::failed);
    job.start([](const std::stop_token&) -> Done { throw std::runtime_error("no such thing"); });
    QVERIFY(failed.wait());
    QCOMPARE(failed[0][0].toString(), QString("no such thing"));
    job.start([](const std::stop_token&) -> Done { throw Cancelled{}; });
    QTRY_VERIFY(!job.busy());
    QCOMPARE(failed.count(), 1);
  }

  void latestJob_doesTheNewestOfWhatWaits() {
    LatestJob job(OutdatedWork::Delivered);
    std::mutex gate;
    gate.lock();
    int done = 0, last = 0;
    std::atomic<int> worked = 0;
    for (int k = 1; k <= 50; ++k)
      job.start([&, k](const std::stop_token&) {
        const std::lock_guard wait(gate);
        ++worked;
        return [&, k] {
          last = k;
          ++done;
        };
      });
    gate.unlock();
    QTRY_COMPARE(last, 50);
    QVERIFY(done <= 2 && worked <= 2);
    QVERIFY(!job.busy());
  }

  void latestJob_deliversWhatRanWhenNewerWorkCame() {
    LatestJob job(OutdatedWork::Delivered);
    std::atomic<bool> begun = false, may_end = false, saw_newer = false;
    QList<int> done;
    job.start([&](const std::stop_token& stop) {
      begun = true;
      while (!may_end) std::this_thread::yield();
      saw_newer = job.hasNewer() && !stop.stop_requested();
      return [&] { done << 1; };
    });
    QTRY_VERIFY(begun);
    job.start([&](const std::stop_token&) { return [&] { done << 2; }; });
    may_end = true;
    QTRY_COMPARE(done, (QList<int>{1, 2}));
    QVERIFY(saw_newer);
  }

  void latestJob_deliversNothingOfWhatWasDiscarded() {
    LatestJob job(OutdatedWork::Delivered);
    std::atomic<int> begun = 0;
    bool delivered = false;
    job.start([&](const std::stop_token& stop) {
      waitForStop(stop, begun);
      return [&] { delivered = true; };
    });
    QTRY_COMPARE(begun.load(), 1);
    QVERIFY(job.busy());
    job.discard();
    QVERIFY(!job.busy());
    bool next = false;
    job.start([&](const std::stop_token&) { return [&] { next = true; }; });
    QTRY_VERIFY(next);
    QVERIFY(!delivered);
  }

  void latestJob_stopsWithItsOwner() {
    std::atomic<int> begun = 0;
    auto job = std::make_unique<LatestJob>(OutdatedWork::Delivered);
    job->start([&](const std::stop_token& stop) { return waitForStop(stop, begun); });
    QTRY_COMPARE(begun.load(), 1);
    job.reset();
    LatestJob never_started(OutdatedWork::Dropped);
  }

  void mailbox_keepsTheNewestAndTellsOnce() {
    int told = 0;
    Mailbox<int> box([&told] { ++told; });
    const auto first = std::make_shared<const int>(1), second = std::make_shared<const int>(2);
    QVERIFY(!box.take());
    box.put(first);
    QCOMPARE(told, 1);
    box.put(second);
    QCOMPARE(told, 1);
    QCOMPARE(box.take(), second);
    QCOMPARE(box.take(), second);
    box.put(first);
    QCOMPARE(told, 2);
  }

  void mailbox_handsOutWhatIsNewOnce() {
    Mailbox<int> box;
    QVERIFY(!box.takeNew());
    const auto value = std::make_shared<const int>(1);
    box.put(value);
    QCOMPARE(box.takeNew(), value);
    QVERIFY(!box.takeNew());
    box.put(value);
    box.clear();
    QVERIFY(!box.takeNew() && !box.take());
  }

  void mailbox_thatIsClosedTellsNobody() {
    int told = 0;
    Mailbox<int> box([&told] { ++told; });
    box.close();
    box.put(std::make_shared<const int>(1));
    QCOMPARE(told, 0);
  }
};

EVICAL_TEST(TestLatestJob)
#include "tst_latest_job.moc"
