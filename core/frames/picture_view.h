// Pixels as OpenCV matrices without a copy. Internal to this folder.
#pragma once

#include "core/frames/gray_image.h"

#include <opencv2/core.hpp>

namespace evical {

// OpenCV does not have a type for read-only pixels: do not write to this matrix, whose pixels are not copied.
inline const cv::Mat viewOf(const Resolution& size_px, int type, const std::vector<std::uint8_t>& bytes,
                            std::size_t row_bytes = cv::Mat::AUTO_STEP) {
  return {size_px.height_px, size_px.width_px, type, const_cast<std::uint8_t*>(bytes.data()), row_bytes};
}

inline const cv::Mat viewOf(const GrayImage& image) {
  return viewOf(image.size_px, CV_8UC1, image.pixels);
}

}  // namespace evical
