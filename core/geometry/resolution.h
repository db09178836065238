// Number of pixels of an image or a sensor.
#pragma once

#include <string>

namespace evical {

struct Resolution {
  int width_px = 0;
  int height_px = 0;
  bool operator==(const Resolution&) const = default;
  bool known() const { return width_px > 0 && height_px > 0; }
  int pixelCount() const { return width_px * height_px; }
};

inline std::string sizeText(Resolution size_px) {
  return std::to_string(size_px.width_px) + " x " + std::to_string(size_px.height_px) + " px";
}

}  // namespace evical
