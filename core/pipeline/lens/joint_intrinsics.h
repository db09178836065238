// Intrinsics that were found first, judged again by what is known once they are
// solved for with everything else.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/intrinsics_result.h"
#include "core/intrinsics/intrinsics_options.h"

namespace evical {

// `first` with the intrinsics of the joint solution, its covariance, and the verdict that follows; what the
// views cover stays as it was. As it is where the report does not hold the camera's intrinsics.
IntrinsicsResult jointIntrinsics(const IntrinsicsResult& first, std::size_t camera,
                                 const CameraIntrinsics& solved, const UncertaintyReport& report,
                                 const IntrinsicsOptions& options);

}  // namespace evical
