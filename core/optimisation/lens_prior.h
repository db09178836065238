// What is known of a free lens before the batch.
#pragma once

#include "core/data/camera_lens.h"

namespace evical {

struct OptimisationOptions;

// Of all nine intrinsics around those that the lens was seen with: as wide as is said of a given lens, else weak.
IntrinsicsMatrix lensPriorCovariance(const CameraLens& lens, const OptimisationOptions& options);

}  // namespace evical
