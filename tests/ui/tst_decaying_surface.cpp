// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/detection/surface_frame.h"

#include "core/base/time.h"
#include "tests/support/test_program.h"
#include "ui/detection/event_cache.h"

#include <QTemporaryDir>

#include <algorithm>
#include <cstdlib>
#include <random>

using namespace evical;
using namespace evical::ui;

namespace {

constexpr Resolution kSize_px{24, 16};
constexpr std::int64_t kStart_ns = 1'600'000'000'000'000'000;
constexpr int kCount = 60'000;  // several blocks of the cache
constexpr double kDuration_s = 2.0;

std::vector<Event> someEvents() {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> x(0, kSize_px.width_px - 1), y(0, kSize_px.height_px - 1);
  std::vector<Event> events;
  for (int k = 0; k < kCount; ++k) {
    events.push_back({kStart_ns + nanosecondsFrom(kDuration_s * k / kCount),
                      static_cast<std::uint16_t>(x(random)), static_cast<std::uint16_t>(y(random)),
                      random() % 2 == 0});
  }
  return events;
}

// Rounding to whole microseconds depends on the time of reference.
bool nearlySame(const SurfaceFrame& a, const SurfaceFrame& b) {
  if (a.image.size() != b.image.size() || a.events != b.events) return false;
  for (int y = 0; y < a.image.height(); ++y) {
    for (int x = 0; x < a.image.width(); ++x) {
      const QColor p = a.image.pixelColor(x, y), q = b.image.pixelColor(x, y);
      if (std::abs(p.red() - q.red()) + std::abs(p.green() - q.green()) + std::abs(p.blue() - q.blue()) > 6)
        return false;
      const auto hit = a.newestAt(x, y), other = b.newestAt(x, y);
      if (hit.has_value() != other.has_value()) return false;
      if (hit && (hit->brighter != other->brighter || std::abs(hit->time_s - other->time_s) > 2e-6))
        return false;
    }
  }
  return true;
}

}  // namespace

class TestDecayingSurface : public QObject {
  Q_OBJECT

  QTemporaryDir folder_;
  std::vector<Event> events_ = someEvents();
  std::shared_ptr<EventCache> cache_ = std::make_shared<EventCache>(folder_.path().toStdString());

  SurfaceFrame fromNothing(double time_s, const SurfaceStyle& style) const {
    std::vector<Event> events;
    const std::int64_t time_ns = kStart_ns + nanosecondsFrom(time_s);
    cache_->gather(time_ns - nanosecondsFrom(fadedAfter_s(style)), time_ns, events);
    return renderEvents(events, time_ns, kSize_px, style);
  }

 private slots:
  void initTestCase() {
    cache_->append(events_);
    cache_->finish();
  }

  void everyWay_drawsWhatDrawingFromNothingDoes() {
    DecayingSurface surface;
    SurfaceStyle style;
    style.decay_s = 0.004;
    std::vector<double> times_s = {1.0, 1.004, 1.005, 1.03, 1.2, 0.6, 0.61, 0.61, 1.99, 2.5, 0.0, 0.001};
    for (int k = 0; k < 40; ++k) times_s.push_back(0.3 + 0.007 * k);
    for (const double time_s : times_s) {
      const SurfaceFrame frame = surface.render(cache_, kStart_ns + nanosecondsFrom(time_s), kSize_px, style);
      QVERIFY2(nearlySame(frame, fromNothing(time_s, style)), qPrintable(QString::number(time_s)));
    }
    for (const double decay_s : {0.02, 0.002}) {
      style.decay_s = decay_s;
      const SurfaceFrame frame = surface.render(cache_, kStart_ns + nanosecondsFrom(1.0), kSize_px, style);
      QVERIFY(nearlySame(frame, fromNothing(1.0, style)));
    }
  }

  void whatTheReaderAddsLater_isDrawn() {
    auto cache = std::make_shared<EventCache>(folder_.path().toStdString());
    const std::size_t half = events_.size() / 2;
    cache->append({events_.data(), half});
    DecayingSurface surface;
    SurfaceStyle style;
    const std::int64_t time_ns = events_[half].time_ns + 1'000'000;
    surface.render(cache, time_ns, kSize_px, style);
    cache->append({events_.data() + half, events_.size() - half});
    cache->finish();
    const double time_s = secondsSince(kStart_ns, time_ns);
    QVERIFY(nearlySame(surface.render(cache, time_ns, kSize_px, style), fromNothing(time_s, style)));
  }

  void count_isOfWhatIsGathered() {
    for (const auto& [begin_s, end_s] :
         {std::pair(0.0, 2.0), std::pair(-1.0, 0.7), std::pair(0.7, 0.7), std::pair(0.3, 0.3001),
          std::pair(0.51, 1.73), std::pair(1.0, 9.0), std::pair(3.0, 4.0), std::pair(1.0, 0.5)}) {
      const std::int64_t begin_ns = kStart_ns + nanosecondsFrom(begin_s),
                         end_ns = kStart_ns + nanosecondsFrom(end_s);
      std::vector<Event> events;
      cache_->gather(begin_ns, end_ns, events);
      const auto within = std::count_if(events_.begin(), events_.end(), [&](const Event& event) {
        return event.time_ns >= begin_ns && event.time_ns < end_ns;
      });
      QCOMPARE(static_cast<std::ptrdiff_t>(events.size()), within);
      QCOMPARE(static_cast<std::ptrdiff_t>(cache_->count(begin_ns, end_ns)), within);
    }
  }
};

EVICAL_TEST(TestDecayingSurface)
#include "tst_decaying_surface.moc"
