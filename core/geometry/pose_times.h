// Times between which the derivatives of poses on a trajectory are interpolated, for measurements within a
// short while.
#pragma once

#include "core/numerics/angles.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace evical {

// Chebyshev's times; none if control points are the better columns. Weights of control points have slopes up
// to 2/3, second derivatives up to 2 and third ones up to 3, in knots. With a half the length, 2/3 a, 2 a^2 /
// 4 and 3 a^3 / 24 remain after one, two and three times. The limits leave less than 1e-3, also where the
// errors of several control points add up.
struct PoseTimes {
  static constexpr std::size_t kMax = 3;
  // Longest views with one, two and three times.
  static constexpr std::array<double, kMax> kLongest_knots = {6e-4, 0.045, 0.24};
  std::size_t count = 0;
  std::array<double, kMax> times_s{};

  PoseTimes() = default;
  PoseTimes(double first_s, double last_s, double knot_spacing_s) {
    const double length_s = last_s - first_s;
    if (length_s > longest_s(knot_spacing_s)) return;
    while (length_s > kLongest_knots[count] * knot_spacing_s) ++count;
    ++count;
    for (std::size_t k = 0; k < count; ++k)
      times_s[k] =
          0.5 * (first_s + last_s +
                 length_s * std::cos(kPi * (static_cast<double>(k) + 0.5) / static_cast<double>(count)));
  }
  static double longest_s(double knot_spacing_s) { return kLongest_knots.back() * knot_spacing_s; }

  // Lagrange's polynomials.
  std::array<double, kMax> weightsAt(double time_s) const {
    std::array<double, kMax> weights{};
    for (std::size_t i = 0; i < count; ++i) {
      weights[i] = 1.0;
      for (std::size_t k = 0; k < count; ++k)
        if (k != i) weights[i] *= (time_s - times_s[k]) / (times_s[i] - times_s[k]);
    }
    return weights;
  }
};

}  // namespace evical
