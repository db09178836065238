// Starting points of the alignment: offsets at which camera and gyroscope rotate equally fast, each with the
// best rotation. Internal to this folder.
#pragma once

#include "core/egomotion/alignment_fit.h"

#include <vector>

namespace evical {

// `start` first, then the others in order of correlation.
std::vector<AlignmentState> alignmentStarts(const std::vector<const WindowMotion*>& windows,
                                            const AlignmentFit& fit, const SummedRates& rates,
                                            const AlignmentState& start, double search_s);

}  // namespace evical
