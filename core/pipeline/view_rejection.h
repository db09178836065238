// Leaving views of the board out of a calibration, after a look at their residuals.
#pragma once

#include "core/pipeline/recording_pass.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace evical {

// The pass without these views of a camera: indices into pass.cameras[camera].views, in any order, also
// twice. Their windows are reported as rejected by hand, so that whatever is counted of the pass agrees. Nothing was
// read for the new pass: its read_s and detect_s are 0.
RecordingPass withoutViews(const RecordingPass& pass, std::size_t camera, std::span<const int> views);

// The middles of a camera's windows that a person rejected; and the sentence about them, empty where there are none.
std::vector<double> rejectedTimes_s(const BoardObservations& camera);
std::string rejectedSentence(const BoardObservations& camera);

}  // namespace evical
