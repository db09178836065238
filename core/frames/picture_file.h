// Encoding of a frame as a picture file.
#pragma once

#include "core/data/frame.h"

#include <string>

namespace evical {

// For Gray8 frames. Fast, with moderate compression.
std::string encodedPng(const Frame& frame);

// Lossy; quality 1 to 100.
std::string encodedJpeg(const Frame& frame, int quality);

}  // namespace evical
