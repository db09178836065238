// A frame as the bytes of a PNG file.
#pragma once

#include "core/data/frame.h"

#include <string>

namespace evical {

// Of Gray8 frames. Compressed quickly rather than well.
std::string encodedPng(const Frame& frame);

}  // namespace evical
