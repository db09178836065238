// What the first bytes of a picture's file tell without decoding it.
#pragma once

#include "core/geometry/resolution.h"

#include <string_view>

namespace evical {

enum class PictureKind { None, Jpeg, Png, Pnm, Tiff, Bmp };

PictureKind pictureKind(std::string_view bytes);

// From the header of a JPEG, PNG, PNM or BMP file, of which `bytes` are the first; unknown if they do not tell.
Resolution pictureSize(std::string_view bytes);

}  // namespace evical
