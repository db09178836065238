// OpenCV's markers under the same names for all versions: OpenCV 4.7 renamed them and returns dictionaries by
// value.
#pragma once

#include <opencv2/aruco.hpp>
#include <opencv2/core/version.hpp>
#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR < 407
#include <opencv2/aruco/charuco.hpp>
#endif

namespace evical::test::aruco {

#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407
inline cv::Ptr<cv::aruco::Dictionary> dictionary(int set) {
  return cv::makePtr<cv::aruco::Dictionary>(cv::aruco::getPredefinedDictionary(set));
}
inline void drawMarker(const cv::aruco::Dictionary& dictionary, int id, int side_px, cv::Mat& picture) {
  cv::aruco::generateImageMarker(dictionary, id, side_px, picture);
}
// Drawn like in OpenCV up to 4.6.
inline void drawCharucoBoard(const cv::Ptr<cv::aruco::Dictionary>& dictionary, const cv::Size& squares,
                             float square_m, float marker_m, const cv::Size& size_px, cv::Mat& picture) {
  cv::aruco::CharucoBoard board(squares, square_m, marker_m, *dictionary);
  board.setLegacyPattern(true);
  board.generateImage(size_px, picture, 0);
}
#else
inline cv::Ptr<cv::aruco::Dictionary> dictionary(int set) {
  return cv::aruco::getPredefinedDictionary(set);
}
inline void drawMarker(const cv::aruco::Dictionary& dictionary, int id, int side_px, cv::Mat& picture) {
  dictionary.drawMarker(id, side_px, picture);
}
inline void drawCharucoBoard(const cv::Ptr<cv::aruco::Dictionary>& dictionary, const cv::Size& squares,
                             float square_m, float marker_m, const cv::Size& size_px, cv::Mat& picture) {
  cv::aruco::CharucoBoard::create(squares.width, squares.height, square_m, marker_m, dictionary)
      ->draw(size_px, picture, 0);
}
#endif

}  // namespace evical::test::aruco
