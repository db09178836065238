#include "core/frames/board_finder.h"

#include "core/frames/plane_map.h"

#include <opencv2/core.hpp>

namespace evical {
namespace {

std::unique_ptr<PatternFinder> finderOf(const Board& board, const FrameOptions& options,
                                        CheckerboardParts parts) {
  validate(board);
  switch (board.type) {
    case BoardType::Checkerboard:
      return makeCheckerboardFinder(board, options, parts);
    case BoardType::AprilGrid:
      return makeTagGridFinder(board, options);
    case BoardType::Charuco:
      return makeCharucoFinder(board, options);
    default:
      return makeCircleFinder(board, options);
  }
}

constexpr int kSmallestSide_px = 16;  // smallest size for OpenCV's finders

bool isLargeEnough(const GrayImage& image) {
  return image.size_px.width_px >= kSmallestSide_px && image.size_px.height_px >= kSmallestSide_px;
}

}  // namespace

BoardFinder::BoardFinder(const Board& board, const FrameOptions& options, CheckerboardParts parts)
    : finder_(finderOf(board, options, parts)) {}
BoardFinder::~BoardFinder() = default;
BoardFinder::BoardFinder(BoardFinder&&) noexcept = default;
BoardFinder& BoardFinder::operator=(BoardFinder&&) noexcept = default;

FoundPoints BoardFinder::find(const GrayImage& image) {
  if (!isLargeEnough(image)) return {};
  try {
    return finder_->search(image);
  } catch (const cv::Exception&) {
    return {};  // some pictures without a board fail assertions in its finders
  }
}

FoundPoints BoardFinder::measure(const GrayImage& image, const PlaneMap& map, double gate_px) const {
  return isLargeEnough(image) ? finder_->measure(image, map, gate_px) : FoundPoints{};
}

bool BoardFinder::renumbered() {
  return finder_->renumbered();
}

std::string BoardFinder::doubt() const {
  return finder_->doubt();
}

std::string BoardFinder::remark() const {
  return finder_->remark();
}

std::optional<PlaneMap> mapOf(const FoundPoints& points, const Board& board) {
  std::vector<ReadPoint> known;
  for (const FoundPoint& point : points) known.push_back({board.point_m(point.point), point.at_px});
  return mapOf(known, board.spacing_m);
}

}  // namespace evical
