// Knot spacing of the splines for the motion (docs/maths.md, 8.11). Splines with several spacings are fitted
// to rates and accelerations: the residual of the closest knots is noise, and the additional residual of
// wider ones is missed motion.
#pragma once

#include "core/data/calibration_setup.h"
#include "core/initialisation/gyro_rotation.h"
#include "core/initialisation/world_rotation.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>

namespace evical {

// Default for unknown motion, and for trials.
inline constexpr double kUsualKnot_s = 0.02;
inline constexpr double kClosestKnots_s = 0.0025, kWidestKnots_s = 0.1;

// Precision of a camera's pose from one view: splines must miss less motion than that, too.
struct ViewPrecision {
  double angle_rad = std::numeric_limits<double>::infinity();
  double position_m = std::numeric_limits<double>::infinity();
};
// Precision of the most precise camera.
ViewPrecision viewPrecision(std::span<const CameraData> cameras, std::span<const AlignedCamera> aligned);

// Required spacing for one sensor of an IMU, in its unit.
struct KnotDemand {
  double spacing_s = kWidestKnots_s;  // the widest spacing with little missed motion
  double noise = 0.0;                 // of a sample, along one axis
  double missed = 0.0;                // by splines with that spacing, RMS along one axis
};

struct KnotSpacing {
  KnotDemand rates, accelerations;
  double spacing_s() const { return std::min(rates.spacing_s, accelerations.spacing_s); }
};

struct TimeRange {
  double begin_s = std::numeric_limits<double>::infinity(), end_s = -begin_s;
};

// Lower limit of the spacing: closer knots would follow the noise of single samples.
double closestKnots_s(const ImuData& imu);

// Spacing for one IMU's samples within the range, on its clock; `rotation` is its gyroscope's, without bias.
// kUsualKnot_s for too few samples.
KnotSpacing knotSpacing(const ImuData& imu, std::int64_t start_ns, TimeRange range,
                        const GyroRotation& rotation, const ViewPrecision& views);

// Text for users: the reason for the spacing `spacing_s`, which this IMU requires.
std::string describe(const std::string& imu, const KnotSpacing& asked, double spacing_s);

}  // namespace evical
