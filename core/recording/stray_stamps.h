// Filter of stray time stamps. A stamp counts only if the following ones confirm it: a single event in the
// future, or a first one stamped 0, must not move a recording's begin or make all others late.
#pragma once

#include "core/base/time.h"
#include "core/data/event.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace evical {

// Largest difference of an unconfirmed stamp from earlier ones, and the number of agreeing stamps
// that confirm one.
struct StampTolerance {
  std::int64_t ahead_ns, behind_ns;
  std::size_t enough;
};
// Events hardly ever pause for longer; longer pauses are checked, at little cost. Packets of IMU samples may.
inline constexpr StampTolerance kEventStamps = {100'000'000, 1'000'000'000, 16};
inline constexpr StampTolerance kSampleStamps = {1'000'000'000, 1'000'000'000, 3};
// All points of a frame have the same stamp, so they do not confirm each other: more of them are needed.
inline constexpr StampTolerance kPointStamps = {1'000'000'000, 1'000'000'000, 1000};

// Items of one sensor in the order of recording. Items after a jump wait until enough following ones agree
// with them, or until one agrees with the items before the jump: then they were strays. The first items wait
// for a moment: drivers stamp them 0, or by a clock that is not set yet. Item has a member time_ns.
template <class Item>
class StampFilter {
 public:
  explicit StampFilter(StampTolerance tolerance) : tolerance_(tolerance) {}

  // Keeps in `items` those that are confirmed so far.
  void filter(std::vector<Item>& items);
  // Call at the end. If there are few items in total, all are kept.
  void finish(std::vector<Item>& items);

  std::uint64_t strays() const { return strays_; }
  // The first stray's stamp, and the one from which it differs.
  std::int64_t strayTime_ns() const { return stray_time_ns_; }
  std::int64_t strayFrom_ns() const { return stray_from_ns_; }

 private:
  static constexpr std::size_t kMaxWaiting = 100'000;
  static constexpr std::int64_t kEnough_ns = 50'000'000;  // packets with a wrong stamp are shorter

  bool near(const Item& item, std::int64_t time_ns) const {
    return item.time_ns <= time_ns + tolerance_.ahead_ns && item.time_ns >= time_ns - tolerance_.behind_ns;
  }
  void take(const Item& item, std::vector<Item>& kept);
  void wait(const Item& item, std::vector<Item>& kept);
  void dropWaiting(std::int64_t from_ns) { drop(waiting_, from_ns); }
  void drop(std::vector<Item>& items, std::int64_t from_ns);

  StampTolerance tolerance_;
  bool started_ = false, proven_ = false;
  std::int64_t latest_ns_ = 0;
  std::vector<Item> waiting_, held_;  // held_: the first ones, until confirmed
  std::uint64_t strays_ = 0;
  std::int64_t stray_time_ns_ = 0, stray_from_ns_ = 0;
};

template <class Item>
void StampFilter<Item>::filter(std::vector<Item>& items) {
  std::size_t good = 0;
  if (proven_ && waiting_.empty()) {
    for (; good < items.size() && near(items[good], latest_ns_); ++good) {
      if (items[good].time_ns > latest_ns_) latest_ns_ = items[good].time_ns;
    }
    if (good == items.size()) return;  // as nearly always
  }
  std::vector<Item> kept(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(good));
  for (; good < items.size(); ++good) {
    if (started_ && near(items[good], latest_ns_)) {
      dropWaiting(latest_ns_);
      take(items[good], kept);
    } else {
      wait(items[good], kept);
    }
  }
  items.swap(kept);
}

template <class Item>
void StampFilter<Item>::finish(std::vector<Item>& items) {
  items.clear();
  items.swap(started_ ? held_ : waiting_);
  dropWaiting(latest_ns_);
}

template <class Item>
void StampFilter<Item>::take(const Item& item, std::vector<Item>& kept) {
  if (item.time_ns > latest_ns_) latest_ns_ = item.time_ns;
  if (proven_) {
    kept.push_back(item);
    return;
  }
  held_.push_back(item);
  proven_ = latest_ns_ - held_.front().time_ns >= kEnough_ns || held_.size() >= kMaxWaiting;
  if (!proven_) return;
  kept.insert(kept.end(), held_.begin(), held_.end());
  held_.clear();
}

template <class Item>
void StampFilter<Item>::wait(const Item& item, std::vector<Item>& kept) {
  if (!waiting_.empty() && !near(item, waiting_.back().time_ns)) dropWaiting(item.time_ns);
  waiting_.push_back(item);
  const std::int64_t length_ns = waiting_.back().time_ns - waiting_.front().time_ns;
  const bool borne_out =
      waiting_.size() >= tolerance_.enough &&
      (!started_ || length_ns >= kEnough_ns || length_ns <= -kEnough_ns || waiting_.size() >= kMaxWaiting);
  if (!borne_out) return;
  drop(held_, waiting_.front().time_ns);
  started_ = true;
  latest_ns_ = waiting_.back().time_ns;
  for (const Item& each : waiting_) take(each, kept);
  waiting_.clear();
}

template <class Item>
void StampFilter<Item>::drop(std::vector<Item>& items, std::int64_t from_ns) {
  if (items.empty()) return;
  if (strays_ == 0) {
    stray_time_ns_ = items.front().time_ns;
    stray_from_ns_ = from_ns;
  }
  strays_ += items.size();
  items.clear();
}

// Step of the time stamps of events. Some drivers and files round them to ms, and give thousands of events
// the same stamp.
class StampStep {
 public:
  // Call in order of time. Only the first events are checked.
  void add(EventSpan events) {
    constexpr std::uint64_t kMax = 500'000;
    for (const Event& event : events) {
      if (seen_ >= kMax || step_ns_ <= kFine_ns) return;
      const std::int64_t step_ns = event.time_ns - last_ns_;
      if (seen_++ > 0 && step_ns > 0) {
        ++steps_;
        if (step_ns < step_ns_) step_ns_ = step_ns;
      }
      last_ns_ = event.time_ns;
    }
  }

  // 0 if stamps have the sensor's resolution.
  double step_s() const {
    constexpr std::uint64_t kFewestSteps = 20, kFewestAlike = 3;
    const bool coarse = step_ns_ > kFine_ns && steps_ >= kFewestSteps && seen_ >= kFewestAlike * steps_;
    return coarse ? 1e-9 * static_cast<double>(step_ns_) : 0.0;
  }

 private:
  static constexpr std::int64_t kFine_ns = 100'000;  // a tenth of a good recording's time offset sigma

  std::uint64_t seen_ = 0, steps_ = 0;
  std::int64_t last_ns_ = 0, step_ns_ = std::numeric_limits<std::int64_t>::max();
};

}  // namespace evical
