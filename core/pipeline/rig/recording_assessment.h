// Whether a recording is good enough, said before it is calibrated: how long it is, how much of it shows the board, where
// in the image, how it was moved, and how sure a calibration of it would be. Each with a light and what to do better.
#pragma once

#include "core/base/progress.h"
#include "core/pipeline/rig/detected_recording.h"
#include "core/pipeline/session/session.h"

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
  Lens,      // that was found first, as none is given
  Turns,
  Accelerations,
  Rotation,  // that a calibration would find, and so on: by their sigmas
  Translation,
  TimeOffset,
  Obstacle,  // that ends a calibration, or makes its result doubtful
};

struct Assessed {
  AssessedThing thing = AssessedThing::Duration;
  std::string sensor;  // whose; empty: the recording's
  Light light = Light::Good;
  std::string measured;  // "12.0 s"
  std::string advice;    // a sentence; empty where there is nothing to mend
};

// Of the worst axis, at the end of a calibration.
struct ExpectedSigmas {
  std::string sensor;
  double rotation_deg = 0.0, translation_mm = 0.0, time_offset_ms = 0.0;
};

struct RecordingAssessment {
  std::vector<Assessed> all;
  std::vector<ExpectedSigmas> sigmas;  // empty where there is no way to a calibration
  Light light = Light::Good;           // of the recording as a whole
  bool board_seen = false;
  bool can_be_calibrated = false;  // nothing ended the way to it
};

// Sigmas are those of a batch that ends as soon as it has come near: a fraction of a calibration's time, and the same
// information. Never fails for what is wrong with the recording: that is what it says. Throws Cancelled when asked
// to stop.
RecordingAssessment assessRecording(const Session& session, const DetectedRecording& detected,
                                    const RunContext& context);

struct CheckedRecording {
  RecordingAssessment assessment;
  // What a calibration may start from; absent where a lens that is not given could not be found.
  std::optional<DetectedRecording> detected;
};

// From the recording. Throws CalibrationError where it cannot be read as the session says, and Cancelled.
CheckedRecording checkRecording(const Session& session, const RunContext& context);

// In plain words: "rotation", "board in view".
const char* nameOf(AssessedThing thing);

}  // namespace evical
