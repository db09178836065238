#include "core/frontend/rgb_image.h"

#include "core/base/error.h"

#include <png.h>

namespace evical {

void writePng(const std::filesystem::path& path, const RgbImage& image) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width_px);
  png.height = static_cast<png_uint_32>(image.height_px);
  png.format = PNG_FORMAT_RGB;
  if (!png_image_write_to_file(&png, path.c_str(), 0, image.rgb.data(), 0, nullptr)) {
    throw badInput(path.string(), std::string("image cannot be written: ") + png.message,
                   "Choose an existing, writable folder with free disk space");
  }
}

}  // namespace evical
