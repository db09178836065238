// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/trajectory_track.h"

#include "ui/scene/scene_shapes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace evical::ui {
namespace {

constexpr double kSamplesPerKnot = 4.0;  // finer than a pixel for motion by hand
constexpr double kMaxSamples = 60000.0;
constexpr double kStations = 25.0;      // about the number of distinguishable frustums
constexpr double kNearestView_s = 0.1;  // at a larger distance from a view, a sample has no residual

struct ViewError {
  double time_s = 0.0, rms_px = 0.0;
};

std::vector<ViewError> errorsOfViews(std::span<const CircleResidual> residuals) {
  struct Sum {
    double time_s = 0.0, squares_px2 = 0.0;
    int count = 0;
  };
  std::map<std::pair<int, int>, Sum> sums;
  for (const CircleResidual& residual : residuals) {
    if (!residual.used) continue;
    Sum& sum = sums[{residual.camera, residual.view}];
    sum.time_s += residual.time_s;
    sum.squares_px2 += residual.residual_px.squaredNorm();
    ++sum.count;
  }
  std::vector<ViewError> errors;
  for (const auto& [view, sum] : sums) {
    errors.push_back({sum.time_s / sum.count, std::sqrt(sum.squares_px2 / sum.count)});
  }
  std::sort(errors.begin(), errors.end(),
            [](const ViewError& a, const ViewError& b) { return a.time_s < b.time_s; });
  return errors;
}

double residualNear(const std::vector<ViewError>& errors, double time_s) {
  const auto after = std::lower_bound(errors.begin(), errors.end(), time_s,
                                      [](const ViewError& e, double t) { return e.time_s < t; });
  double nearest_s = kNearestView_s, rms_px = std::numeric_limits<double>::quiet_NaN();
  for (auto it = after == errors.begin() ? after : after - 1; it != errors.end() && it <= after; ++it) {
    const double distance_s = std::abs(it->time_s - time_s);
    if (distance_s > nearest_s) continue;
    nearest_s = distance_s;
    rms_px = it->rms_px;
  }
  return rms_px;
}

std::vector<CameraStation> placeStations(const CalibrationState& state, double begin_s, double end_s) {
  std::vector<CameraStation> stations;
  const double interval_s = roundedUp((end_s - begin_s) / kStations);
  for (double t = std::ceil(begin_s / interval_s) * interval_s; t <= end_s; t += interval_s) {
    if (const auto rig = rigAt(state, t)) stations.push_back({t, rig->world_from_cameras});
  }
  return stations;
}

}  // namespace

bool TrajectoryTrack::hasResiduals() const {
  return std::any_of(residuals_px.begin(), residuals_px.end(), [](double r) { return std::isfinite(r); });
}

std::size_t TrajectoryTrack::nearest(double time_s) const {
  const auto after = std::lower_bound(times_s.begin(), times_s.end(), time_s);
  if (after == times_s.begin()) return 0;
  if (after == times_s.end()) return times_s.size() - 1;
  const auto index = static_cast<std::size_t>(after - times_s.begin());
  return *after - time_s < time_s - *(after - 1) ? index : index - 1;
}

bool hasTrajectory(const CalibrationState& state) {
  return state.world_from_imu_rotation.segmentCount() > 0 && state.imu_in_world_m.segmentCount() > 0;
}

double firstCameraTime_s(const CalibrationState& state, double time_s) {
  return state.cameras.empty() ? time_s : sensorTime_s(state.cameras.front(), time_s);
}

std::optional<RigInstant> rigAt(const CalibrationState& state, double camera_time_s) {
  const double time_s =
      state.cameras.empty() ? camera_time_s : referenceTime_s(state.cameras.front(), camera_time_s);
  if (!hasTrajectory(state) || !state.imu_in_world_m.contains(time_s)) return std::nullopt;
  RigInstant rig;
  rig.imu = motionAt(state.world_from_imu_rotation, state.imu_in_world_m, time_s);
  for (const CameraState& camera : state.cameras) {
    rig.world_from_cameras.push_back(rig.imu.world_from_imu * camera.reference_from_camera);
  }
  for (const ImuState& imu : state.imus) {
    rig.world_from_imus.push_back(rig.imu.world_from_imu * imu.reference_from_imu);
  }
  return rig;
}

TrajectoryTrack sampleTrajectory(const CalibrationState& state, std::span<const CircleResidual> residuals) {
  TrajectoryTrack track;
  if (!hasTrajectory(state)) return track;
  const VectorSpline& spline = state.imu_in_world_m;
  const double begin_s = spline.start_s, end_s = spline.endTime_s();
  const double step_s = std::max(spline.knot_spacing_s / kSamplesPerKnot, (end_s - begin_s) / kMaxSamples);
  const std::vector<ViewError> errors = errorsOfViews(residuals);
  for (double t = begin_s; t <= end_s; t += step_s) {
    const VectorSample sample = evaluate(spline, t);
    track.times_s.push_back(firstCameraTime_s(state, t));
    track.positions_m.push_back(sample.value);
    track.speeds_m_s.push_back(sample.velocity.norm());
    track.residuals_px.push_back(residualNear(errors, track.times_s.back()));
  }
  track.stations = placeStations(state, firstCameraTime_s(state, begin_s), firstCameraTime_s(state, end_s));
  return track;
}

double roundedUp(double value) {
  if (!(value > 0.0)) return 1.0;
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (value <= digit * power * (1.0 + 1e-9)) return digit * power;
  }
  return 10.0 * power;
}

std::string trackCsv(const TrajectoryTrack& track) {
  const bool residuals = track.hasResiduals();
  std::string text = "time_s,x_m,y_m,z_m,speed_m_s";
  text += residuals ? ",residual_px\n" : "\n";
  const auto add = [&text](double value, char end) {
    std::array<char, 32> digits{};
    const auto written = std::to_chars(digits.begin(), digits.end(), value);
    if (std::isfinite(value)) text.append(digits.begin(), written.ptr);
    text += end;
  };
  for (std::size_t k = 0; k < track.times_s.size(); ++k) {
    add(track.times_s[k], ',');
    for (const double coordinate : track.positions_m[k]) add(coordinate, ',');
    add(track.speeds_m_s[k], residuals ? ',' : '\n');
    if (residuals) add(track.residuals_px[k], '\n');
  }
  return text;
}

}  // namespace evical::ui

namespace evical::ui {
namespace {

constexpr std::size_t kMaxPoints = 12000;

// Newest event by pixel.
std::vector<Event> newestByPixel(const std::vector<Event>& events, const Resolution& resolution_px) {
  const auto width = static_cast<std::size_t>(resolution_px.width_px);
  const auto height = static_cast<std::size_t>(resolution_px.height_px);
  std::vector<Event> newest;
  std::vector<bool> taken(width * height, false);
  for (auto event = events.rbegin(); event != events.rend(); ++event) {
    if (event->x_px >= width || event->y_px >= height) continue;
    const std::size_t pixel = event->y_px * width + event->x_px;
    if (taken[pixel]) continue;
    taken[pixel] = true;
    newest.push_back(*event);
  }
  return newest;
}

}  // namespace

std::vector<FrustumEvent> onImagePlane(const std::vector<Event>& events,
                                       const std::optional<CameraIntrinsics>& intrinsics) {
  if (!intrinsics || !intrinsics->resolution_px.known()) return {};
  const std::vector<Event> newest = newestByPixel(events, intrinsics->resolution_px);
  const std::size_t every = std::max<std::size_t>(1, (newest.size() + kMaxPoints - 1) / kMaxPoints);
  std::vector<FrustumEvent> points;
  for (std::size_t k = 0; k < newest.size(); k += every)
    points.push_back({rayAtUnitDepth(*intrinsics, {newest[k].x_px, newest[k].y_px}), newest[k].brighter});
  return points;
}

}  // namespace evical::ui
