// The residuals of a result's circles as a table, with all digits.
#pragma once

#include "core/base/text_sink.h"
#include "core/report/result_yaml.h"

#include <span>

namespace evical {

// One line for each circle: measured position as in the detections, residual of the prediction after all corrections,
// sigmas, and whether the estimate uses it. `view` counts the camera's windows with the board in the detections.
void residualsCsv(const NamedResult& named, std::span<const CircleResidual> residuals, const TextSink& sink);

}  // namespace evical
