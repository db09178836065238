// A frame as the bytes of a picture's file.
#pragma once

#include "core/data/frame.h"

#include <string>

namespace evical {

// Of Gray8 frames. Compressed quickly rather than well.
std::string encodedPng(const Frame& frame);

// With loss; quality 1 to 100.
std::string encodedJpeg(const Frame& frame, int quality);

}  // namespace evical
