#include "core/report/html/measures.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/trajectory.h"
#include "core/numerics/angles.h"

#include <algorithm>
#include <cmath>

namespace evical::html {
namespace {

Eigen::Vector2d onSensor(const std::optional<CameraIntrinsics>& intrinsics, const Eigen::Vector2d& ideal_px) {
  return intrinsics ? pixelFromIdeal(*intrinsics, ideal_px) : ideal_px;
}

std::vector<SensorCell> makeCells(const Resolution& resolution_px) {
  std::vector<SensorCell> cells;
  if (!resolution_px.known()) return cells;
  const Eigen::Vector2d size_px(static_cast<double>(resolution_px.width_px) / CameraMeasures::kCols,
                                static_cast<double>(resolution_px.height_px) / CameraMeasures::kRows);
  for (int row = 0; row < CameraMeasures::kRows; ++row) {
    for (int col = 0; col < CameraMeasures::kCols; ++col) {
      SensorCell& cell = cells.emplace_back();
      cell.low_px = size_px.cwiseProduct(Eigen::Vector2d(col, row));
      cell.high_px = cell.low_px + size_px;
    }
  }
  return cells;
}

SensorCell* cellAt(CameraMeasures& camera, const Eigen::Vector2d& pixel) {
  if (camera.cells.empty() || !pixel.allFinite()) return nullptr;
  const int col =
      static_cast<int>(std::floor(pixel.x() * CameraMeasures::kCols / camera.resolution_px.width_px));
  const int row =
      static_cast<int>(std::floor(pixel.y() * CameraMeasures::kRows / camera.resolution_px.height_px));
  if (col < 0 || col >= CameraMeasures::kCols || row < 0 || row >= CameraMeasures::kRows) return nullptr;
  return &camera.cells[static_cast<std::size_t>(row * CameraMeasures::kCols + col)];
}

void addDetections(const BoardObservations& observations, const std::optional<CameraIntrinsics>& intrinsics,
                   CameraMeasures& camera) {
  for (const WindowReport& window : observations.windows)
    ++camera.outcomes[static_cast<std::size_t>(window.outcome)];
  camera.windows = static_cast<int>(observations.windows.size());
  camera.views = static_cast<int>(observations.views.size());
  if (!observations.windows.empty())
    camera.duration_s = observations.windows.back().time_s - observations.windows.front().time_s;
  for (const BoardView& view : observations.views) {
    camera.partial += view.kind == ViewKind::Partial ? 1 : 0;
    for (const CircleObservation& circle : view.circles) {
      camera.centres_px.push_back(onSensor(intrinsics, circle.centre_px));
      if (SensorCell* const cell = cellAt(camera, camera.centres_px.back())) ++cell->circles;
    }
  }
}

void addPoses(const BoardObservations& observations, const CalibrationState& state, std::size_t index,
              const SeenBoard& seen, CameraMeasures& camera) {
  if (index >= state.cameras.size() || state.imu_in_world_m.segmentCount() < 1) return;
  Eigen::Vector2d middle_m = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& centre_m : boardPoints_m(seen.board))
    middle_m += centre_m / seen.board.pointCount();
  const CameraState& mounted = state.cameras[index];
  for (const BoardView& view : observations.views) {
    const double time_s = referenceTime_s(mounted, view.time_s);
    if (!state.world_from_imu_rotation.contains(time_s) || !state.imu_in_world_m.contains(time_s)) continue;
    const RigidTransform pose =
        cameraFromWorld(state.world_from_imu_rotation, state.imu_in_world_m, mounted.reference_from_camera,
                        timeOffsetAt_s(mounted, view.time_s), view.time_s) *
        state.boardAt(seen.index).world_from_board;
    const Eigen::Vector3d normal = pose.rotation * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d along = pose.rotation * Eigen::Vector3d::UnitX();
    const Eigen::Vector3d at =
        pose.rotation * Eigen::Vector3d(middle_m.x(), middle_m.y(), 0.0) + pose.translation_m;
    camera.poses.push_back({view.time_s, at.norm(), kDegPerRad * std::atan2(-normal.y(), normal.z()),
                            kDegPerRad * std::atan2(normal.x(), normal.z()),
                            kDegPerRad * std::atan2(along.y(), along.x())});
  }
}

void addResiduals(const ReportData& data, std::size_t index,
                  const std::optional<CameraIntrinsics>& intrinsics, CameraMeasures& camera) {
  for (const CircleResidual& residual : data.named.result->circle_residuals) {
    if (residual.camera != static_cast<int>(index) || !residual.used) continue;
    SensorCell* const cell = cellAt(camera, onSensor(intrinsics, residual.centre_px));
    if (cell == nullptr) continue;
    ++cell->residuals;
    cell->mean_residual_px += residual.residual_px;
  }
  for (SensorCell& cell : camera.cells)
    if (cell.residuals > 0) cell.mean_residual_px /= cell.residuals;
}

CameraMeasures measureCamera(const ReportData& data, std::size_t index) {
  CameraMeasures camera;
  const std::optional<CameraIntrinsics> intrinsics =
      index < data.lenses.size() ? data.lenses[index].detection_intrinsics : std::nullopt;
  if (index < data.resolutions_px.size()) camera.resolution_px = data.resolutions_px[index];
  if (!camera.resolution_px.known() && intrinsics) camera.resolution_px = intrinsics->resolution_px;
  camera.cells = makeCells(camera.resolution_px);
  addDetections(data.cameras[index], intrinsics, camera);
  addPoses(data.cameras[index], data.named.result->state, index, data.boards.at(index), camera);
  addResiduals(data, index, intrinsics, camera);
  return camera;
}

template <class Value>
AxisMoments moments(std::size_t count, Value&& value) {
  AxisMoments result;
  if (count == 0) return result;
  const double n = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) result.mean += value(i) / n;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d off = value(i) - result.mean;
    squares += off.cwiseProduct(off) / n;
    result.largest = result.largest.cwiseMax(off.cwiseAbs());
  }
  result.deviation = squares.cwiseSqrt();
  return result;
}

ImuMeasures measureImu(const ReportData& data, std::size_t index) {
  ImuMeasures imu;
  const ImuData& given = data.imus[index];
  if (given.samples.empty()) return imu;
  imu.rate_hz = given.rate_hz();
  imu.duration_s = 1e-9 * static_cast<double>(given.samples.back().time_ns - given.samples.front().time_ns);
  std::vector<Eigen::Vector3d> rates, forces;
  for (const ImuSample& sample : given.samples) {
    if (measuresRate(sample)) rates.push_back(sample.angular_rate_rad_s);
    if (measuresForce(sample)) forces.push_back(sample.specific_force_m_s2);
  }
  imu.rate_rad_s = moments(rates.size(), [&](std::size_t i) { return rates[i]; });
  imu.force_m_s2 = moments(forces.size(), [&](std::size_t i) { return forces[i]; });
  imu.rate_sigma_rad_s = given.gyroscopeSigma_rad_s();
  imu.force_sigma_m_s2 = given.accelerometerSigma_m_s2();
  const CalibrationState& state = data.named.result->state;
  if (index >= state.imus.size() || state.imu_in_world_m.segmentCount() < 1) return imu;
  imu.signals = predictSignals(given, data.start_ns, state, index);
  const auto residual = [](const SensorSignal& signal) {
    return moments(signal.time_s.size(), [&](std::size_t i) -> Eigen::Vector3d {
      return signal.measured[i] - signal.predicted[i];
    });
  };
  imu.rate_residual = residual(imu.signals.rate_rad_s);
  imu.force_residual = residual(imu.signals.force_m_s2);
  return imu;
}

}  // namespace

double CameraMeasures::coveredShare() const {
  if (cells.empty()) return 0.0;
  const auto seen =
      std::count_if(cells.begin(), cells.end(), [](const SensorCell& c) { return c.circles > 0; });
  return static_cast<double>(seen) / static_cast<double>(cells.size());
}

Measures measure(const ReportData& data) {
  Measures all;
  for (std::size_t i = 0; i < data.cameras.size(); ++i) {
    all.cameras.push_back(measureCamera(data, i));
    all.duration_s = std::max(all.duration_s, all.cameras.back().duration_s);
  }
  for (std::size_t i = 0; i < data.imus.size(); ++i) {
    all.imus.push_back(measureImu(data, i));
    if (data.cameras.empty()) all.duration_s = std::max(all.duration_s, all.imus.back().duration_s);
  }
  return all;
}

}  // namespace evical::html
