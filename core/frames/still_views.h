// How far a board has moved between two pictures, and views of a board that stands still made one.
#pragma once

#include "core/frames/views_from_frames.h"

#include <optional>
#include <vector>

namespace evical {

// RMS over the board's points; nothing where the two have too few in common. What noise makes of single points does not
// count: only motion that bends the board no more than a change of its pose does.
std::optional<double> movement_px(const FoundPoints& from, const FoundPoints& to);

// The later view with the numbers that the earlier gives to the points at their places: a board that looks the same
// turned, or of which a part is seen, may be counted otherwise each time. Points that have moved by more are left out.
FoundPoints numberedAs(const FoundPoints& earlier, const FoundPoints& later, double nearest_px);

// Views one after the other in which the board moves by less than `still_px` become their mean. Their noise averages
// out, `common_sigma_px` does not.
std::vector<PointsInFrame> joinedWhileStill(const std::vector<PointsInFrame>& views, double still_px,
                                            double common_sigma_px);

}  // namespace evical
