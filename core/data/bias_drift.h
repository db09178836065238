// How an IMU's biases move about their means: straight lines between equidistant knots, on the IMU's own
// clock (seconds since the recording's start). Before the first and after the last knot they stay.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace evical {

struct BiasDrift {
  double start_s = 0.0, knot_spacing_s = 0.0;
  std::vector<Eigen::Vector3d> gyroscope_rad_s, accelerometer_m_s2;  // at the knots, less the means

  std::size_t knots() const { return gyroscope_rad_s.size(); }  // 0: constant biases
  double knotTime_s(std::size_t knot) const { return start_s + static_cast<double>(knot) * knot_spacing_s; }

  // Of the knot before a time that has one after it.
  std::size_t segmentAt(double time_s) const {
    const double place = std::floor((time_s - start_s) / knot_spacing_s);
    return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(knots()) - 2.0));
  }
  // How far a time lies from knot `segment` to the next, 0 to 1.
  double shareAt(std::size_t segment, double time_s) const {
    return std::clamp((time_s - knotTime_s(segment)) / knot_spacing_s, 0.0, 1.0);
  }
  Eigen::Vector3d of(const std::vector<Eigen::Vector3d>& at_knots, double time_s) const {
    if (knots() < 2) return Eigen::Vector3d::Zero();
    const std::size_t segment = segmentAt(time_s);
    const double share = shareAt(segment, time_s);
    return (1.0 - share) * at_knots[segment] + share * at_knots[segment + 1];
  }
  // A knot's share in the mean over all time between the first and the last.
  double weight(std::size_t knot) const {
    const double inner = 1.0 / (static_cast<double>(knots()) - 1.0);
    return knot == 0 || knot + 1 == knots() ? 0.5 * inner : inner;
  }
};

}  // namespace evical
