// Assessment of a recording before it is calibrated: duration, visibility of the board, coverage of the
// image, motion, and expected sigmas. Each has a light and advice.
#pragma once

#include "core/pipeline/rig/detected_recording.h"

#include "core/base/progress.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/pipeline/session/session.h"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {

enum class Light { Good, Fair, Poor };

enum class AssessedThing {
  Duration,
  Board,     // share of the windows or frames that show it
  Coverage,  // of the image
  Speed,     // of the circles in it
  Lens,      // calibrated first, since none is given
  Turns,
  Accelerations,
  Rotation,  // expected sigma; the same for the next two
  Translation,
  TimeOffset,
  Obstacle,  // prevents a calibration, or makes its result doubtful
};

// Range of a good median speed of the circles, for event cameras.
inline constexpr double kGoodSpeed_px_s = 40.0, kFastSpeed_px_s = 600.0;

struct Assessed {
  AssessedThing thing = AssessedThing::Duration;
  std::string sensor;  // empty: the whole recording
  Light light = Light::Good;
  std::string measured;  // "12.0 s"
  std::string required;  // for a Good light: "15 s"; empty for an Obstacle
  std::string advice;    // a sentence; empty if the light is Good
};

// Expected sigmas of the worst axis after a calibration.
struct ExpectedSigmas {
  std::string sensor;
  double rotation_deg = 0.0, translation_mm = 0.0, time_offset_ms = 0.0;
};

struct RecordingAssessment {
  std::vector<Assessed> all;
  std::vector<ExpectedSigmas> sigmas;  // empty if a calibration is not possible
  Light light = Light::Good;           // of the recording as a whole
  bool board_seen = false;
  bool can_be_calibrated = false;  // no error in the stages before it
};

// Sigmas come from a batch that stops close to the solution: a fraction of a calibration's time, with the
// same information. Faults of the recording are reported, not thrown. Throws Cancelled when asked to stop.
RecordingAssessment assessRecording(const Session& session, const DetectedRecording& detected,
                                    const RunContext& context);

struct CheckedRecording {
  RecordingAssessment assessment;
  // Start of a calibration; absent if a lens that is not given could not be calibrated.
  std::optional<DetectedRecording> detected;
};

// Reads and assesses the recording. Throws CalibrationError if it does not match the session, and Cancelled.
CheckedRecording checkRecording(const Session& session, const RunContext& context);

// Displayed name: "rotation", "board in view".
const char* nameOf(AssessedThing thing);

// Motion of a recording per axis (rotation and acceleration), which makes the calibration observable.
struct AssessedMotion {
  Eigen::Vector3d turn_rad_s = Eigen::Vector3d::Zero();         // RMS about the mean, per axis
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();  // the same, without gravity if that is known
  bool along_camera = false;                                    // else along the IMU's axes
};

// `state`: initial state; the axes are then those of its first camera. Null: no state, axes of the IMU.
AssessedMotion assessMotion(const ImuData& reference_imu, std::int64_t start_ns,
                            const CalibrationState* state);

}  // namespace evical
