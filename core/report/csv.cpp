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

std::string detectionsCsv(const std::vector<BoardObservations>& cameras) {
  std::string text =
      "camera,window_time_s,grid,circle,time_s,x_px,y_px,var_x_px2,cov_xy_px2,var_y_px2,vx_px_s,vy_px_s,"
      "major_px,minor_px,angle_rad,bursts,residual_rms_px\n";
  for (const BoardObservations& camera : cameras)
    for (const BoardView& view : camera.views)
      for (const CircleObservation& c : view.circles)
        fmt::format_to(
            std::back_inserter(text),
            "{},{:.6f},{},{},{:.9f},{:.4f},{:.4f},{:.4e},{:.4e},{:.4e},{:.2f},{:.2f},{:.3f},{:.3f},{:.4f},{},"
            "{:.4f}\n",
            camera.camera, view.time_s, view.kind == ViewKind::Complete ? "complete" : "partial", c.circle,
            c.time_s, c.centre_px.x(), c.centre_px.y(), c.covariance_px2(0, 0), c.covariance_px2(0, 1),
            c.covariance_px2(1, 1), c.velocity_px_s.x(), c.velocity_px_s.y(), c.semi_axes_px.x(),
            c.semi_axes_px.y(), c.angle_rad, c.events, c.residual_rms_px);
  return text;
}

std::string windowsCsv(const std::vector<BoardObservations>& cameras) {
  std::string text = "camera,time_s,half_width_s,outcome,bursts,candidates,circles,tracked\n";
  for (const BoardObservations& camera : cameras)
    for (const WindowReport& w : camera.windows)
      fmt::format_to(std::back_inserter(text), "{},{:.6f},{:.6f},{},{},{},{},{}\n", camera.camera, w.time_s,
                     w.half_width_s, windowOutcomeName(w.outcome), w.events, w.candidates, w.circles,
                     w.tracked ? 1 : 0);
  return text;
}

}  // namespace evical
