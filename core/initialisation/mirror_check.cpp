#include "core/initialisation/mirror_check.h"

#include "core/base/how_to.h"
#include "core/base/time.h"
#include "core/data/mirroring.h"
#include "core/data/unfit_samples.h"
#include "core/geometry/so3.h"
#include "core/initialisation/additional_imus.h"
#include "core/initialisation/gravity_alignment.h"
#include "core/initialisation/knot_spacing.h"
#include "core/numerics/angles.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace evical {
namespace {

using std::numbers::pi;

constexpr double kHalfwayToHalfTurn_rad = 0.75 * pi;  // from a quarter turn, which no mirroring causes

// Axis of a half turn that a mirrored image adds to a camera's rotation, in the image: x for X, y for Y, a
// diagonal for transposed images. Absent if the rotation is not such a half turn.
std::optional<Eigen::Vector3d> halfTurnInImage(const Eigen::Quaterniond& rotation) {
  constexpr double kSteep = 0.5;  // sine of 30 deg
  const Eigen::AngleAxisd turn(rotation);
  const double angle_rad = std::min(turn.angle(), 2.0 * pi - turn.angle());
  if (angle_rad < kHalfwayToHalfTurn_rad || std::abs(turn.axis().z()) > kSteep) return std::nullopt;
  return turn.axis();
}

// The mirroring that adds this half turn; absent for the other diagonal.
std::optional<Mirroring> mirroringOf(const Eigen::Vector3d& axis) {
  const double angle_rad = std::atan2(axis.y(), axis.x());  // of a line: modulo pi
  const auto near = [&](double line_rad) {
    return std::abs(std::sin(angle_rad - line_rad)) < std::sin(pi / 8.0);
  };
  if (near(0.0)) return Mirroring::X;
  if (near(pi / 2.0)) return Mirroring::Y;
  return near(-pi / 4.0) ? std::optional(Mirroring::Transposed) : std::nullopt;
}

// " in x", or an empty text.
std::string directionWords(const std::optional<Mirroring>& how) {
  if (!how) return "";
  return *how == Mirroring::Transposed
             ? " (rows and columns exchanged)"
             : std::string(" in ") + kMirroringNames[static_cast<std::size_t>(*how)];
}

// Evidence for or against a mirrored image of a camera, from anything except motion.
struct ImageEvidence {
  bool mirrored;
  std::string reason;  // "its tags are readable"
  std::optional<Mirroring> how = {};
};

std::optional<ImageEvidence> evidenceOfMount(const CalibrationInput& input, const AlignedCamera& aligned) {
  const std::optional<KnownRotation>& mount = input.cameras[aligned.camera].prior.rotation;
  if (!mount || input.imus.empty())
    return std::nullopt;  // between cameras it shows only that one is mirrored
  constexpr double kNear_rad = 0.25 * pi, kSigmas = 3.0;
  if (mount->sigma && kSigmas * mount->sigma->maxCoeff() > kNear_rad) return std::nullopt;
  const Eigen::Quaterniond turn = mount->value.conjugate() * aligned.hand_eye.reference_from_sensor;
  if (rotationAngleBetween_rad(turn, Eigen::Quaterniond::Identity()) < kNear_rad)
    return ImageEvidence{false, "its rotation agrees with the prior"};
  if (const auto axis = halfTurnInImage(turn))
    return ImageEvidence{true,
                         "its rotation differs from the prior by half a turn about an axis of the image",
                         mirroringOf(*axis)};
  return std::nullopt;
}

// A stated reversal is not evidence: it makes the images of a camera mirrored that is not.
std::optional<ImageEvidence> evidenceOf(const CalibrationInput& input, const StatedSigns& stated,
                                        const AlignedCamera& aligned) {
  if (input.boardOf(aligned.camera).hasTags() &&
      input.cameras[aligned.camera].observations.kind != CameraKind::Points)
    return ImageEvidence{false, "its tags are readable"};
  if (std::optional<ImageEvidence> mount = evidenceOfMount(input, aligned)) return mount;
  if (stated.isReadable(aligned.camera)) return ImageEvidence{false, "the session states mirrored: none"};
  return std::nullopt;
}

// A camera, and the sign of the board's scale according to accelerations: 0 if it is not clear.
struct SignedCamera {
  const AlignedCamera* camera;
  int sign = 1;
  std::optional<ImageEvidence> evidence = {};
};

int signOf(const CalibrationInput& input, const AlignedCamera& camera, const GyroRotation& gyro,
           const InitialisationOptions& options, const RunContext& context) {
  const ImuData& imu = input.imus[input.reference_imu];
  const double offset_s = camera.hand_eye.time_offset_s;
  const double begin_s = std::max(camera.poses.front().time_s + offset_s, gyro.begin_s());
  const double end_s = std::min(camera.poses.back().time_s + offset_s, gyro.end_s());
  const So3Spline rotation =
      fitWorldRotation({&camera, 1}, gyro, begin_s, end_s,
                       options.knot_spacing_s > 0.0 ? options.knot_spacing_s : kUsualKnot_s);
  const CameraTrack track{camera.poses, offset_s};
  const GravityAlignment gravity = alignGravity({&track, 1}, withFitForces(imu.samples), input.start_ns,
                                                rotation, options, {silentProgress(), context.stop});
  if (const int sign = signOfScale(gravity, options); sign != 0) return sign;
  std::vector<ImuSample> samples = withFitForces(imu.samples);
  const auto misfit = [&] {
    return accelerationMisfit_m_s2({&track, 1}, samples, input.start_ns, rotation, options, context);
  };
  const double as_is_m_s2 = misfit();
  for (ImuSample& sample : samples) sample.specific_force_m_s2 *= -1.0;
  const double negated_m_s2 = misfit();
  if (negated_m_s2 < options.far_better * as_is_m_s2) return -1;
  return as_is_m_s2 < options.far_better * negated_m_s2 ? 1 : 0;
}

// Evidence that accelerations are negated, or that they are not: then images are mirrored.
struct SignEvidence {
  bool negated;
  std::string reason;
};

std::optional<SignEvidence> signFromCameras(const CalibrationInput& input,
                                            std::span<const SignedCamera> cameras) {
  for (const SignedCamera& each : cameras)
    if (each.evidence && each.sign != 0)
      return SignEvidence{
          (each.sign < 0) != each.evidence->mirrored,
          fmt::format("the image of {} is {}mirrored, since {}", input.cameras[each.camera->camera].name,
                      each.evidence->mirrored ? "" : "not ", each.evidence->reason)};
  // One driver may mirror two cameras, but hardly those of two kinds.
  for (const SignedCamera& one : cameras)
    for (const SignedCamera& other : cameras) {
      const CameraData &a = input.cameras[one.camera->camera], &b = input.cameras[other.camera->camera];
      if (one.sign == 0 || one.sign != other.sign || a.observations.kind == b.observations.kind ||
          input.sensorOf(one.camera->camera) == input.sensorOf(other.camera->camera))
        continue;
      return SignEvidence{one.sign < 0,
                          fmt::format("the images of {} and {} agree with each other", a.name, b.name)};
    }
  return std::nullopt;
}

// A further IMU whose recorded accelerations agree with the cameras.
std::optional<SignEvidence> signFromImus(const CalibrationInput& input, const StatedSigns& stated,
                                         const GyroRotation& gyro, int sign,
                                         const InitialisationOptions& options, const RunContext& context) {
  for (std::size_t k = 0; k < input.imus.size(); ++k) {
    if (k == input.reference_imu || stated.invertsForces(k)) continue;
    try {
      const RelativeRotation found =
          alignFurtherGyroscope(input.imus[k], input.start_ns, gyro, options, context).hand_eye;
      const bool opposes = forcesOppose(input.imus[input.reference_imu], input.imus[k],
                                        found.reference_from_sensor, found.time_offset_s);
      if (opposes == (sign < 0))
        return SignEvidence{sign < 0,
                            fmt::format("the accelerations of {} agree with the camera", input.imus[k].name)};
    } catch (const CalibrationError&) {
      continue;  // an IMU that does not fit is reported later
    }
  }
  return std::nullopt;
}

const char* const kReverse =
    "Turn the mirroring off in the driver, or state it as mirrored: x, y or transposed for this camera";

CalibrationError negatedAccelerations(const std::string& imu, const std::string& reason) {
  return calibrationFailed(imu, "the accelerations are negated: " + reason,
                           "Change their sign (at rest, an accelerometer measures +g upwards), or set "
                           "acceleration_unit: -g "
                           "for values in g")
      .repairedBy(Repair{"imus." + imu + ".accelerometer_axes", "-x,-y,-z"});
}

// The mirroring of a camera relative to another one of the same chip.
std::optional<Mirroring> mirroringOnChip(const CalibrationInput& input, const AlignedCamera& camera,
                                         const AlignedCamera& other) {
  if (camera.camera == other.camera || input.sensorOf(camera.camera) != input.sensorOf(other.camera))
    return std::nullopt;
  const auto axis = halfTurnInImage(other.hand_eye.reference_from_sensor.conjugate() *
                                    camera.hand_eye.reference_from_sensor);
  return axis ? mirroringOf(*axis) : std::nullopt;
}

// "mirrored: x"
std::string keyWords(Mirroring reversal) {
  return std::string("mirrored: ") + kMirroringNames[static_cast<std::size_t>(reversal)];
}

// Which mirroring it is only a mount or another camera on the chip shows; any other leads to another camera
// frame.
CalibrationError mirroredImage(const CalibrationInput& input, const StatedSigns& stated,
                               const AlignedCamera& camera, const std::optional<Mirroring>& how,
                               const std::string& reason) {
  const std::string& name = input.cameras[camera.camera].name;
  const std::string key = "cameras." + name + ".mirrored";
  if (const auto reversal = stated.reversal(camera.camera))
    return calibrationFailed(name,
                             fmt::format("{} is wrong: the image is mirrored after this reversal: {}",
                                         keyWords(*reversal), reason),
                             "Remove the key mirrored of this camera, or set it to none")
        .repairedBy(Repair{key, kMirroringNames.front()});
  std::optional<Repair> repair;
  if (how) repair = Repair{key, kMirroringNames[static_cast<std::size_t>(*how)]};
  return calibrationFailed(name, fmt::format("the image is mirrored{}: {}", directionWords(how), reason),
                           kReverse)
      .repairedBy(repair);
}

std::string namesOf(const CalibrationInput& input, std::span<const std::size_t> cameras) {
  std::string names;
  for (const std::size_t each : cameras) names += (names.empty() ? "" : ", ") + input.cameras[each].name;
  return names;
}

// "mirrored: x is wrong for left", "the images of left, right are mirrored"
std::string wrongImages(const CalibrationInput& input, const StatedSigns& stated,
                        std::span<const std::size_t> cameras) {
  std::string keys;
  std::vector<std::size_t> unstated;
  for (const std::size_t each : cameras) {
    if (const auto reversal = stated.reversal(each))
      keys += fmt::format("{}{} is wrong for {}", keys.empty() ? "" : " and ", keyWords(*reversal),
                          input.cameras[each].name);
    else
      unstated.push_back(each);
  }
  if (unstated.empty()) return keys;
  return fmt::format("{}{}the image{} of {} {} mirrored", keys, keys.empty() ? "" : " and ",
                     unstated.size() > 1 ? "s" : "", namesOf(input, unstated),
                     unstated.size() > 1 ? "are" : "is");
}

std::vector<std::size_t> withSign(std::span<const SignedCamera> cameras, int sign) {
  std::vector<std::size_t> found;
  for (const SignedCamera& each : cameras)
    if (each.sign == sign) found.push_back(each.camera->camera);
  return found;
}

// If nothing distinguishes a mirrored image from negated accelerations. A stated reversal comes first.
CalibrationError eitherOfBoth(const CalibrationInput& input, const StatedSigns& stated,
                              std::span<const SignedCamera> cameras) {
  const std::vector<std::size_t> negative = withSign(cameras, -1), positive = withSign(cameras, 1);
  const auto reversed =
      std::ranges::find_if(negative, [&](std::size_t each) { return stated.reversal(each).has_value(); });
  const bool is_stated = reversed != negative.end();
  const std::string& imu = input.imus[input.reference_imu].name;
  const std::string images = wrongImages(input, stated, negative);
  constexpr const char* kBoth = "both give the same data";
  const std::string problem =
      !positive.empty() ? fmt::format("either {}, or {}, and the session wrongly inverts the accelerations",
                                      images, wrongImages(input, stated, positive))
      : is_stated       ? fmt::format("{}, or the accelerations of {} are negated: {}", images, imu, kBoth)
                        : fmt::format("the accelerations seem negated, or {}: {}", images, kBoth);
  const char* const readable =
      "change the sign of the accelerations (at rest, an accelerometer measures +g "
      "upwards)";
  const std::string picture =
      "Hold printed text in front of the camera and look at its picture " + howTo(HowTo::LookAtDetections);
  return calibrationFailed(
      is_stated ? input.cameras[*reversed].name : imu, problem,
      is_stated ? fmt::format("{}, which shows the reversed image. If the text is mirrored, remove the key "
                              "mirrored. If it is readable, {}",
                              picture, readable)
                : fmt::format("{}. If the text is mirrored, turn this off in the driver, or set mirrored: x, "
                              "y or transposed for the camera. If it is readable, set mirrored: none for the "
                              "camera, and {}",
                              picture, readable));
}

// True if a further IMU's accelerations, which the session does not invert, agree with the reference's.
bool anotherImuConfirms(const CalibrationInput& input, const StatedSigns& stated,
                        const CalibrationState& state) {
  for (std::size_t k = 0; k < input.imus.size(); ++k)
    if (k != input.reference_imu && !stated.invertsForces(k) &&
        !forcesOppose(input.imus[input.reference_imu], input.imus[k],
                      state.imus[k].reference_from_imu.rotation, state.imus[k].time_offset_s))
      return true;
  return false;
}

}  // namespace

bool forcesOppose(const ImuData& reference, const ImuData& imu, const Eigen::Quaterniond& reference_from_imu,
                  double time_offset_s) {
  const std::vector<ImuSample> ours = withFitForces(reference.samples), theirs = withFitForces(imu.samples);
  const std::int64_t offset_ns = nanosecondsFrom(time_offset_s);
  double sum = 0.0;
  std::size_t k = 0;
  for (const ImuSample& sample : theirs) {
    while (k + 1 < ours.size() && ours[k].time_ns < sample.time_ns + offset_ns) ++k;
    if (k < ours.size())
      sum += ours[k].specific_force_m_s2.dot(reference_from_imu * sample.specific_force_m_s2);
  }
  return sum < 0.0;
}

std::optional<CalibrationError> findMirror(const CalibrationInput& input, const StatedSigns& stated,
                                           std::span<const AlignedCamera> cameras, const GyroRotation& gyro,
                                           bool negated, const InitialisationOptions& options,
                                           const RunContext& context) {
  std::vector<SignedCamera> all;
  for (const AlignedCamera& camera : cameras) {
    const int sign = signOf(input, camera, gyro, options, context);
    const bool known = sign == 0 && negated && input.cameras[camera.camera].board == 0;
    all.push_back({&camera, known ? -1 : sign, evidenceOf(input, stated, camera)});
  }
  const auto mirrored = std::ranges::find(all, -1, &SignedCamera::sign);
  if (mirrored == all.end()) return std::nullopt;
  const auto right = std::ranges::find(all, 1, &SignedCamera::sign);
  std::optional<SignEvidence> evidence = signFromCameras(input, all);
  if (!evidence) evidence = signFromImus(input, stated, gyro, -1, options, context);
  if (!evidence && right != all.end() && !stated.invertsForces(input.reference_imu))
    evidence = SignEvidence{false, fmt::format("accelerations contradict it, but agree with {}",
                                               input.cameras[right->camera->camera].name)};
  if (!evidence) return eitherOfBoth(input, stated, all);
  if (evidence->negated) return negatedAccelerations(input.imus[input.reference_imu].name, evidence->reason);
  std::optional<Mirroring> how = mirrored->evidence ? mirrored->evidence->how : std::optional<Mirroring>();
  for (const SignedCamera& other : all)
    if (!how && other.sign > 0) how = mirroringOnChip(input, *mirrored->camera, *other.camera);
  return mirroredImage(input, stated, *mirrored->camera, how,
                       mirrored->evidence ? mirrored->evidence->reason : evidence->reason);
}

bool contradictsHandedness(const AlignedCamera& first, const AlignedCamera& camera, const GyroRotation& gyro,
                           double max_gap_s, const InitialisationOptions& options) {
  if (std::min(first.hand_eye.axis_ratio, camera.hand_eye.axis_ratio) < options.min_axis_ratio) return false;
  const auto worldFromFirst = [&](const AlignedCamera& aligned, const CameraPose& pose) {
    return pose.world_from_camera.rotation * aligned.hand_eye.reference_from_sensor.conjugate() *
           gyro.at(pose.time_s + aligned.hand_eye.time_offset_s).conjugate();
  };
  const double shift_s = camera.hand_eye.time_offset_s - first.hand_eye.time_offset_s;
  std::size_t k = 0, turned = 0, compared = 0;
  for (const CameraPose& pose : camera.poses) {
    while (k + 1 < first.poses.size() && first.poses[k].time_s < pose.time_s + shift_s) ++k;
    if (std::abs(first.poses[k].time_s - pose.time_s - shift_s) > max_gap_s) continue;
    ++compared;
    turned += rotationAngleBetween_rad(worldFromFirst(first, first.poses[k]), worldFromFirst(camera, pose)) >
              kHalfwayToHalfTurn_rad;
  }
  // Cameras that see the board in turns have only few views near each other's, next to gaps of the rotation.
  const bool enough = static_cast<int>(compared) >= options.min_views && 2 * compared > camera.poses.size();
  return enough && 2 * turned > compared;
}

CalibrationError mirroredOfTwo(const CalibrationInput& input, const StatedSigns& stated,
                               const AlignedCamera& first, const AlignedCamera& camera) {
  const auto of_first = evidenceOf(input, stated, first), of_camera = evidenceOf(input, stated, camera);
  const auto cause = [&](const AlignedCamera& mirrored, const AlignedCamera& right,
                         const std::optional<ImageEvidence>& of_mirrored,
                         const std::optional<ImageEvidence>& of_right) {
    std::optional<Mirroring> how = of_mirrored ? of_mirrored->how : std::optional<Mirroring>();
    if (!how) how = mirroringOnChip(input, mirrored, right);
    const std::string& name = input.cameras[right.camera].name;
    return mirroredImage(
        input, stated, mirrored, how,
        fmt::format("it shows the board as if seen from behind, compared with {}, and {}", name,
                    of_mirrored
                        ? of_mirrored->reason
                        : fmt::format("the image of {} is not mirrored, since {}", name, of_right->reason)));
  };
  if ((of_camera && of_camera->mirrored) || (of_first && !of_first->mirrored && !of_camera))
    return cause(camera, first, of_camera, of_first);
  if ((of_first && of_first->mirrored) || (of_camera && !of_camera->mirrored && !of_first))
    return cause(first, camera, of_first, of_camera);
  const bool first_is_reversed = stated.reversal(first.camera).has_value();
  const bool is_reversed = first_is_reversed || stated.reversal(camera.camera).has_value();
  const std::array pair =
      first_is_reversed ? std::array{first.camera, camera.camera} : std::array{camera.camera, first.camera};
  return calibrationFailed(
      input.cameras[pair[0]].name,
      fmt::format("either {}, or {}: one shows the board as if seen from behind",
                  wrongImages(input, stated, {pair.data(), 1}), wrongImages(input, stated, {&pair[1], 1})),
      fmt::format("Hold printed text in front of both and look at their pictures {}. {} for the camera whose "
                  "text is not readable",
                  howTo(HowTo::LookAtDetections),
                  is_reversed ? "These show reversed images. Remove or correct mirrored"
                              : "Turn the mirroring off in the driver, or set mirrored: x, y or transposed"));
}

void checkGivenRotation(const CalibrationInput& input, const StatedSigns& stated, const AlignedCamera& camera,
                        const GyroRotation& gyro, const InitialisationOptions& options) {
  const CameraData& data = input.cameras[camera.camera];
  if (!isGiven(data.prior.rotation)) return;
  SensorPrior free = data.prior;
  free.rotation.reset();
  const auto found =
      estimateCameraImuRotation(camera.poses, gyro, camera.hand_eye.time_offset_s, options, free);
  if (!found) return;
  const Eigen::Quaterniond turn = data.prior.rotation->value.conjugate() * found->reference_from_sensor;
  const auto axis = halfTurnInImage(turn);
  if (!axis) return;
  const auto reversal = stated.reversal(camera.camera);
  throw MirrorError(calibrationFailed(
      data.name,
      fmt::format("{}, or the given rotation is wrong: it differs by {:.0f} deg from that of the images",
                  reversal ? keyWords(*reversal) + " is wrong"
                           : "the image seems mirrored" + directionWords(mirroringOf(*axis)),
                  kDegPerRad * rotationAngleBetween_rad(turn, Eigen::Quaterniond::Identity())),
      fmt::format("Check whether writing is readable in the camera's picture. {}. Otherwise correct "
                  "prior.cameras.{}.rotation",
                  reversal ? "If so, remove the key mirrored" : std::string("If not: ") + kReverse,
                  data.name)));
}

std::string mirrorDoubt(const CalibrationInput& input, const StatedSigns& stated,
                        std::span<const AlignedCamera> cameras, const CalibrationState& state,
                        bool forces_confirm) {
  std::vector<SignedCamera> all;
  for (const AlignedCamera& camera : cameras) all.push_back({&camera, 1, evidenceOf(input, stated, camera)});
  for (const SignedCamera& each : all)
    if (each.evidence && each.evidence->mirrored)
      return fmt::format("the image of {} seems mirrored{}, and the accelerations negated: {}",
                         input.cameras[each.camera->camera].name, directionWords(each.evidence->how),
                         each.evidence->reason);
  if (signFromCameras(input, all)) return {};
  const std::vector<std::size_t> seeing = withSign(all, 1);
  const auto reversed =
      std::ranges::find_if(seeing, [&](std::size_t each) { return stated.reversal(each).has_value(); });
  const bool inverts = stated.invertsForces(input.reference_imu) && !anotherImuConfirms(input, stated, state);
  if (!inverts && (forces_confirm || reversed == seeing.end())) return {};
  if (reversed == seeing.end())
    return fmt::format(
        "{}: the session inverts the accelerations, and nothing shows that the image of {} is not mirrored: "
        "with recorded accelerations and a mirrored image the data are the same, but the rotation differs by "
        "180 deg; hold printed text in front of the camera: if it is readable in the picture, set mirrored: "
        "none for the camera, otherwise mirrored: x, y or transposed, without inverting the accelerations",
        input.imus[input.reference_imu].name, namesOf(input, seeing));
  return fmt::format(
      "{}: {} may be wrong: {}, and nothing else shows how the image is mirrored; if it is not, the rotation "
      "is wrong by 180 deg; hold printed text in front of the camera: if it is readable in the picture of "
      "the driver, remove the key mirrored{}; otherwise turn the mirroring off in the driver, or confirm the "
      "mount by prior.cameras.{}.rotation",
      input.cameras[*reversed].name, keyWords(*stated.reversal(*reversed)),
      inverts ? "the session also inverts the accelerations" : "the accelerations do not confirm it",
      inverts ? ", and do not invert the accelerations" : "", input.cameras[*reversed].name);
}

}  // namespace evical
