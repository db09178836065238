// What the first bytes of a picture's file tell without decoding it: of which kind it is, and how large it says it
// is. A few bytes may claim gigabytes, so that is asked before it is decoded.
#pragma once

#include "core/geometry/resolution.h"

#include <optional>
#include <string_view>

namespace evical {

enum class PictureKind { None, Jpeg, Png, Pnm, Tiff, Bmp };

PictureKind pictureKind(std::string_view bytes);

// What the header claims, held down to a million a side; nothing of other files, or if the bytes end within it.
std::optional<Resolution> claimedPictureSize(std::string_view bytes);

// The same of pictures that there can be: unknown if it is 0 or more than 65536 a side.
Resolution pictureSize(std::string_view bytes);

// A JPEG without its end, which decoders fill with grey.
bool isTruncatedJpeg(std::string_view bytes);

}  // namespace evical
