// Which options a session leaves without effect, and why: so that nobody turns one and waits.
#pragma once

#include "core/data/recording.h"
#include "core/pipeline/session/session.h"

#include <map>
#include <string>

namespace evical {

using StreamTypes = std::map<std::string, StreamType>;  // of a recording's streams, by name

// In words for people; empty where it has an effect, as far as the session and what is known of its streams tell.
std::string whyIdle(const Session& session, const OptionRow& option, const StreamTypes& types = {});

}  // namespace evical
