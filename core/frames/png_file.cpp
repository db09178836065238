#include "core/frames/png_file.h"

#include "core/base/error.h"
#include "core/frames/picture_view.h"

#include <opencv2/imgcodecs.hpp>

#include <cstdint>
#include <vector>

namespace evical {

std::string encodedPng(const Frame& frame) {
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", viewOf(frame.size_px, CV_8UC1, frame.bytes, frame.row_bytes), bytes,
                    {cv::IMWRITE_PNG_COMPRESSION, 1}))
    throw calibrationFailed("frame", "cannot be written as PNG", "Check that OpenCV can write PNG files");
  return {bytes.begin(), bytes.end()};
}

}  // namespace evical
