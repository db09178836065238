// Norm of gravity at a place on earth.
#pragma once

#include "core/numerics/angles.h"

#include <cmath>

namespace evical {

// Normal gravity on the ellipsoid of WGS 84 (Somigliana's formula), minus its decrease with height; real
// gravity is within kGravityAnomaly_m_s2 of it nearly everywhere.
inline double normalGravity_m_s2(double latitude_deg, double height_m) {
  constexpr double kAtEquator_m_s2 = 9.7803253359, kGrowth = 0.00193185265241;
  constexpr double kEccentricity2 = 0.00669437999014, kFall_per_s2 = 3.086e-6;
  const double sine = std::sin(kRadPerDeg * latitude_deg), sine2 = sine * sine;
  return kAtEquator_m_s2 * (1.0 + kGrowth * sine2) / std::sqrt(1.0 - kEccentricity2 * sine2) -
         kFall_per_s2 * height_m;
}
inline constexpr double kGravityAnomaly_m_s2 = 1e-3;

}  // namespace evical
