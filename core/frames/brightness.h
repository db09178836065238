// Brightness of a picture for the finders.
#pragma once

#include "core/frames/gray_image.h"

#include <Eigen/Core>

namespace evical {

// True if a square of this half width around the place is inside the picture.
bool isInside(const GrayImage& image, const Eigen::Vector2d& at_px, double half_width_px);

// Interpolated between pixels, at a place inside the picture.
double brightnessAt(const GrayImage& image, const Eigen::Vector2d& at_px);

// Standard deviation of a pixel's noise, at least that of rounding to integers: the median of a second
// difference, which edges hardly affect (J. Immerkaer, "Fast noise variance estimation", CVIU 1996), over
// pixels that are neither black nor white.
double noiseSigma(const GrayImage& image);

}  // namespace evical
