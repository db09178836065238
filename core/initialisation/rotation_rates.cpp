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
                        options.longest_pair_s);
  for (std::size_t k = 0, l = 0; k < poses.size(); ++k) {
    const double begin_s = poses[k].time_s;
    while (l < poses.size() && poses[l].time_s - begin_s < options.pair_gap_s - 1e-6) ++l;
    if (l == poses.size()) break;
    const double end_s = poses[l].time_s, duration_s = end_s - begin_s;
    if (duration_s > options.longest_pair_s) continue;
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

// The ratio of medians leads to a first scale, with which the search for the time offset works as usual; ratios of
// single pairs at this offset refine it.
std::optional<RateRatio> rateRatio(const CameraData& camera, const Board& board, const ImuData& imu,
                                   std::int64_t start_ns, const InitialisationOptions& options,
                                   const RunContext& context) {
  const std::vector<CameraPose> poses = estimateCameraPoses(camera, board, options, context).poses;
  const std::vector<RotationPair> pairs = rotationPairs(poses, options.pair_gap_s, options.longest_pair_s);
  std::vector<ImuSample> samples = withoutRateSpikes(imu.samples);
  if (pairs.empty() || samples.size() < 2) return std::nullopt;
  const auto seenRate = [](const RotationPair& pair) {
    return pair.seen_rad.norm() / (pair.to_s - pair.from_s);
  };
  std::vector<double> seen, felt, ratios;
  for (const RotationPair& pair : pairs) seen.push_back(seenRate(pair));
  for (const ImuSample& sample : samples) felt.push_back(sample.angular_rate_rad_s.norm());
  const double usual_rad_s = medianOf(std::move(seen));
  const double first = medianOf(std::move(felt)) / std::max(usual_rad_s, 1e-9);
  if (!(first > 0.0) || !std::isfinite(first)) return std::nullopt;
  for (ImuSample& sample : samples) sample.angular_rate_rad_s /= first;
  const GyroRotation gyro(samples, start_ns);
  const std::vector<TimeOffsetPeak> peaks = correlateTimeOffset(poses, gyro, options, camera.prior);
  if (peaks.empty() || peaks.front().correlation < options.clear_peak_correlation) return std::nullopt;
  const double offset_s = peaks.front().time_offset_s;
  for (const RotationPair& pair : pairs) {
    const double from_s = pair.from_s + offset_s, to_s = pair.to_s + offset_s;
    if (seenRate(pair) < usual_rad_s || !gyro.covers(from_s, to_s)) continue;
    ratios.push_back(gyro.between(from_s, to_s).norm() / pair.seen_rad.norm());
  }
  if (ratios.empty()) return std::nullopt;
  return RateRatio{first * medianOf(std::move(ratios)), peaks.front().correlation};
}

}  // namespace evical
