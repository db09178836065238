// A frame as the finders see it: brightness, one byte a pixel.
#pragma once

#include "core/data/frame.h"

#include <cstdint>
#include <string>
#include <vector>

namespace evical {

struct GrayImage {
  Resolution size_px;
  std::vector<std::uint8_t> pixels;  // row by row, without gaps
};

// Brightness of a frame in the sensor's own pixels; how an encoded picture wants to be turned for show is
// ignored. Pictures of 16 bits are scaled so that their 99.5th percentile is white: of a camera's 10 or 12 bits
// in such a container the high byte alone would be all but black. Throws CalibrationError (BadInput) with
// `place` for a picture that is truncated, damaged, too large, or of another size than the frame says.
GrayImage decodeFrame(const Frame& frame, const std::string& place);

}  // namespace evical
