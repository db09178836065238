// Measurement of corners in pictures with systematic differences between pixels: counts of flashes, which
// depend on each pixel's thresholds.
#pragma once

#include "core/frames/corner_measurement.h"

#include <optional>

namespace evical {

// The smoothed brightness has a saddle where two dark and two bright fields meet. It is at the corner for any
// tones, since a half turn about the corner leaves the pattern unchanged. Empty if there is no saddle within
// `reach_px` of the start. `noise_sigma` is a pixel's noise, correlated over `correlated_px`, which is the
// enlargement factor of an enlarged picture.
std::optional<MeasuredCorner> measureSaddle(const GrayImage& image, const Eigen::Vector2d& start_px,
                                            double sigma_px, double reach_px, double noise_sigma,
                                            double correlated_px);

}  // namespace evical
