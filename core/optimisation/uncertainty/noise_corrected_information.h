// Information without what only looks like it: in directions that the motion leaves open, noise in the
// trajectory's rates stands where motion should, and would be taken for a measurement.
#pragma once

#include "core/optimisation/uncertainty/projected_information.h"

namespace evical {

// Takes a multiple of the noise's share from the measurements' information and from the scores, direction by
// direction; where that leaves nothing, only priors count. Recordings with motion hardly change.
ProjectedInformation withoutNoise(ProjectedInformation information);

}  // namespace evical
