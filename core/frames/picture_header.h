// How large an encoded picture says it is: read before it is decoded, since a few bytes may claim gigabytes.
#pragma once

#include "core/geometry/resolution.h"

#include <cstdint>
#include <optional>
#include <span>

namespace evical {

enum class PictureKind { Jpeg, Png, Pnm, Tiff, Bmp };

struct PictureHeader {
  PictureKind kind = PictureKind::Jpeg;
  Resolution size_px;      // what it claims, held down to a million a side
  bool truncated = false;  // where that can be told from its bytes: JPEG, which decoders fill with grey
};

// Nothing if the bytes begin like none of these, or end within the header.
std::optional<PictureHeader> readPictureHeader(std::span<const std::uint8_t> bytes);

}  // namespace evical
