// The session that recordings suggest: their event streams as cameras, their IMUs as IMUs.
#pragma once

#include "core/base/error.h"
#include "core/pipeline/session/session.h"
#include "core/recording/inspection.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace evical {

// Board and noise keep their defaults; intrinsics are missing: no recording has them.
Session guessedSession(const std::filesystem::path& recording, const Inspection& inspection);

// A sensor as guessed from its stream, with a name that the session has not given yet. `own_recording`: its
// file, where it is not the session's.
SessionCamera guessedCamera(const StreamSummary& stream, const Session& session,
                            const std::filesystem::path& own_recording = {});
// From the stream of one sensor and the recording's matching stream of the other.
SessionImu guessedImu(const StreamSummary& stream, const Inspection& inspection, const Session& session,
                      const std::filesystem::path& own_recording = {});

// Where neither the recording nor a lens says how large the sensor is: as large as its events reach, or the usual sensor
// that they all but fill.
SessionCamera withSeenResolution(SessionCamera camera, const StreamSummary& stream);
// The same for the cameras of a session whose streams are in this file.
Session withSeenResolutions(Session session, const std::filesystem::path& recording,
                            const Inspection& inspection);

// Where the reference is no longer there, the first that could be it; cameras whose sensor's is gone have their own.
void keepReference(Session& session);

// With the sensors of a further recording that the session lacks: its IMUs where there is none yet, its
// cameras where there is none.
Session withMissingSensors(const Session& session, const std::filesystem::path& recording,
                           const Inspection& inspection);

// Why nothing can be calibrated from a recording, whatever is filled in; nothing where something can.
std::optional<CalibrationError> whyUseless(const std::filesystem::path& recording,
                                           const Inspection& inspection);

struct InspectedRecording {
  std::filesystem::path file;
  Inspection inspection;
};

struct SessionDraft {
  Session session;
  std::string yaml;                // with what is missing as comments
  std::vector<std::string> notes;  // what to do before it can be calibrated
};

// A session file to be filled in, with all sensors of all recordings, the first of which is the session's
// own; paths relative to `folder`. Throws CalibrationError (BadInput) where they do not make a session: a
// recording of no use, no camera at all, a recording that is given twice.
SessionDraft draftSession(const std::vector<InspectedRecording>& recordings,
                          const std::filesystem::path& folder);

}  // namespace evical
