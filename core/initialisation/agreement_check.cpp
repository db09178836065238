#include "core/initialisation/agreement_check.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/data/imu_units.h"
#include "core/data/stamp_batches.h"
#include "core/data/unfit_samples.h"
#include "core/initialisation/camera_alignment.h"
#include "core/initialisation/gravity_alignment.h"
#include "core/initialisation/gyro_rotation.h"
#include "core/initialisation/initialise.h"
#include "core/initialisation/knot_spacing.h"
#include "core/initialisation/world_rotation.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>
#include <Eigen/LU>

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
std::string rateLimitOf(const ImuData& imu, double min_share) {
  const std::array<double, kImuAxes.size()> shares = saturatedShares(imu.samples);
  std::size_t worst = 0;
  for (std::size_t axis = 0; axis < kImuAxes.size(); ++axis)
    if (kImuAxes[axis].rate && shares[axis] > shares[worst]) worst = axis;
  if (shares[worst] < min_share) return {};
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
  const bool unexplained = rotation.rotated >= options.max_unexplained_motion;
  const bool left_handed =
      unexplained ? rotation.reflected < options.far_better * rotation.rotated
                  : rotation.rotated >= options.suspicious_motion * options.max_unexplained_motion &&
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
                       options.suspicious_motion * options.max_unexplained_motion * forceSpread_m_s2(imu))
    return;
  const auto cause = findWrongAxes(input, false, options, context);
  if (cause && !cause->negated)
    throw calibrationFailed(imu.name, cause->problem, cause->advice).repairedBy(cause->repair);
  if (!cause && !negative) return;
  if (const auto mirror = findMirror(input, stated, cameras, gyro, true, options, context))
    throw MirrorError(*mirror);
}

namespace {

// The 48 signed permutations; the first is the identity.
std::vector<Eigen::Matrix3d> readings() {
  std::vector<Eigen::Matrix3d> all;
  std::array<int, 3> axes = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
      for (int row = 0; row < 3; ++row)
        matrix(row, axes[static_cast<std::size_t>(row)]) = (signs >> row & 1) != 0 ? -1.0 : 1.0;
      all.push_back(matrix);
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return all;
}

AxesReading axesOf(const Eigen::Matrix3d& reading) {
  AxesReading axes = {};
  for (int row = 0; row < 3; ++row) {
    Eigen::Index axis = 0;
    reading.row(row).cwiseAbs().maxCoeff(&axis);
    axes[static_cast<std::size_t>(row)] = static_cast<int>(axis + 1) * (reading(row, axis) < 0.0 ? -1 : 1);
  }
  return axes;
}

// "(y,x,-z)"
std::string axesWords(const Eigen::Matrix3d& reading) {
  return "(" + axesText(axesOf(reading)) + ")";
}

class AxesTrial {
 public:
  AxesTrial(CalibrationInput input, const InitialisationOptions& options, const RunContext& context)
      : input_(std::move(input)), options_(options), context_{silentProgress(), context.stop} {
    const GyroRotation gyro(imu().samples, input_.start_ns);
    Initialisation unused;
    const AlignedCamera camera =
        alignCamera(input_.cameras.front(), input_, gyro, options_, context_, unused);
    const double offset_s = camera.hand_eye.time_offset_s;
    const GyroRotation unbiased(imu().samples, input_.start_ns, camera.hand_eye.gyroscope_bias_rad_s);
    const double begin_s = std::max(camera.poses.front().time_s + offset_s, gyro.begin_s());
    const double end_s = std::min(camera.poses.back().time_s + offset_s, gyro.end_s());
    rotation_ = fitWorldRotation({&camera, 1}, unbiased, begin_s, end_s,
                                 options_.knot_spacing_s > 0.0 ? options_.knot_spacing_s : kUsualKnot_s);
    tracks_ = {{camera.poses, offset_s}};
  }

  // Misfit of the accelerations with these axes of the accelerometer.
  double misfit_m_s2(const Eigen::Matrix3d& reading) const {
    std::vector<ImuSample> samples = imu().samples;
    for (ImuSample& sample : samples) sample.specific_force_m_s2 = reading * sample.specific_force_m_s2;
    return accelerationMisfit_m_s2(tracks_, samples, input_.start_ns, rotation_, options_, context_);
  }

 private:
  const ImuData& imu() const { return input_.imus[input_.reference_imu]; }

  CalibrationInput input_;
  const InitialisationOptions& options_;
  RunContext context_;
  So3Spline rotation_;
  std::vector<CameraTrack> tracks_;
};

// Rates were negated for the trial if the gyroscope is left-handed. The frame is the accelerometer's, so if
// the two do not match, the gyroscope's axes are changed. Axes are those of the recorded samples, which
// the session may already have rotated.
AxesCause causeOf(const Eigen::Matrix3d& reading, bool left_handed_gyroscope, const std::string& imu,
                  const std::string& proof) {
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  const bool as_is = reading.isApprox(identity), negated = reading.isApprox(-identity);
  // A reflected axis also reverses the direction of rates.
  const Eigen::Matrix3d gyroscope =
      (left_handed_gyroscope ? -1.0 : 1.0) * reading.determinant() * reading.transpose();
  const auto readGyroscopeAs = [&](const Eigen::Matrix3d& as) {
    return Repair{"imus." + imu + ".gyroscope_axes", axesText(axesOf(as))};
  };
  const auto setGyroscope = [&](const Eigen::Matrix3d& as, const char* otherwise) {
    return fmt::format("Set gyroscope_axes: {} for this IMU, or {}", axesText(axesOf(as)), otherwise);
  };
  if (left_handed_gyroscope && as_is)
    return {"the angular rates seem negated: " + proof,
            setGyroscope(-identity, "change the sign of all three axes in the recording software"), false,
            readGyroscopeAs(-identity)};
  if (left_handed_gyroscope && negated)
    return {
        "the IMU's axes seem left-handed (one axis mirrored, or two swapped) in both gyroscope and "
        "accelerometer, or the angular rates negated and the camera's image mirrored: " +
            proof,
        "Check that writing is readable in the camera's picture. If so, change the sign of one axis, or swap "
        "two axes, of both sensors in the recording software. If not, turn the mirroring off, and change the "
        "sign of the angular rates"};
  if (negated) return {"the accelerations seem negated: " + proof, "", true};
  if (reading.determinant() < 0.0)  // no reading of the gyroscope alone repairs it
    return {fmt::format(
                "the accelerometer's axes seem left-handed, mirrored or swapped{}, or permuted and the "
                "camera's image mirrored: if read as {}, {}",
                left_handed_gyroscope ? ", and the angular rates negated" : "", axesWords(reading), proof),
            "Check that writing is readable in the camera's picture. If so, record accelerations in the "
            "gyroscope's frame, or set accelerometer_axes. If not, turn the mirroring off first"};
  if (left_handed_gyroscope)
    return {fmt::format("the gyroscope's axes seem left-handed, mirrored or swapped: if read as {}, {}",
                        axesWords(gyroscope), proof),
            setGyroscope(gyroscope, "record them in the accelerometer's frame"), false,
            readGyroscopeAs(gyroscope)};
  return {fmt::format("the axes of accelerometer and gyroscope seem permuted relative to each other: if the "
                      "gyroscope's are read as {}, {}",
                      axesWords(gyroscope), proof),
          setGyroscope(gyroscope, "record both sensors in one frame"), false, readGyroscopeAs(gyroscope)};
}

}  // namespace

std::optional<AxesCause> findWrongAxes(const CalibrationInput& input, bool left_handed_gyroscope,
                                       const InitialisationOptions& options, const RunContext& context) {
  CalibrationInput tried = input;
  if (left_handed_gyroscope)
    for (ImuSample& sample : tried.imus[tried.reference_imu].samples) sample.angular_rate_rad_s *= -1.0;
  try {
    const AxesTrial trial(std::move(tried), options, context);
    const std::vector<Eigen::Matrix3d> all = readings();
    const double as_is_m_s2 = trial.misfit_m_s2(all.front());
    double min_m_s2 = as_is_m_s2;
    Eigen::Matrix3d best = all.front();
    for (const Eigen::Matrix3d& reading : all) {
      const double misfit_m_s2 = trial.misfit_m_s2(reading);
      if (misfit_m_s2 >= min_m_s2 * (best.isIdentity() ? options.far_better : 1.0)) continue;
      min_m_s2 = misfit_m_s2;
      best = reading;
    }
    if (best.isIdentity() && !left_handed_gyroscope) return std::nullopt;
    const std::string proof =
        best.isIdentity()
            ? fmt::format("after this change, accelerations agree to {:.2g} m/s^2", min_m_s2)
            : fmt::format("accelerations agree to {:.2g} m/s^2 instead of {:.2g}", min_m_s2, as_is_m_s2);
    return causeOf(best, left_handed_gyroscope, input.imus[input.reference_imu].name, proof);
  } catch (const CalibrationError&) {
    return std::nullopt;  // fails for another reason, independent of the axes
  }
}

}  // namespace evical
