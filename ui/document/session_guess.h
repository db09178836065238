// SPDX-License-Identifier: GPL-3.0-or-later
// The session that a recording suggests: its event streams as cameras, its IMUs as IMUs.
#pragma once

#include "core/pipeline/session.h"
#include "core/recording/inspection.h"

namespace evical::ui {

// Board and noise keep their defaults; intrinsics are missing: no recording has them.
Session guessedSession(const std::filesystem::path& recording, const Inspection& inspection);

// A sensor as guessed from its stream, with a name that the session has not given yet. `own_recording`: its
// file, where it is not the session's.
SessionCamera guessedCamera(const StreamSummary& stream, const Session& session,
                            const std::filesystem::path& own_recording = {});
SessionImu guessedImu(const StreamSummary& stream, const Session& session,
                      const std::filesystem::path& own_recording = {});

// Where the reference is no longer there, the first that could be it.
void keepReference(Session& session);

// With the sensors of a further recording that the session lacks: its IMUs where there is none yet, its
// cameras where there is none.
Session withMissingSensors(const Session& session, const std::filesystem::path& recording,
                           const Inspection& inspection);

}  // namespace evical::ui
