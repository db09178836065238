// Pixels as OpenCV sees them. Only for this folder.
#pragma once

#include "core/frames/gray_image.h"

#include <opencv2/core.hpp>

namespace evical {

// OpenCV has no type for pixels that it must not write to: nothing may write to these, which stay where they are.
inline const cv::Mat viewOf(const Resolution& size_px, int type, const std::vector<std::uint8_t>& bytes,
                            std::size_t row_bytes = cv::Mat::AUTO_STEP) {
  return {size_px.height_px, size_px.width_px, type, const_cast<std::uint8_t*>(bytes.data()), row_bytes};
}

inline const cv::Mat viewOf(const GrayImage& image) {
  return viewOf(image.size_px, CV_8UC1, image.pixels);
}

}  // namespace evical
