// Drift of an IMU's biases about their means: straight lines between equidistant knots, on the IMU's own
// clock (seconds since the recording's start). Constant before the first and after the last knot.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace evical {

struct BiasDrift {
  double start_s = 0.0, knot_spacing_s = 0.0;
  std::vector<Eigen::Vector3d> gyroscope_rad_s, accelerometer_m_s2;  // at the knots, minus the means

  std::size_t knots() const { return gyroscope_rad_s.size(); }  // 0: constant biases
  double knotTime_s(std::size_t knot) const { return start_s + static_cast<double>(knot) * knot_spacing_s; }

  // Index of the last knot before a time, except the final knot.
  std::size_t segmentAt(double time_s) const {
    const double place = std::floor((time_s - start_s) / knot_spacing_s);
    return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(knots()) - 2.0));
  }
  // Relative position of a time between knot `segment` and the next, 0 to 1.
  double shareAt(std::size_t segment, double time_s) const {
    return std::clamp((time_s - knotTime_s(segment)) / knot_spacing_s, 0.0, 1.0);
  }
  Eigen::Vector3d of(const std::vector<Eigen::Vector3d>& at_knots, double time_s) const {
    if (knots() < 2) return Eigen::Vector3d::Zero();
    const std::size_t segment = segmentAt(time_s);
    const double share = shareAt(segment, time_s);
    return (1.0 - share) * at_knots[segment] + share * at_knots[segment + 1];
  }
  // A knot's weight in the mean over the time between the first and the last knot.
  double weight(std::size_t knot) const {
    const double inner = 1.0 / (static_cast<double>(knots()) - 1.0);
    return knot == 0 || knot + 1 == knots() ? 0.5 * inner : inner;
  }
};

}  // namespace evical
