// Intrinsics that were calibrated first, judged again after their refinement in the joint optimisation.
#pragma once

#include "core/data/calibration_result.h"
#include "core/data/intrinsics_result.h"
#include "core/intrinsics/intrinsics_options.h"

namespace evical {

// `first` with the intrinsics, covariance and verdict of the joint solution; the coverage stays. Unchanged if
// the report does not contain the camera's intrinsics.
IntrinsicsResult jointIntrinsics(const IntrinsicsResult& first, std::size_t camera,
                                 const CameraIntrinsics& solved, const UncertaintyReport& report,
                                 const IntrinsicsOptions& options);

}  // namespace evical
