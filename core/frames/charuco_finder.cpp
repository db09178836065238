#include "core/frames/board_finder.h"
#include "core/frames/corner_measurement.h"
#include "core/frames/picture_view.h"
#include "core/frames/plane_map.h"
#include "core/geometry/marker_bits.h"
#include "core/geometry/tag_layout.h"

#include <fmt/format.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>

namespace evical {
namespace {

constexpr std::array kFamilies = {MarkerFamily::Of4x4, MarkerFamily::Of5x5, MarkerFamily::Of6x6,
                                  MarkerFamily::Of7x7, MarkerFamily::Original};

const char* nameOf(MarkerFamily family) {
  constexpr std::array kNames = {"any", "4x4", "5x5", "6x6", "7x7", "original"};
  return kNames.at(static_cast<std::size_t>(family));
}

// OpenCV 4.7 and later return it by value.
cv::Ptr<cv::aruco::Dictionary> predefined(int set) {
  return cv::makePtr<cv::aruco::Dictionary>(cv::aruco::getPredefinedDictionary(set));
}

// The first markers of a family: smaller sets are the beginnings of larger ones, and the smallest sufficient
// set has the fewest false detections.
cv::Ptr<cv::aruco::Dictionary> dictionaryOf(MarkerFamily family, int markers) {
  if (family == MarkerFamily::Original) return predefined(cv::aruco::DICT_ARUCO_ORIGINAL);
  constexpr int kSetsOfFamily = 4;
  constexpr std::array<int, kSetsOfFamily> kSizes = {50, 100, 250, 1000};
  int set = 0;
  while (set + 1 < kSetsOfFamily && kSizes.at(static_cast<std::size_t>(set)) < markers) ++set;
  const int first = (static_cast<int>(family) - static_cast<int>(MarkerFamily::Of4x4)) * kSetsOfFamily;
  return predefined(cv::aruco::DICT_4X4_50 + first + set);
}

// Their corners from the top left, clockwise.
std::vector<SeenTag> readMarkers(const cv::Mat& picture, MarkerFamily family, int markers) {
  std::vector<std::vector<cv::Point2f>> corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(picture, dictionaryOf(family, markers), corners, ids);
  std::vector<SeenTag> seen;
  for (std::size_t k = 0; k < ids.size(); ++k) {
    if (ids[k] >= markers) continue;
    SeenTag& marker = seen.emplace_back();
    marker.id = ids[k];
    for (std::size_t c = 0; c < 4; ++c) marker.corners_px.at(c) = {corners[k][c].x, corners[k][c].y};
  }
  return seen;
}

// A hypothesis for reading a picture: the dictionary, which squares are dark, and how the markers are rotated
// within the bright ones.
struct Reading {
  MarkerFamily family = MarkerFamily::Automatic;
  bool first_is_bright = false;
  int quarter_turns = 0;  // clockwise
  std::vector<ReadPoint> points;
};

class CharucoFinder : public PatternFinder {
 public:
  CharucoFinder(const Board& board, const FrameOptions& options)
      : board_(board), options_(options), family_(options.markers) {}

  FoundPoints search(const GrayImage& image) override {
    const Reading reading = bestReading(viewOf(image));
    constexpr std::size_t kFewestPoints = 8;  // of two markers
    if (reading.points.size() < kFewestPoints) {
      lookInMirror(image);
      return {};
    }
    if (!settled_ && reading.points.size() >= 2 * kFewestPoints) {
      settled_ = true;
      family_ = reading.family;
      quarter_turns_ = reading.quarter_turns;
    }
    first_is_bright_ = reading.first_is_bright;
    const std::optional<PlaneMap> map = mapOf(reading.points, board_.spacing_m);
    if (!map) return {};
    const FoundPoints found = measure(image, *map, 2.0 * options_.max_move_px);
    const std::optional<PlaneMap> nearer = mapOf(found, board_);
    return nearer ? measure(image, *nearer, options_.max_move_px) : FoundPoints{};
  }

  FoundPoints measure(const GrayImage& image, const PlaneMap& map, double gate_px) const override {
    return measureCorners(image, board_, charucoCorners(board_, first_is_bright_), map, gate_px, options_);
  }

  std::string doubt() const override {
    constexpr int kEnoughPictures = 3;
    if (!settled_ && mirrored_ >= kEnoughPictures)
      return "the markers can only be read in the mirror image: the camera's pictures or the printed board "
             "are mirrored";
    if (settled_ || best_family_ == MarkerFamily::Automatic) return {};
    return fmt::format("the detected markers of {} bits do not fit a board of {} x {} squares",
                       nameOf(best_family_), board_.rows, board_.cols);
  }

  std::string remark() const override { return markerRemark(kTagCornerCount - quarter_turns_); }

 private:
  Reading bestReading(const cv::Mat& picture) {
    Reading best;
    for (const MarkerFamily family : kFamilies) {
      if (family_ != MarkerFamily::Automatic && family != family_) continue;
      const std::vector<SeenTag> seen = readMarkers(picture, family, board_.rows * board_.cols / 2);
      constexpr std::size_t kSome = 4;
      if (seen.size() >= kSome) best_family_ = family;
      for (const bool first_is_bright : {false, true}) {
        // Only boards with an even number of rows were ever drawn both ways.
        if (first_is_bright && board_.rows % 2 != 0) continue;
        for (int turns = 0; turns < kTagCornerCount; ++turns) {
          if (settled_ && turns != quarter_turns_) continue;
          Reading reading{family, first_is_bright, turns, agreeing(seen, first_is_bright, turns)};
          if (reading.points.size() > best.points.size()) best = std::move(reading);
        }
      }
    }
    return best;
  }

  // A mirrored marker is not one of its dictionary, apart from single mistakes.
  void lookInMirror(const GrayImage& image) {
    constexpr int kMaxLooks = 20;
    constexpr std::size_t kSome = 16;  // points of four markers
    if (settled_ || mirror_looks_++ >= kMaxLooks) return;
    cv::Mat mirrored;
    cv::flip(viewOf(image), mirrored, 1);
    const MarkerFamily best_family = best_family_;
    mirrored_ += bestReading(mirrored).points.size() >= kSome ? 1 : 0;
    best_family_ = best_family;
  }

  std::vector<ReadPoint> agreeing(const std::vector<SeenTag>& seen, bool first_is_bright, int turns) const {
    const std::vector<BoardSquare> squares = charucoMarkers(board_, first_is_bright);
    const double margin = 0.5 * (board_.spacing_m - board_.tag_size_m), size = board_.tag_size_m;
    const TagCorners corners = {Eigen::Vector2d{0, 0}, {size, 0}, {size, size}, {0, size}};
    std::vector<SeenTag> markers;
    std::vector<TagCorners> places;
    for (const SeenTag& marker : seen) {
      if (marker.id >= static_cast<int>(squares.size())) continue;
      const Eigen::Vector2d first = squareCorner_m(board_, squares[static_cast<std::size_t>(marker.id)]) +
                                    Eigen::Vector2d::Constant(margin);
      TagCorners place = rotatedCorners(corners, turns);
      for (Eigen::Vector2d& corner : place) corner += first;
      markers.push_back(marker);
      places.push_back(place);
    }
    if (agreementOfNeighbours(markers, places, options_.tag_neighbour_error) < options_.min_marker_agreement)
      return {};
    std::vector<ReadPoint> points;
    double side_px = 0.0;
    for (std::size_t k = 0; k < markers.size(); ++k) {
      side_px = std::max(side_px, markers[k].side_px());
      for (std::size_t c = 0; c < kTagCornerCount; ++c)
        points.push_back({places[k][c], markers[k].corners_px[c]});
    }
    return agreeingPoints(points, side_px);
  }

  Board board_;
  FrameOptions options_;
  MarkerFamily family_, best_family_ = MarkerFamily::Automatic;
  bool settled_ = false, first_is_bright_ = false;
  int quarter_turns_ = 0;                // of the markers, clockwise, once settled
  int mirror_looks_ = 0, mirrored_ = 0;  // pictures without markers, and those whose mirror image has some
};

}  // namespace

std::unique_ptr<PatternFinder> makeCharucoFinder(const Board& board, const FrameOptions& options) {
  return std::make_unique<CharucoFinder>(board, options);
}

}  // namespace evical
