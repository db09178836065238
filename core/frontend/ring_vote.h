// Circle candidates by signed votes: a burst at the leading edge votes along the line from the circle's
// centre, one at the trailing edge in the opposite direction. Over a moving circle's ring the votes add up to
// a vector along the motion; over texture they cancel. Needs neither flow nor a complete outline
// (docs/maths.md, 5.1).
#pragma once

#include "core/frontend/burst_window.h"
#include "core/frontend/circle_candidate.h"
#include "core/frontend/detection_options.h"

#include <vector>

namespace evical {

// Best candidates first; the largest radius is limited by the image.
std::vector<CircleCandidate> voteForCircles(const BurstWindow& window, const FrontEndOptions& all);

}  // namespace evical
