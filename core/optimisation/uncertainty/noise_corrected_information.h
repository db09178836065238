// Noise-corrected information: in directions without motion, noise in the trajectory's rates looks like
// motion and would count as a measurement.
#pragma once

#include "core/optimisation/uncertainty/projected_information.h"

namespace evical {

// Subtracts a multiple of the noise's contribution from the measurements' information and from the scores,
// direction by direction. If nothing remains, only priors count. Recordings with motion hardly change.
ProjectedInformation withoutNoise(ProjectedInformation information);

}  // namespace evical
