// Additions of hand-held motion to sinusoids (HandModel): tremor, bumps and steps of each quantity, and
// stops, which stretch time.
#pragma once

#include "core/synthetic/scenario.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evical {

// A quantity and its derivatives in time.
struct MotionValue {
  double value = 0.0, first = 0.0, second = 0.0;

  MotionValue& operator+=(const MotionValue& other);
};

struct MotionSinusoid {
  double amplitude, angular_frequency, phase;

  MotionValue at(double time_s) const;
};

// Time of the motion as a function of the clock's time: constant during stops. Twice differentiable.
MotionValue motionTime(const HandModel& hand, double time_s);
// Converts derivatives by the motion's time to derivatives by the clock's.
MotionValue throughTime(const MotionValue& value, const MotionValue& time);

// A quick movement there and back.
struct Jerk {
  double size, middle_s;

  MotionValue at(double time_s) const;
};

// Two or three of them, drawn from seed and quantity, at 8 to 12 Hz; none without tremor.
std::vector<MotionSinusoid> tremor(double sigma, std::uint64_t seed, std::size_t quantity);
std::vector<Jerk> jerks(const HandModel& hand, double duration_s, std::uint64_t seed, std::size_t quantity);

}  // namespace evical
