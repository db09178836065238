#include "core/report/csv.h"

#include "core/geometry/trajectory.h"
#include "core/report/csv_text.h"

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

void residualsCsv(const NamedResult& named, std::span<const CircleResidual> residuals, const TextSink& sink) {
  std::string text =
      "camera,view,circle,time_s,x_px,y_px,residual_x_px,residual_y_px,sigma_x_px,sigma_y_px,used\n";
  constexpr std::size_t kPiece_bytes = 1 << 16;
  for (const CircleResidual& r : residuals) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{}\n",
                   csvWord(named.cameras.at(static_cast<std::size_t>(r.camera)).name), r.view, r.circle,
                   r.time_s, r.centre_px.x(), r.centre_px.y(), r.residual_px.x(), r.residual_px.y(),
                   r.sigma_px.x(), r.sigma_px.y(), r.used ? 1 : 0);
    if (text.size() < kPiece_bytes) continue;
    sink(text);
    text.clear();
  }
  sink(text);
}

namespace {

void append(const Eigen::Vector3d& values, std::string& text) {
  for (const double value : values) fmt::format_to(std::back_inserter(text), ",{:.6e}", value);
}

Eigen::Vector3d at(const std::vector<Eigen::Vector3d>& sigmas, std::size_t knot) {
  return knot < sigmas.size() ? sigmas[knot] : Eigen::Vector3d::Zero();
}

}  // namespace

std::string biasesCsv(const NamedResult& named) {
  std::string text;
  const CalibrationResult& result = *named.result;
  for (std::size_t i = 0; i < result.state.imus.size(); ++i) {
    const ImuState& imu = result.state.imus[i];
    const ImuUncertainty sigma =
        i < result.uncertainty.imus.size() ? result.uncertainty.imus[i] : ImuUncertainty{};
    for (std::size_t k = 0; k < imu.bias_drift.knots(); ++k) {
      const double time_s = imu.bias_drift.knotTime_s(k);
      text += fmt::format("{},{:.6f}", quotedCsv(named.imus.at(i).name), time_s);
      append(imu.gyroscopeBiasAt_rad_s(time_s), text);
      append(at(sigma.gyroscope_drift_std_rad_s, k), text);
      append(imu.accelerometerBiasAt_m_s2(time_s), text);
      append(at(sigma.accelerometer_drift_std_m_s2, k), text);
      text += "\n";
    }
  }
  if (text.empty()) return text;
  return "imu,time_s,gyroscope_x_rad_s,gyroscope_y_rad_s,gyroscope_z_rad_s,gyroscope_std_x_rad_s,"
         "gyroscope_std_y_rad_s,gyroscope_std_z_rad_s,accelerometer_x_m_s2,accelerometer_y_m_s2,"
         "accelerometer_z_m_s2,accelerometer_std_x_m_s2,accelerometer_std_y_m_s2,accelerometer_std_z_m_s2\n" +
         text;
}

}  // namespace evical
