#include "core/synthetic/event_simulator.h"

#include "core/base/time.h"
#include "core/synthetic/pixel_array.h"
#include "core/synthetic/random.h"
#include "core/synthetic/scenario_boards.h"
#include "core/synthetic/sinusoid_motion.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace evical {
namespace {

constexpr double kPacket_s = 0.01;

bool earlier(const Event& a, const Event& b) {
  if (a.time_ns != b.time_ns) return a.time_ns < b.time_ns;
  if (a.y_px != b.y_px) return a.y_px < b.y_px;
  return a.x_px != b.x_px ? a.x_px < b.x_px : a.brighter < b.brighter;
}

// Runs work(worker, item) for every item, in any order.
void forEachItem(int items, int threads, const std::function<void(int, int)>& work) {
  std::atomic<int> next = 0;
  std::exception_ptr failure;
  std::mutex mutex;
  const auto run = [&](int worker) {
    try {
      for (int item = next++; item < items; item = next++) work(worker, item);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (int worker = 1; worker < threads; ++worker) others.emplace_back(run, worker);
    run(0);
  }
  if (failure) std::rethrow_exception(failure);
}

// Background activity and hot pixels: events without changes of light.
void addNoise(const Scenario& scenario, std::size_t index, std::uint64_t packet, double begin_s, double end_s,
              std::vector<Event>& events) {
  constexpr std::uint64_t kNoiseStream = 0xa0u, kHotStream = 0xb0u;
  const SimulatedCamera& camera = scenario.cameras[index];
  const Resolution& size = camera.intrinsics.resolution_px;
  Random random(scenario.seed, kNoiseStream + index, packet);
  const auto train = [&](double rate_hz, const std::function<std::pair<int, int>()>& place) {
    if (rate_hz <= 0.0) return;
    for (double t = begin_s + random.exponential(1.0 / rate_hz); t < end_s;
         t += random.exponential(1.0 / rate_hz)) {
      const auto [x, y] = place();
      events.push_back({pixelStamp_ns(scenario, index, t), static_cast<std::uint16_t>(x),
                        static_cast<std::uint16_t>(y), random.uniform() < 0.5});
    }
  };
  train(camera.pixel.background_rate_hz * size.pixelCount(), [&] {
    const int x = static_cast<int>(random.uniform() * size.width_px);
    return std::pair{x, static_cast<int>(random.uniform() * size.height_px)};
  });
  Random places(scenario.seed, kHotStream + index);
  for (int k = 0; k < camera.pixel.hot_pixels; ++k) {
    const int x = static_cast<int>(places.uniform() * size.width_px);
    const int y = static_cast<int>(places.uniform() * size.height_px);
    train(camera.pixel.hot_pixel_rate_hz, [&] { return std::pair{x, y}; });
  }
}

// Merges the workers' events in time order; events that jitter has moved beyond the packet's end
// are kept for the next one.
class PacketSorter {
 public:
  explicit PacketSorter(const Scenario& scenario, std::size_t camera)
      : scenario_(scenario), camera_(camera), readout_(scenario.cameras[camera].pixel) {}

  // All events of the packet; no later packet has earlier ones.
  EventSpan sorted(const std::vector<std::vector<Event>>& found, std::uint64_t packet, double end_s) {
    events_.swap(waiting_);
    const std::size_t old = events_.size();
    for (const std::vector<Event>& part : found) events_.insert(events_.end(), part.begin(), part.end());
    std::sort(events_.begin() + static_cast<std::ptrdiff_t>(old), events_.end(), earlier);
    jitter(old, packet);
    if (scenario_.cameras[camera_].pixel.stamp_jitter_s > 0.0)
      std::sort(events_.begin(), events_.end(), earlier);
    const std::int64_t end_ns = pixelStamp_ns(scenario_, camera_, end_s);
    const auto rest = std::lower_bound(events_.begin(), events_.end(), end_ns,
                                       [](const Event& event, std::int64_t t) { return event.time_ns < t; });
    waiting_.assign(rest, events_.end());
    events_.erase(rest, events_.end());
    readout_.pass(events_);
    return events_;
  }
  EventSpan rest() {
    readout_.pass(waiting_);
    return waiting_;
  }

 private:
  // Delayed by the absolute value of a normal variable.
  void jitter(std::size_t first, std::uint64_t packet) {
    constexpr std::uint64_t kJitterStream = 0xd0u;
    const double sigma_s = scenario_.cameras[camera_].pixel.stamp_jitter_s;
    if (sigma_s <= 0.0) return;
    Random random(scenario_.seed, kJitterStream + camera_, packet);
    for (std::size_t i = first; i < events_.size(); ++i)
      events_[i].time_ns += 1000 * std::llround(std::abs(random.normal()) * sigma_s * 1e6);
  }

  const Scenario& scenario_;
  std::size_t camera_;
  EventReadout readout_;
  std::vector<Event> events_, waiting_;
};

}  // namespace

void simulateEvents(const Scenario& scenario, std::size_t camera, const EventSink& sink,
                    const RunContext& context, int threads) {
  const SinusoidMotion motion(scenario);
  const Scenario scene = sceneOf(scenario, camera);
  PixelArray pixels(scene, camera);
  const auto poseAt = [&](double t) { return motion.boardFromCamera(camera, t); };
  const int workers = std::max(threads, 1);
  pixels.reset(poseAt(0.0));
  PacketSorter sorter(scenario, camera);
  std::vector<std::vector<Event>> found(static_cast<std::size_t>(workers));
  std::vector<PixelArray::Scratch> scratch(static_cast<std::size_t>(workers));
  const int packets = std::max(1, static_cast<int>(std::ceil(scenario.duration_s / kPacket_s - 1e-9)));
  for (int k = 0; k < packets; ++k) {
    context.throwIfStopped();
    const double begin_s = k * kPacket_s, end_s = std::min((k + 1) * kPacket_s, scenario.duration_s);
    const auto packet = static_cast<std::uint64_t>(k);
    for (std::vector<Event>& events : found) events.clear();
    pixels.begin(begin_s, end_s, poseAt);
    forEachItem(pixels.tileRows(), workers, [&](int worker, int row) {
      const auto w = static_cast<std::size_t>(worker);
      pixels.runTileRow(row, scratch[w], found[w]);
    });
    addNoise(scenario, camera, packet, begin_s, end_s, found.front());
    if (const EventSpan events = sorter.sorted(found, packet, end_s); !events.empty()) sink(events);
    context.progress.stageProgress(static_cast<double>(k + 1) / packets);
  }
  if (const EventSpan rest = sorter.rest(); !rest.empty()) sink(rest);
}

EventReadout::EventReadout(const EventPixelModel& pixel)
    : turn_ns_(pixel.readout_rate_hz > 0.0 ? 1e9 / pixel.readout_rate_hz : 0.0),
      longest_wait_ns_(1e9 * pixel.longest_wait_s) {}

void EventReadout::pass(std::vector<Event>& events) {
  if (turn_ns_ <= 0.0) return;
  if (origin_ns_ == 0 && !events.empty()) origin_ns_ = events.front().time_ns;
  std::erase_if(events, [&](Event& event) {
    const double time_ns = static_cast<double>(event.time_ns - origin_ns_);
    const double turn_ns = std::max(time_ns, free_at_ns_);
    if (turn_ns - time_ns > longest_wait_ns_) return true;
    free_at_ns_ = turn_ns + turn_ns_;
    event.time_ns = origin_ns_ + 1000 * std::llround(1e-3 * turn_ns);
    return false;
  });
}

}  // namespace evical
