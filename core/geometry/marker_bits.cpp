#include "core/geometry/marker_bits.h"

#include "core/base/error.h"

#include <fmt/format.h>
#include <opencv2/aruco.hpp>

#include <algorithm>
#include <array>

namespace evical {
namespace {

PatternBits bitsOf(const cv::aruco::Dictionary& dictionary, int id) {
  const int size = dictionary.markerSize;
  cv::Mat picture;
#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR < 407
  dictionary.drawMarker(id, size + 2, picture);
#else
  cv::aruco::generateImageMarker(dictionary, id, size + 2, picture);
#endif
  PatternBits bits;
  for (int y = 0; y < size; ++y) {
    bits.emplace_back();
    for (int x = 0; x < size; ++x) bits.back().push_back(picture.at<std::uint8_t>(y + 1, x + 1) > 127);
  }
  return bits;
}

// The largest set of a family: smaller sets are its first markers.
cv::Ptr<cv::aruco::Dictionary> dictionaryOf(const std::string& name) {
  constexpr std::array kSets = {cv::aruco::DICT_4X4_1000, cv::aruco::DICT_5X5_1000, cv::aruco::DICT_6X6_1000,
                                cv::aruco::DICT_7X7_1000, cv::aruco::DICT_ARUCO_ORIGINAL};
  const std::vector<std::string>& names = markerNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    throw badInput("markers", "'" + name + "' is not a marker dictionary",
                   "Use 4x4, 5x5, 6x6, 7x7 or original");
  // OpenCV 4.7 and later return it by value.
  return cv::makePtr<cv::aruco::Dictionary>(
      cv::aruco::getPredefinedDictionary(kSets.at(static_cast<std::size_t>(found - names.begin()))));
}

}  // namespace

const std::vector<std::string>& markerNames() {
  static const std::vector<std::string> names = {"4x4", "5x5", "6x6", "7x7", "original"};
  return names;
}

std::vector<PatternBits> firstMarkers(const std::string& dictionary, int count) {
  const cv::Ptr<cv::aruco::Dictionary> all = dictionaryOf(dictionary);
  if (count > all->bytesList.rows)
    throw badInput("board",
                   fmt::format("needs {} markers, but the dictionary has {}", count, all->bytesList.rows),
                   "Use fewer rows or columns");
  std::vector<PatternBits> markers;
  for (int id = 0; id < count; ++id) markers.push_back(bitsOf(*all, id));
  return markers;
}

}  // namespace evical
