// Times between which the derivatives of poses on a trajectory are interpolated, for measurements within a short while.
#pragma once

#include "core/numerics/angles.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace evical {

// Chebyshev's times; none if control points are the better columns. Weights of control points have slopes up to 2/3, second
// derivatives up to 2 and third ones up to 3, in knots. With a half the length, 2/3 a, 2 a^2 / 4 and 3 a^3 / 24 remain after one,
// two and three times. The limits leave less than 1e-3, also where the errors of several control points add up.
struct PoseTimes {
  static constexpr std::size_t kMost = 3;
  std::size_t count = 0;
  std::array<double, kMost> times_s{};

  PoseTimes() = default;
  PoseTimes(double first_s, double last_s, double knot_spacing_s) {
    constexpr double kForOne_knots = 1.5e-3, kForTwo_knots = 0.065;
    const double length_s = last_s - first_s;
    if (length_s > longest_s(knot_spacing_s)) return;
    count = length_s > kForTwo_knots * knot_spacing_s ? 3 : length_s > kForOne_knots * knot_spacing_s ? 2 : 1;
    for (std::size_t k = 0; k < count; ++k)
      times_s[k] =
          0.5 * (first_s + last_s +
                 length_s * std::cos(kPi * (static_cast<double>(k) + 0.5) / static_cast<double>(count)));
  }
  static double longest_s(double knot_spacing_s) { return 0.33 * knot_spacing_s; }

  // Lagrange's polynomials.
  std::array<double, kMost> weightsAt(double time_s) const {
    std::array<double, kMost> weights{};
    for (std::size_t i = 0; i < count; ++i) {
      weights[i] = 1.0;
      for (std::size_t k = 0; k < count; ++k)
        if (k != i) weights[i] *= (time_s - times_s[k]) / (times_s[i] - times_s[k]);
    }
    return weights;
  }
};

}  // namespace evical
