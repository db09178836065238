// Prior on a free lens.
#pragma once

#include "core/data/camera_lens.h"

namespace evical {

struct OptimisationOptions;

// All nine intrinsics around the detection intrinsics, with the sigmas given for the lens, otherwise weak.
IntrinsicsMatrix lensPriorCovariance(const CameraLens& lens, const OptimisationOptions& options);

}  // namespace evical
