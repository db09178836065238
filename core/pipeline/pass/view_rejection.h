// Leaving views of the board out of a calibration, after a look at their residuals, and taking them back.
#pragma once

#include "core/pipeline/pass/recording_pass.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace evical {

// The middles of windows that a person rejected, by camera; in time order.
using RejectedTimes = std::vector<std::vector<double>>;

// The pass with these windows rejected, and no others: views that it had left out come back. Windows that were
// rejected and whose views are not known any more stay so. What is rejected is reported as such, so that whatever is
// counted of the pass agrees. Nothing was read for the new pass: its read_s and detect_s are 0.
DetectionResult withRejected(const DetectionResult& pass, const RejectedTimes& rejected_s);

// The pass without these views of a camera, too: indices into pass.cameras[camera].views, in any order, also twice.
DetectionResult withoutViews(const DetectionResult& pass, std::size_t camera, std::span<const int> views);

RejectedTimes rejectedTimes_s(const DetectionResult& pass);
// Of one camera; and the sentence about them, empty where there are none.
std::vector<double> rejectedTimes_s(const BoardObservations& camera);
std::string rejectedSentence(const BoardObservations& camera);

}  // namespace evical
