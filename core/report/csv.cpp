#include "core/report/csv.h"

#include "core/geometry/trajectory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace evical {

std::string trajectoryCsv(const CalibrationState& state) {
  constexpr double kInterval_s = 1.0 / 200.0;
  std::string text = "time_s,x_m,y_m,z_m,qx,qy,qz,qw\n";
  const So3Spline& rotation = state.world_from_imu_rotation;
  const VectorSpline& position = state.imu_in_world_m;
  if (rotation.segmentCount() < 1 || position.segmentCount() < 1) return text;
  const double begin_s = std::max(rotation.start_s, position.start_s);
  const double end_s = std::min(rotation.endTime_s(), position.endTime_s());
  const auto count = static_cast<long>(std::floor((end_s - begin_s) / kInterval_s + 1e-9)) + 1;
  for (long i = 0; i < count; ++i) {
    const double time_s = begin_s + static_cast<double>(i) * kInterval_s;
    const RigidTransform pose = worldFromImu(rotation, position, time_s);
    const Eigen::Vector3d& p = pose.translation_m;
    const Eigen::Quaterniond& q = pose.rotation;
    fmt::format_to(std::back_inserter(text), "{:.6f},{:.7f},{:.7f},{:.7f},{:.9f},{:.9f},{:.9f},{:.9f}\n",
                   time_s, p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

}  // namespace evical
