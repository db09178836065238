// Leaving views of the board out of a calibration, after a look at their residuals.
#pragma once

#include "core/pipeline/recording_pass.h"

#include <cstddef>
#include <span>

namespace evical {

// The pass without these views of a camera: indices into pass.cameras[camera].views, in any order, also
// twice. The windows' reports stay, they say what the front end found.
RecordingPass withoutViews(const RecordingPass& pass, std::size_t camera, std::span<const int> views);

}  // namespace evical
