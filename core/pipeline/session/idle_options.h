// Which options a session leaves without effect, and why: so that nobody turns one and waits.
#pragma once

#include "core/pipeline/session/session.h"

#include <string>

namespace evical {

// Of an option by its full name, in words for people; empty where it has one, as far as the session tells.
std::string whyIdle(const Session& session, const std::string& option);

}  // namespace evical
