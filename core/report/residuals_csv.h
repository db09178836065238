// The residuals of a result's circles as a table, with all digits.
#pragma once

#include "core/base/text_sink.h"
#include "core/report/result_yaml.h"

#include <span>

namespace evical {

// One line for each circle: measured position, residual of the prediction, sigmas, and whether the estimate
// uses it.
void residualsCsv(const NamedResult& named, std::span<const CircleResidual> residuals, const TextSink& sink);

}  // namespace evical
