// A frame camera's picture as stored in a recording, and points that another program measured in such
// pictures or elsewhere.
#pragma once

#include "core/geometry/resolution.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace evical {

enum class FrameFormat {
  Gray8,
  Gray16,  // in the file's byte order, see Frame::big_endian
  Rgb8,
  Bgr8,
  Rgba8,
  Bgra8,
  BayerRggb8,
  BayerBggr8,
  BayerGbrg8,
  BayerGrbg8,
  BayerRggb16,  // as Gray16
  BayerBggr16,
  BayerGbrg16,
  BayerGrbg16,
  Encoded  // a JPEG, PNG, PGM, TIFF or BMP file's bytes
};

struct Frame {
  std::int64_t time_ns = 0;  // stamp
  double exposure_s = 0.0;   // 0: unknown
  FrameFormat format = FrameFormat::Gray8;
  bool big_endian = false;
  Resolution size_px;         // unknown for encoded pictures until they are decoded
  std::size_t row_bytes = 0;  // from one row to the next
  std::vector<std::uint8_t> bytes;
};

// One measured point of the board, Board::point_m, in the sensor's pixels.
struct MeasuredPoint {
  std::int64_t time_ns = 0;
  int point = 0;
  float x_px = 0.0F, y_px = 0.0F;
  float sigma_px = 0.0F;  // 0: not specified
};

}  // namespace evical
