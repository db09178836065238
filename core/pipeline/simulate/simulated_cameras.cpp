#include "core/pipeline/simulate/simulated_cameras.h"

#include "core/pipeline/pass/bounded_queue.h"
#include "core/synthetic/event_simulator.h"

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace evical {
namespace {

constexpr std::size_t kQueuedPackets = 16;

struct Abandoned {};  // the receiver of the events has gone

class CameraThread {
 public:
  CameraThread(const Scenario& scenario, std::size_t camera, const RunContext& context, int threads)
      : queue_(kQueuedPackets), thread_([this, &scenario, camera, &context, threads] {
          try {
            simulateEvents(
                scenario, camera,
                [this](EventSpan events) {
                  if (!events.empty() && !queue_.push({events.begin(), events.end()})) throw Abandoned{};
                },
                context, threads);
          } catch (const Abandoned&) {
          } catch (...) {
            failure_ = std::current_exception();
          }
          queue_.close();
        }) {
    advance();
  }
  ~CameraThread() { queue_.close(); }
  CameraThread(const CameraThread&) = delete;
  CameraThread& operator=(const CameraThread&) = delete;

  EventSpan next() const { return next_ ? EventSpan(*next_) : EventSpan(); }
  std::int64_t time_ns() const {
    return next_ ? next_->front().time_ns : std::numeric_limits<std::int64_t>::max();
  }
  void advance() {
    next_ = queue_.pop();
    if (!next_ && failure_) std::rethrow_exception(failure_);
  }

 private:
  BoundedQueue<std::vector<Event>> queue_;
  std::optional<std::vector<Event>> next_;
  std::exception_ptr failure_;  // set before the queue closes
  std::jthread thread_;         // declared last: it uses the other members
};

}  // namespace

void simulateCameras(const Scenario& scenario,
                     const std::function<void(std::size_t camera, EventSpan events)>& sink,
                     const RunContext& context) {
  const int threads = scenario.cameras.size() == 1 ? 2 : 1;
  const RunContext quiet{silentProgress(), context.stop};
  std::vector<std::unique_ptr<CameraThread>> cameras;
  std::vector<std::size_t> indices;
  for (std::size_t k = 0; k < scenario.cameras.size(); ++k) {
    if (scenario.cameras[k].frames) continue;
    cameras.push_back(
        std::make_unique<CameraThread>(scenario, k, indices.empty() ? context : quiet, threads));
    indices.push_back(k);
  }
  while (!cameras.empty()) {
    const auto first = std::min_element(cameras.begin(), cameras.end(), [](const auto& a, const auto& b) {
      return a->time_ns() < b->time_ns();
    });
    const EventSpan events = (*first)->next();
    if (events.empty()) return;
    sink(indices[static_cast<std::size_t>(first - cameras.begin())], events);
    (*first)->advance();
  }
}

}  // namespace evical
