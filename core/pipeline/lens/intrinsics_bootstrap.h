// A first look at a recording whose camera is not known. Without intrinsics, strong distortion hides most of
// a board from the front end: it fits all circles together, as a plane. So short slices of the recording are
// looked at through a few plain lenses until what is seen makes a camera; through that one more is seen,
// which makes a better camera.
#pragma once

#include "core/base/progress.h"
#include "core/pipeline/session/session.h"

#include <optional>

namespace evical {

// Of the session's first camera. Reads no further than it must; where the slices make no camera, the lens
// that showed most, and none if that was none.
std::optional<CameraIntrinsics> lookThroughPlainLenses(const Session& session, const RunContext& context);

}  // namespace evical
