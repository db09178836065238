#include "core/frames/png_file.h"

#include "core/base/error.h"

#include <opencv2/imgcodecs.hpp>

#include <cstdint>
#include <vector>

namespace evical {

std::string encodedPng(const Frame& frame) {
  const cv::Mat picture(frame.size_px.height_px, frame.size_px.width_px, CV_8UC1,
                        const_cast<std::uint8_t*>(frame.bytes.data()), frame.row_bytes);  // only read
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1}))
    throw calibrationFailed("frame", "cannot be written as PNG", "Check that OpenCV can write PNG files");
  return {bytes.begin(), bytes.end()};
}

}  // namespace evical
