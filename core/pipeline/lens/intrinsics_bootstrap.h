// Initial intrinsics of an unknown camera. The front end fits all circles together, as a plane. Without
// intrinsics, strong distortion hides most of a board from it. Short slices of the recording are therefore
// searched with a few generic lenses until the views suffice for a camera model. With this model more is
// visible, which improves the model.
#pragma once

#include "core/base/progress.h"
#include "core/pipeline/session/session.h"

#include <optional>

namespace evical {

// Initial intrinsics of the session's first camera. Reads only as much as needed. If the slices do not give a
// camera model: the generic lens that showed most, or none if no lens showed the board.
std::optional<CameraIntrinsics> bootstrapIntrinsics(const Session& session, const RunContext& context);

}  // namespace evical
