#include "core/geometry/marker_bits.h"

#include "core/base/error.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <fmt/format.h>
#include <opencv2/aruco.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

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

PatternBits turned(PatternBits bits, int quarter_turns) {
  for (int turn = 0; turn < quarter_turns; ++turn) {
    const PatternBits before = bits;
    for (std::size_t y = 0; y < bits.size(); ++y)
      for (std::size_t x = 0; x < bits.size(); ++x) bits[y][x] = before[bits.size() - 1 - x][y];
  }
  return bits;
}

const std::vector<std::string>& markerNames() {
  static const std::vector<std::string> names = {"4x4", "5x5", "6x6", "7x7", "original"};
  return names;
}

int markerCount(const std::string& dictionary) {
  return dictionaryOf(dictionary)->bytesList.rows;
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

std::vector<BoardSquare> charucoMarkers(const Board& board, bool first_is_bright) {
  std::vector<BoardSquare> markers;
  for (int row = 0; row < board.rows; ++row)
    for (int col = 0; col < board.cols; ++col)
      if (((row + col) % 2 == 0) == first_is_bright) markers.push_back({row, col});
  return markers;
}

Eigen::Vector2d squareCorner_m(const Board& board, const BoardSquare& square) {
  return board.spacing_m * Eigen::Vector2d(square.col - 1, square.row - 1);
}

std::vector<PatternBits> firstTags(int count) {
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(),
                                                                                tag36h11_destroy);
  const PatternBits dark(kTagSide_bits, std::vector<bool>(kTagSide_bits));
  std::vector<PatternBits> tags(
      static_cast<std::size_t>(std::clamp(count, 0, static_cast<int>(family->ncodes))), dark);
  for (std::size_t id = 0; id < tags.size(); ++id)
    for (std::uint32_t bit = 0; bit < family->nbits; ++bit)  // coordinates include the border of 1 bit
      tags[id][family->bit_y[bit] - 1][family->bit_x[bit] - 1] =
          (family->codes[id] >> (family->nbits - 1 - bit) & 1) != 0;
  return tags;
}

}  // namespace evical
