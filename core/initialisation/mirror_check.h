// Mirrored images. A board that is its own mirror image also has a pose in a mirrored image: that of a camera
// in the mirrored world. Rates agree with it, accelerations and other cameras do not (docs/maths.md, 8.13).
#pragma once

#include "core/base/error.h"
#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/data/mirroring.h"
#include "core/initialisation/initialisation_options.h"
#include "core/initialisation/world_rotation.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace evical {

// Statements of a session about signs; by default there are none.
struct StatedSigns {
  std::vector<std::optional<Mirroring>> mirroring;  // by camera: stated, and reversed on reading
  std::vector<bool>
      inverted_forces;  // by IMU: the recorded accelerations were given another sign or handedness

  bool isReadable(std::size_t camera) const {
    return camera < mirroring.size() && mirroring[camera] == Mirroring::None;
  }
  // Absent for images that are not reversed. Unlike the statement that text is readable, it may be a guess.
  std::optional<Mirroring> reversal(std::size_t camera) const {
    return camera < mirroring.size() && !isReadable(camera) ? mirroring[camera] : std::nullopt;
  }
  bool invertsForces(std::size_t imu) const { return imu < inverted_forces.size() && inverted_forces[imu]; }
};

// An error whose cause is a mirrored image or negated accelerations, and not another input.
struct MirrorError : CalibrationError {
  explicit MirrorError(const CalibrationError& error) : CalibrationError(error) {}
};

// The error of accelerations that have the opposite sign of what cameras see: a mirrored image, negated
// accelerations, or one of both, if nothing distinguishes them; with a repair only if nothing else explains
// the data. `gyro` without its bias; `negated`: those of the world's board together show the opposite sign.
// Empty if no camera shows it.
std::optional<CalibrationError> findMirror(const CalibrationInput& input, const StatedSigns& stated,
                                           std::span<const AlignedCamera> cameras, const GyroRotation& gyro,
                                           bool negated, const InitialisationOptions& options,
                                           const RunContext& context);

// True if `camera` sees the board that `first` sees as if from behind: the image of one of them is mirrored.
// `gyro`: rotation of the rig, known between views that are `max_gap_s` apart. False if it rotates about one
// axis only, which leaves the angles about it free, or if the cameras see the board too far apart in time.
bool contradictsHandedness(const AlignedCamera& first, const AlignedCamera& camera, const GyroRotation& gyro,
                           double max_gap_s, const InitialisationOptions& options);

// The error of such a contradiction, without accelerations.
CalibrationError mirroredOfTwo(const CalibrationInput& input, const StatedSigns& stated,
                               const AlignedCamera& first, const AlignedCamera& camera);

// Throws CalibrationFailed if a given rotation contradicts the gyroscope as if the image were mirrored.
void checkGivenRotation(const CalibrationInput& input, const StatedSigns& stated, const AlignedCamera& camera,
                        const GyroRotation& gyro, const InitialisationOptions& options);

// Doubt about a state whose accelerations agree: the session inverts them, or it reverses an image that their
// sign does not confirm (`forces_confirm`), and nothing else shows that images are not mirrored; or a prior
// shows that they are. May be empty.
std::string mirrorDoubt(const CalibrationInput& input, const StatedSigns& stated,
                        std::span<const AlignedCamera> cameras, const CalibrationState& state,
                        bool forces_confirm);

// True if the specific forces of two IMUs, after this rotation, have opposite signs.
bool forcesOppose(const ImuData& reference, const ImuData& imu, const Eigen::Quaterniond& reference_from_imu,
                  double time_offset_s);

}  // namespace evical
