#include "core/synthetic/hand_motion.h"

#include "core/numerics/angles.h"
#include "core/synthetic/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace evical {
namespace {

constexpr double kStopRamp_s = 0.25;  // from full speed to rest

// Smooth step from 0 to 1 over u = 0 to 1, its derivative, and its integral from 0; flat to the second order
// at both ends.
double smoothFraction(double u) {
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}
double smoothStepSlope(double u) {
  return 30.0 * u * u * (1.0 - u) * (1.0 - u);
}
double smoothStepIntegral(double u) {
  return u * u * u * u * (2.5 + u * (u - 3.0));
}

}  // namespace

MotionValue& MotionValue::operator+=(const MotionValue& other) {
  value += other.value;
  first += other.first;
  second += other.second;
  return *this;
}

MotionValue MotionSinusoid::at(double time_s) const {
  const double angle = angular_frequency * time_s + phase;
  const double sine = amplitude * std::sin(angle), cosine = amplitude * std::cos(angle);
  return {sine, angular_frequency * cosine, -angular_frequency * angular_frequency * sine};
}

MotionValue Jerk::at(double time_s) const {
  constexpr double kWidth_s = 0.04;
  const double u = (time_s - middle_s) / kWidth_s;
  const double value = size * std::exp(-0.5 * u * u);
  return {value, -u / kWidth_s * value, (u * u - 1.0) / (kWidth_s * kWidth_s) * value};
}

// Each period ends with a ramp down, a stop, and a ramp up.
MotionValue motionTime(const HandModel& hand, double time_s) {
  if (hand.stop_every_s <= 0.0) return {time_s, 1.0, 0.0};
  const double period_s = hand.stop_every_s, moving_s = period_s - hand.stop_s - 2.0 * kStopRamp_s;
  const double period = std::floor(time_s / period_s), since_s = time_s - period * period_s;
  const double before_s = period * (moving_s + kStopRamp_s);  // two ramps of half the speed on average
  const double down = std::clamp((since_s - moving_s) / kStopRamp_s, 0.0, 1.0);
  const double up = std::clamp((since_s - (period_s - kStopRamp_s)) / kStopRamp_s, 0.0, 1.0);
  return {before_s + std::min(since_s, moving_s) +
              kStopRamp_s * (down - smoothStepIntegral(down) + smoothStepIntegral(up)),
          1.0 - smoothFraction(down) + smoothFraction(up),
          (smoothStepSlope(up) - smoothStepSlope(down)) / kStopRamp_s};
}

MotionValue throughTime(const MotionValue& value, const MotionValue& time) {
  return {value.value, value.first * time.first,
          value.second * time.first * time.first + value.first * time.second};
}

std::vector<MotionSinusoid> tremor(double sigma, std::uint64_t seed, std::size_t quantity) {
  if (sigma <= 0.0) return {};
  constexpr std::uint64_t kStream = 0x210;
  constexpr int kSinusoids = 3;
  constexpr double kLowest_hz = 8.0, kHighest_hz = 12.0;
  Random random(seed, kStream, quantity);
  std::vector<MotionSinusoid> all;
  for (int k = 0; k < kSinusoids; ++k) {
    const double frequency_hz = kLowest_hz + (kHighest_hz - kLowest_hz) * (k + random.uniform()) / kSinusoids;
    all.push_back({sigma * std::sqrt(2.0 / kSinusoids), kTwoPi * frequency_hz, kTwoPi * random.uniform()});
  }
  return all;
}

std::vector<Jerk> jerks(const HandModel& hand, double duration_s, std::uint64_t seed, std::size_t quantity) {
  std::vector<Jerk> all;
  if (hand.jerks_per_s <= 0.0) return all;
  constexpr std::uint64_t kMoments = 0x220, kSizes = 0x221;
  Random moments(seed, kMoments), sizes(seed, kSizes, quantity);  // all quantities at the same moments
  for (double t = moments.exponential(1.0 / hand.jerks_per_s); t < duration_s;
       t += moments.exponential(1.0 / hand.jerks_per_s))
    all.push_back({hand.jerk_rad * sizes.normal(), t});
  return all;
}

}  // namespace evical
