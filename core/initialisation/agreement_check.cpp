#include "core/initialisation/agreement_check.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/data/stamp_batches.h"
#include "core/data/unfit_samples.h"
#include "core/initialisation/axes_check.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {
namespace {

// RMS of the samples' forces about their mean.
double forceSpread_m_s2(const ImuData& imu) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0.0;
  for (const ImuSample& sample : imu.samples) {
    sum += sample.specific_force_m_s2;
    squares += sample.specific_force_m_s2.squaredNorm();
  }
  const auto count = static_cast<double>(imu.samples.size());
  return std::sqrt(std::max(0.0, squares / count - (sum / count).squaredNorm()) / 3.0);
}

// Checks the times of one sensor.
void checkStampsApart(const std::string& imu, const std::vector<std::int64_t>& times_ns) {
  const std::optional<StampBatches> batches = findStampBatches(times_ns);
  if (!batches) return;
  throw calibrationFailed(
      imu, batches->text(),
      "Configure the driver to stamp each sample, or distribute the stamps of a batch over its duration");
}

// Words for a gyroscope that is at its limit for a large part of the samples; empty if none is.
std::string rateLimitOf(const ImuData& imu, double least_share) {
  const std::array<double, kImuAxes.size()> shares = saturatedShares(imu.samples);
  std::size_t worst = 0;
  for (std::size_t axis = 0; axis < kImuAxes.size(); ++axis)
    if (kImuAxes[axis].rate && shares[axis] > shares[worst]) worst = axis;
  if (shares[worst] < least_share) return {};
  return fmt::format("{} is at its limit in {:.0f} % of the samples", kImuAxes[worst].name,
                     100.0 * shares[worst]);
}

}  // namespace

// Detects drivers that stamp a message's samples on arrival: steps of their stamps cannot be distinguished
// from motion.
void checkStampsApart(const ImuData& imu) {
  std::vector<std::int64_t> rates_ns, forces_ns;
  for (const ImuSample& sample : imu.samples) {
    if (measuresRate(sample)) rates_ns.push_back(sample.time_ns);
    if (measuresForce(sample)) forces_ns.push_back(sample.time_ns);
  }
  checkStampsApart(imu.name, rates_ns);
  checkStampsApart(imu.name, forces_ns);
}

const ImuAxis* deadAxis(const ImuData& imu) {
  for (const ImuAxis& axis : kImuAxes)
    if (!imu.samples.empty() && std::ranges::all_of(imu.samples, [&](const ImuSample& sample) {
          return axis.of(sample) == axis.of(imu.samples.front());
        }))
      return &axis;
  return nullptr;
}

void checkAxesAlive(const ImuData& imu) {
  const ImuAxis* const axis = deadAxis(imu);
  if (axis == nullptr) return;
  throw calibrationFailed(
      imu.name,
      fmt::format("{} is constant at {:.4g}: the axis is dead", axis->name, axis->of(imu.samples.front())),
      "Check the IMU and its driver");
}

void checkRotationsAgree(const CalibrationInput& input, const CameraAgreement& agreement,
                         const InitialisationOptions& options, const RunContext& context) {
  const RotationAgreement& rotation = agreement.rotation;
  const std::string& imu = input.imus[input.reference_imu].name;
  // Rotations of single views have errors of 1 to 3 mrad, which dominate in a recording with hardly any
  // motion.
  constexpr double kBeyondNoise_rad = 0.01;
  if (rotation.pairs == 0 || rotation.rest_rad < kBeyondNoise_rad) return;
  // If motion about one axis dominates, wrong handedness leaves a small residual, but a reflection a smaller
  // one. A mirrored gyroscope left 33 % of such a motion, of 40 % that are allowed, and its reflection less
  // than a fifth of that (much_better). far_better and suspicious_motion are chosen, not measured.
  const bool unexplained = rotation.rotated >= options.largest_unexplained_motion;
  const bool left_handed =
      unexplained ? rotation.reflected < options.far_better * rotation.rotated
                  : rotation.rotated >= options.suspicious_motion * options.largest_unexplained_motion &&
                        rotation.reflected < options.much_better * rotation.rotated;
  if (!unexplained && !left_handed) return;
  if (left_handed) {
    const std::string proof = fmt::format(
        "the best rotation leaves {:.0f} % of the gyroscope's rotation, the best reflection {:.0f} %",
        100.0 * rotation.rotated, 100.0 * rotation.reflected);
    const auto cause = findWrongAxes(input, true, options, context);
    throw calibrationFailed(
        imu, (cause ? cause->problem : "the gyroscope's axes seem left-handed") + " (" + proof + ")",
        cause ? cause->advice : "Change the sign of one axis, or swap two axes, in the recording software")
        .repairedBy(cause ? cause->repair : std::nullopt);
  }
  if (const std::string limit = rateLimitOf(input.imus[input.reference_imu], options.heavy_saturation_share);
      !limit.empty() && agreement.correlation > options.same_motion_correlation)
    throw calibrationFailed(
        imu,
        limit + fmt::format(": {:.0f} % of its rotation is not visible in the images of {}",
                            100.0 * rotation.rotated, agreement.camera),
        "Move more slowly, or increase the IMU's measuring range");
  throw calibrationFailed(
      imu,
      fmt::format("the IMU's samples seem to be from another recording than the events of {}, or the clock "
                  "offset exceeds "
                  "the search range: for any mounting, {:.0f} % of the gyroscope's rotation is "
                  "not visible in the images (correlation of rates {:.2f})",
                  agreement.camera, 100.0 * rotation.rotated, agreement.correlation),
      "Check that the files belong together, and the clocks");
}

void checkAccelerationsAgree(const CalibrationInput& input, const StatedSigns& stated,
                             std::span<const AlignedCamera> cameras, const GyroRotation& gyro,
                             const GravityAlignment& gravity, const InitialisationOptions& options,
                             const RunContext& context) {
  const ImuData& imu = input.imus[input.reference_imu];
  // Gravity dominates the spread and agrees even if only the motion is wrong: test from a low limit on
  // (chosen, not measured).
  const bool negative = signOfScale(gravity, options) < 0;
  if (!negative && gravity.acceleration_misfit_m_s2 <
                       options.suspicious_motion * options.largest_unexplained_motion * forceSpread_m_s2(imu))
    return;
  const auto cause = findWrongAxes(input, false, options, context);
  if (cause && !cause->negated)
    throw calibrationFailed(imu.name, cause->problem, cause->advice).repairedBy(cause->repair);
  if (!cause && !negative) return;
  if (const auto mirror = findMirror(input, stated, cameras, gyro, true, options, context))
    throw MirrorError(*mirror);
}

}  // namespace evical
