// Weights of the uniform cumulative cubic B-spline (docs/maths.md, 2) at u in a
// segment, and their time derivatives.
#pragma once

#include <Eigen/Core>

namespace evical {

// l1, l2, l3 and their first and second derivatives with respect to time.
struct CumulativeWeights {
  Eigen::Vector3d value, first_s, second_s2;
};

inline CumulativeWeights cumulativeWeights(double u, double knot_spacing_s) {
  const double u2 = u * u, u3 = u2 * u;
  const double rate = 1.0 / knot_spacing_s, rate2 = rate * rate;
  CumulativeWeights w;
  w.value << (5.0 + 3.0 * u - 3.0 * u2 + u3) / 6.0, (1.0 + 3.0 * u + 3.0 * u2 - 2.0 * u3) / 6.0, u3 / 6.0;
  w.first_s << 0.5 * rate * (1.0 - 2.0 * u + u2), 0.5 * rate * (1.0 + 2.0 * u - 2.0 * u2), 0.5 * rate * u2;
  w.second_s2 << rate2 * (u - 1.0), rate2 * (1.0 - 2.0 * u), rate2 * u;
  return w;
}

// The same as weights of the four control points: value(t) = sum_k weights[k] p_{s+k}.
struct ControlPointWeights {
  Eigen::Vector4d value, first_s, second_s2;
};

inline ControlPointWeights controlPointWeights(double u, double knot_spacing_s) {
  const CumulativeWeights l = cumulativeWeights(u, knot_spacing_s);
  ControlPointWeights w;
  w.value << 1.0 - l.value[0], l.value[0] - l.value[1], l.value[1] - l.value[2], l.value[2];
  w.first_s << -l.first_s[0], l.first_s[0] - l.first_s[1], l.first_s[1] - l.first_s[2], l.first_s[2];
  w.second_s2 << -l.second_s2[0], l.second_s2[0] - l.second_s2[1], l.second_s2[1] - l.second_s2[2],
      l.second_s2[2];
  return w;
}

}  // namespace evical
