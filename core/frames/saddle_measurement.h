// Measures corners in pictures whose pixels differ by what they are, not by noise: counts of flashes, which go by each
// pixel's thresholds.
#pragma once

#include "core/frames/corner_measurement.h"

#include <optional>

namespace evical {

// Where two dark and two bright fields meet crosswise the smoothed brightness has a saddle; whatever the tones are,
// it is at the corner, since half a turn about that changes nothing. Nothing where there is no saddle within `reach_px`
// of the start. `noise_sigma` is a pixel's, of pixels whose noise reaches over `correlated_px`: of an enlarged
// picture as often as it was enlarged.
std::optional<MeasuredCorner> measureSaddle(const GrayImage& image, const Eigen::Vector2d& start_px,
                                            double sigma_px, double reach_px, double noise_sigma,
                                            double correlated_px);

}  // namespace evical
