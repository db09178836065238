#include "core/frames/picture_file.h"

#include "core/base/error.h"
#include "core/frames/picture_view.h"

#include <opencv2/imgcodecs.hpp>

#include <cstdint>
#include <vector>

namespace evical {
namespace {

std::string encoded(const Frame& frame, const char* suffix, const std::vector<int>& options) {
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(suffix, viewOf(frame.size_px, CV_8UC1, frame.bytes, frame.row_bytes), bytes, options))
    throw calibrationFailed("frame", std::string("cannot be written as ") + suffix,
                            "Check that OpenCV supports this format");
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::string encodedPng(const Frame& frame) {
  return encoded(frame, ".png", {cv::IMWRITE_PNG_COMPRESSION, 1});
}

std::string encodedJpeg(const Frame& frame, int quality) {
  return encoded(frame, ".jpg", {cv::IMWRITE_JPEG_QUALITY, quality});
}

}  // namespace evical
