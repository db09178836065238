// The residuals of a result's circles as a table, with all digits.
#pragma once

#include "core/base/text_sink.h"
#include "core/report/result_yaml.h"

#include <span>

namespace evical {

// One line a circle: where it was measured, by how much the prediction lies beside it, how sure it was, and whether
// the estimate rests on it.
void residualsCsv(const NamedResult& named, std::span<const CircleResidual> residuals, const TextSink& sink);

}  // namespace evical
