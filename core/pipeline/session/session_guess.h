// Session derived from recordings: event streams become cameras, IMU streams IMUs.
#pragma once

#include "core/base/error.h"
#include "core/pipeline/session/session.h"
#include "core/recording/inspection.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Board and noise keep their defaults; intrinsics are absent, since recordings do not have them.
Session guessedSession(const std::filesystem::path& recording, const Inspection& inspection);

// Sensor derived from its stream, with a name that is new in the session. `own_recording`: its file, if it is
// not the session's.
SessionCamera guessedCamera(const StreamSummary& stream, const Session& session,
                            const std::filesystem::path& own_recording = {});
// IMU from the stream of one sensor and the recording's matching stream of the other.
SessionImu guessedImu(const StreamSummary& stream, const Inspection& inspection, const Session& session,
                      const std::filesystem::path& own_recording = {});

// Resolution from the extent of the events, if neither the recording nor a lens has it. If a common sensor
// size is almost filled, it is used.
SessionCamera withSeenResolution(SessionCamera camera, const StreamSummary& stream);
// The same for the cameras of a session whose streams are in this file.
Session withSeenResolutions(Session session, const std::filesystem::path& recording,
                            const Inspection& inspection);

// Replaces a missing reference by the first possible one, and removes references to missing cameras in
// same_sensor_as.
void keepReference(Session& session);

// Adds sensors of a further recording: its IMUs if the session has none, its cameras if the session has none.
Session withMissingSensors(const Session& session, const std::filesystem::path& recording,
                           const Inspection& inspection);

// Error if a recording cannot be used for any calibration; otherwise absent.
std::optional<CalibrationError> whyUseless(const std::filesystem::path& recording,
                                           const Inspection& inspection);

struct InspectedRecording {
  std::filesystem::path file;
  Inspection inspection;
};

struct SessionDraft {
  Session session;
  std::string yaml;                // missing entries are comments
  std::vector<std::string> notes;  // steps before it can be calibrated
};

// Draft of a session file with all sensors of all recordings, the first of which is the session's own; paths
// are relative to `folder`. Throws CalibrationError (BadInput) if this does not make a session: an unusable
// recording, no camera, a recording that is given twice.
SessionDraft draftSession(const std::vector<InspectedRecording>& recordings,
                          const std::filesystem::path& folder);

}  // namespace evical
