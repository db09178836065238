// Options that have no effect in a session, with the reason.
#pragma once

#include "core/data/recording.h"
#include "core/pipeline/session/session.h"

#include <map>
#include <string>

namespace evical {

using StreamTypes = std::map<std::string, StreamType>;  // of a recording's streams, by name

// Reason why the option has no effect; empty if it has one, as far as the session and its known streams show.
std::string whyIdle(const Session& session, const OptionRow& option, const StreamTypes& types = {});

}  // namespace evical
