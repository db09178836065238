#include "core/pipeline/maintain/imu_unit_check.h"

#include "core/base/error.h"
#include "core/base/how_to.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace evical {
namespace {

constexpr std::size_t kFewestUnitWindows = 20;  // windows

}  // namespace

void checkUnits(const ImuMeans& imu) {
  if (imu.windows.size() < kFewestUnitWindows) return;
  std::vector<double> norms;
  for (const MeansWindow& window : imu.windows) norms.push_back(window.force_m_s2.norm());
  const double norm = medianOf(std::move(norms));
  if (norm > 0.3 && norm < 3.0)
    throw badInput(imu.name, fmt::format("its mean specific force is {:.2f} m/s^2: the log is in g", norm),
                   "Give " + howTo(HowTo::SetAccelerationUnit, {"g"}));
  if (norm > 30.0)
    throw badInput(
        imu.name,
        fmt::format("its mean specific force is {:.0f} m/s^2: the log is already in m/s^2, or in milli-g",
                    norm),
        "Give " + howTo(HowTo::SetAccelerationUnit, {"m/s^2"}) + ", or convert the log");
  const double scale = rateScale(imu.windows);
  if (scale > 0.01 && scale < 0.03)
    throw badInput(
        imu.name,
        fmt::format(
            "gravity rotates {:.0f} times more slowly than the gyroscope measures: the rates are in deg/s",
            1.0 / scale),
        "Give " + howTo(HowTo::SetAngularRateUnit, {"deg/s"}));
  if (scale > 30.0 && scale < 100.0)
    throw badInput(
        imu.name,
        fmt::format("gravity rotates {:.0f} times faster than the gyroscope measures: the rates are in rad/s",
                    scale),
        "Give " + howTo(HowTo::SetAngularRateUnit, {"rad/s"}));
}

void checkDirection(const ImuMeans& own, const ImuMeans& reference,
                    const Eigen::Quaterniond& reference_from_own, double later_s) {
  std::vector<double> cosines;
  auto other = reference.windows.begin();
  for (const MeansWindow& window : own.windows) {
    const double time_s = window.time_s + later_s;
    other = std::find_if(other, reference.windows.end(), [&](const MeansWindow& each) {
      return each.time_s + 0.5 * WindowMeans::kLength_s > time_s;
    });
    if (other == reference.windows.end()) break;
    if (other->time_s > time_s + 0.5 * WindowMeans::kLength_s) continue;
    const Eigen::Vector3d turned = reference_from_own * window.force_m_s2;
    cosines.push_back(turned.dot(other->force_m_s2) /
                      std::max(turned.norm() * other->force_m_s2.norm(), 1e-9));
  }
  constexpr double kAgainst = -0.5;
  if (cosines.size() < kFewestUnitWindows || medianOf(std::move(cosines)) > kAgainst) return;
  throw badInput(own.name,
                 fmt::format("its specific force is opposite to that of {}: one of the two logs has "
                             "gravity instead of specific force (unit -g), or an IMU was mounted upside down",
                             reference.name),
                 "Convert the wrong log (" + howTo(HowTo::SetAccelerationUnit, {"-g"}) +
                     " applies to all logs), or calibrate again");
}

}  // namespace evical
