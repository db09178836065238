// Reflection of a camera's image by its driver or by a mirror in front of it, and its reversal. Two
// reflections are a rotation by 180 degrees, which needs no reversal.
#pragma once

#include "core/geometry/resolution.h"

#include <array>
#include <utility>

namespace evical {

enum class Mirroring {
  None,
  X,
  Y,
  Transposed
};  // left and right, up and down, or rows and columns exchanged
// Names in sessions, in the enumeration's order.
inline constexpr std::array kMirroringNames = {"none", "x", "y", "transposed"};

// Size of the image whose mirror image has `size_px`, and the inverse.
constexpr Resolution mirroredSize(Mirroring mirroring, Resolution size_px) {
  if (mirroring == Mirroring::Transposed) std::swap(size_px.width_px, size_px.height_px);
  return size_px;
}

// Coordinates in the image of this size whose mirror image has (x, y), and the inverse. Coordinates outside
// the image stay outside.
template <class Number>
void mirrorPoint(Mirroring mirroring, Resolution size_px, Number& x, Number& y) {
  if (mirroring == Mirroring::X) x = static_cast<Number>(static_cast<Number>(size_px.width_px - 1) - x);
  if (mirroring == Mirroring::Y) y = static_cast<Number>(static_cast<Number>(size_px.height_px - 1) - y);
  if (mirroring == Mirroring::Transposed) std::swap(x, y);
}

}  // namespace evical
