// Kind and size of a picture from the first bytes of its file, without decoding. A few bytes may claim
// gigabytes, so the size is checked before decoding.
#pragma once

#include "core/geometry/resolution.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace evical {

enum class PictureKind { None, Jpeg, Png, Pnm, Tiff, Bmp };

PictureKind pictureKind(std::string_view bytes);

// Size in the header, limited to a million per side; nullopt for other files, or if the bytes end within it.
std::optional<Resolution> claimedPictureSize(std::string_view bytes);

// Plausible size in the header: unknown if it is 0 or more than 65536 per side.
Resolution pictureSize(std::string_view bytes);

// The parts of a PNG that its pixels need: texts and profiles can claim, or unpack to, gigabytes. Empty if a
// part is cut off.
std::vector<std::uint8_t> pngPixels(std::string_view png);

// Times that a JPEG's pixels are refined; each one takes as long as decoding a picture.
std::size_t jpegScans(std::string_view jpeg);

// A JPEG without its end, which decoders fill with grey.
bool isTruncatedJpeg(std::string_view bytes);

}  // namespace evical
