#include "core/initialisation/rotation_rates.h"

#include "core/base/time.h"
#include "core/data/unfit_samples.h"
#include "core/initialisation/camera_imu_rotation.h"
#include "core/initialisation/camera_poses.h"
#include "core/initialisation/gyro_rotation.h"
#include "core/initialisation/time_offset.h"
#include "core/numerics/robust.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {
namespace {

double rmsDifference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return a.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(a.size()));
}

// Without scale, misalignment and bias.
std::vector<ImuSample> trueSamples(const ImuData& imu, const ImuState& state, std::int64_t start_ns) {
  const Eigen::Matrix3d true_from_measured = state.gyroscopeMatrix().inverse();
  std::vector<ImuSample> samples = imu.samples;
  for (ImuSample& sample : samples)
    sample.angular_rate_rad_s =
        true_from_measured *
        (sample.angular_rate_rad_s - state.gyroscopeBiasAt_rad_s(secondsSince(start_ns, sample.time_ns)));
  return samples;
}

}  // namespace

double RotationRates::rmsDifferenceBefore_rad_s() const {
  return rmsDifference(camera_rad_s, imu_before_rad_s);
}

double RotationRates::rmsDifferenceAfter_rad_s() const {
  return rmsDifference(camera_rad_s, imu_after_rad_s);
}

RotationRates rotationRates(const CameraData& camera, const Board& board, const CameraState& camera_state,
                            const ImuData& imu, const ImuState& imu_state, std::int64_t start_ns,
                            const InitialisationOptions& options, const RunContext& context) {
  RotationRates rates;
  if (imu.samples.size() < 2) return rates;
  const auto imuTime_s = [&](double camera_time_s) {
    return sensorTime_s(imu_state, referenceTime_s(camera_state, camera_time_s));
  };
  const GyroRotation gyro(trueSamples(imu, imu_state, start_ns), start_ns);
  context.throwIfStopped();
  std::vector<CameraPose> poses = estimateCameraPoses(camera, board, options).poses;
  context.throwIfStopped();
  resolveAmbiguousPoses(poses, gyro, camera_state.time_offset_s - imu_state.time_offset_s,
                        options.max_pair_s);
  for (std::size_t k = 0, l = 0; k < poses.size(); ++k) {
    const double begin_s = poses[k].time_s;
    while (l < poses.size() && poses[l].time_s - begin_s < options.pair_gap_s - 1e-6) ++l;
    if (l == poses.size()) break;
    const double end_s = poses[l].time_s, duration_s = end_s - begin_s;
    if (duration_s > options.max_pair_s) continue;
    if (!gyro.covers(begin_s, end_s) || !gyro.covers(imuTime_s(begin_s), imuTime_s(end_s))) continue;
    rates.time_s.push_back(0.5 * (begin_s + end_s));
    rates.camera_rad_s.push_back(
        rotationAngleBetween_rad(poses[k].world_from_camera.rotation, poses[l].world_from_camera.rotation) /
        duration_s);
    rates.imu_before_rad_s.push_back(gyro.between(begin_s, end_s).norm() / duration_s);
    rates.imu_after_rad_s.push_back(gyro.between(imuTime_s(begin_s), imuTime_s(end_s)).norm() / duration_s);
  }
  return rates;
}

// The ratio of medians leads to a first scale, with which search and alignment work as usual. Rotations along
// the gyroscope's refine it: the noise of views, which makes rates seem larger, averages out in them.
std::optional<RateRatio> rateRatio(const CameraData& camera, const Board& board, const ImuData& imu,
                                   std::int64_t start_ns, const InitialisationOptions& options,
                                   const RunContext& context) {
  const std::vector<CameraPose> poses = estimateCameraPoses(camera, board, options, context).poses;
  const std::vector<RotationPair> pairs = rotationPairs(poses, options.pair_gap_s, options.max_pair_s);
  std::vector<ImuSample> samples = withoutRateSpikes(imu.samples);
  if (pairs.empty() || samples.size() < 2) return std::nullopt;
  std::vector<double> seen_rad_s, felt_rad_s;
  for (const RotationPair& pair : pairs)
    seen_rad_s.push_back(pair.seen_rad.norm() / (pair.to_s - pair.from_s));
  for (const ImuSample& sample : samples) felt_rad_s.push_back(sample.angular_rate_rad_s.norm());
  const double first = medianOf(std::move(felt_rad_s)) / std::max(medianOf(std::move(seen_rad_s)), 1e-9);
  if (!(first > 0.0) || !std::isfinite(first)) return std::nullopt;
  for (ImuSample& sample : samples) sample.angular_rate_rad_s /= first;
  const GyroRotation gyro(samples, start_ns);
  const std::vector<TimeOffsetPeak> peaks = correlateTimeOffset(poses, gyro, options, camera.prior);
  if (peaks.empty() || peaks.front().correlation < options.clear_peak_correlation) return std::nullopt;
  const std::optional<RelativeRotation> aligned =
      estimateCameraImuRotation(poses, gyro, peaks.front().time_offset_s, options, camera.prior);
  if (!aligned) return std::nullopt;
  const GyroRotation unbiased(samples, start_ns, aligned->gyroscope_bias_rad_s);
  struct Rotated {
    Eigen::Vector3d seen_rad, felt_rad;
  };
  std::vector<Rotated> rotated;
  std::vector<double> angles_rad, slopes, rests;
  for (const RotationPair& pair : pairs) {
    const double from_s = pair.from_s + aligned->time_offset_s, to_s = pair.to_s + aligned->time_offset_s;
    if (!unbiased.covers(from_s, to_s)) continue;
    rotated.push_back({aligned->reference_from_sensor * pair.seen_rad, unbiased.between(from_s, to_s)});
    angles_rad.push_back(rotated.back().felt_rad.norm());
  }
  const double usual_rad = medianOf(std::move(angles_rad));
  for (const Rotated& each : rotated)
    if (each.felt_rad.norm() >= usual_rad && usual_rad > 0.0)
      slopes.push_back(each.felt_rad.dot(each.seen_rad) / each.felt_rad.squaredNorm());
  const double slope = medianOf(std::move(slopes));
  if (!(slope > 0.0)) return std::nullopt;
  for (const Rotated& each : rotated) rests.push_back((each.seen_rad - slope * each.felt_rad).norm());
  if (medianOf(std::move(rests)) > options.max_unexplained_motion * slope * usual_rad) return std::nullopt;
  return RateRatio{first / slope, peaks.front().correlation};
}

}  // namespace evical
