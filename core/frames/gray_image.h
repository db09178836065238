// A decoded frame for the finders: brightness, one byte per pixel.
#pragma once

#include "core/data/frame.h"

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace evical {

struct GrayImage {
  Resolution size_px;
  std::vector<std::uint8_t> pixels;  // row by row, without gaps
};

// Brightness of a frame in the sensor's own pixels; the display orientation of an encoded picture is ignored.
// Pictures of 16 bits are scaled so that their 99.5th percentile is white: with a camera's 10 or 12 bits in
// such a container, the high byte alone would be nearly black. Throws CalibrationError (BadInput) with
// `place` if a picture is truncated, damaged, too large, or differs from the frame's specified size.
GrayImage decodeFrame(const Frame& frame, const std::string& place);

// Replaces the frame's content by its brightness, so that decodeFrame only copies it. A frame that cannot be
// decoded stays unchanged.
void decodeAhead(Frame& frame);

// Encoding of a frame as a picture file.

// For Gray8 frames. Fast, with moderate compression.
std::string encodedPng(const Frame& frame);

// Lossy; quality 1 to 100.
std::string encodedJpeg(const Frame& frame, int quality);

// Brightness of a picture for the finders.

// True if a square of this half width around the place is inside the picture.
bool isInside(const GrayImage& image, const Eigen::Vector2d& at_px, double half_width_px);

// Interpolated between pixels, at a place inside the picture.
double brightnessAt(const GrayImage& image, const Eigen::Vector2d& at_px);

// Standard deviation of a pixel's noise, at least that of rounding to integers: the median of a second
// difference, which edges hardly affect (J. Immerkaer, "Fast noise variance estimation", CVIU 1996), over
// pixels that are neither black nor white.
double noiseSigma(const GrayImage& image);

}  // namespace evical
