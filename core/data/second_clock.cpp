#include "core/data/second_clock.h"

#include "core/base/number.h"
#include "core/base/time.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr double kJump_periods = 5.0;      // longer than a gap of a few lost samples
constexpr double kTolerance = 0.05;        // relative to the duration of as many samples
constexpr double kSlack_periods = 2.0;     // in addition
constexpr std::size_t kFewestSamples = 3;  // before a stretch, and in it

double periodOf(std::span<const ImuSample> samples) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < samples.size(); ++i)
    steps_s.push_back(secondsSince(samples[i - 1].time_ns, samples[i].time_ns));
  return steps_s.empty() ? 0.0 : medianOf(std::move(steps_s));
}

}  // namespace

std::vector<SecondClock> findSecondClocks(std::span<const ImuSample> samples) {
  std::vector<SecondClock> found;
  const double period_s = periodOf(samples);
  if (!(period_s > 0.0)) return found;
  std::size_t jump = 0;  // the latest sample after a forward jump of time; 0: none
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double step_s = secondsSince(samples[i - 1].time_ns, samples[i].time_ns);
    if (step_s > kJump_periods * period_s) jump = i;
    if (step_s >= -kJump_periods * period_s || jump == 0) continue;
    const std::size_t count = i - jump;
    const double expected_s = period_s * static_cast<double>(count + 1);
    const double around_s = secondsSince(samples[jump - 1].time_ns, samples[i].time_ns);
    const bool goes_on =
        std::abs(around_s - expected_s) <= kTolerance * expected_s + kSlack_periods * period_s;
    if (goes_on && count >= kFewestSamples && jump >= kFewestSamples)
      found.push_back({jump, i, periodOf(samples.subspan(jump, count)) / period_s});
    jump = 0;
  }
  return found;
}

RecordingFault faultOf(const std::string& stream, std::int64_t first_ns, std::span<const ImuSample> samples,
                       const SecondClock& clock) {
  const double at_s = secondsSince(first_ns, samples[clock.begin - 1].time_ns);
  return {stream, FaultKind::SecondClock, at_s,
          fmt::format("{} from {:.3f} s on {} stamped by a second clock, which runs {:.2f} times as fast: "
                      "excluded from calibrations.",
                      counted(clock.end - clock.begin, "sample"), at_s,
                      clock.end - clock.begin == 1 ? "is" : "are", clock.rate)};
}

}  // namespace evical
