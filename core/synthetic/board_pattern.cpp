#include "core/synthetic/board_pattern.h"

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

constexpr int kBorderModules = 2;  // as in Kalibr's prints
constexpr int kTagSide_modules = kTagSide_bits + 2 * kBorderModules;

PatternBits clockwise(const PatternBits& bits) {
  PatternBits turned = bits;
  for (std::size_t y = 0; y < bits.size(); ++y)
    for (std::size_t x = 0; x < bits.size(); ++x) turned[y][x] = bits[bits.size() - 1 - x][y];
  return turned;
}

TagBits clockwise(const TagBits& bits) {
  TagBits turned;
  for (int y = 0; y < kTagSide_bits; ++y)
    for (int x = 0; x < kTagSide_bits; ++x) turned.setBright(y, x, bits.isBright(kTagSide_bits - 1 - x, y));
  return turned;
}

}  // namespace

BoardPattern::BoardPattern(const Board& board, int tag_turns)
    : board_(board),
      spacing_m_(static_cast<float>(board.spacing_m)),
      radius_m_(static_cast<float>(board.radius_m)),
      tag_m_(static_cast<float>(board.tag_size_m)) {
  const Eigen::Vector2f extent = board.extent_m().cast<float>();
  const auto beyond_m = static_cast<float>(board.printBeyond_m());
  low_m_ = Eigen::Vector2f::Constant(-beyond_m);
  high_m_ = extent + Eigen::Vector2f::Constant(beyond_m);
  if (board.type == BoardType::AprilGrid) tags_ = firstTags(board.rows * board.cols);
  if (board.type == BoardType::Charuco) markers_ = firstMarkers(kUsualMarkers, board.rows * board.cols / 2);
  for (int turn = 0; turn < tag_turns; ++turn) {
    for (TagBits& tag : tags_) tag = clockwise(tag);
    for (PatternBits& marker : markers_) marker = clockwise(marker);
  }
}

bool BoardPattern::isInk(const Eigen::Vector2f& p) const {
  if ((p.array() < low_m_.array()).any() || (p.array() > high_m_.array()).any()) return false;
  switch (board_.type) {
    case BoardType::Checkerboard:
      return inDarkSquare(p);
    case BoardType::AprilGrid:
      return inTag(p);
    case BoardType::Charuco:
      return inDarkSquare(p) || inMarker(p);
    default:
      return inCircle(p);
  }
}

bool BoardPattern::inCircle(const Eigen::Vector2f& p) const {
  const int row = static_cast<int>(std::lround(p.y() / spacing_m_));
  const bool asymmetric = board_.type == BoardType::AsymmetricCircles;
  for (int r = std::max(0, row - 1); r <= std::min(board_.rows - 1, row + 1); ++r) {
    const float column = p.x() / spacing_m_;
    const int c = asymmetric ? static_cast<int>(std::lround(0.5f * (column - static_cast<float>(r % 2))))
                             : static_cast<int>(std::lround(column));
    if (c < 0 || c >= board_.cols) continue;
    if ((p - board_.point_m(r, c).cast<float>()).squaredNorm() < radius_m_ * radius_m_) return true;
  }
  return false;
}

// The square before the first corner is dark.
bool BoardPattern::inDarkSquare(const Eigen::Vector2f& p) const {
  const auto row = static_cast<int>(std::floor(p.y() / spacing_m_)),
             col = static_cast<int>(std::floor(p.x() / spacing_m_));
  return (row + col) % 2 == 0;
}

// In bright squares, numbered row by row; the first square of all is dark.
bool BoardPattern::inMarker(const Eigen::Vector2f& p) const {
  const auto row = static_cast<int>(std::floor(p.y() / spacing_m_)) + 1,
             col = static_cast<int>(std::floor(p.x() / spacing_m_)) + 1;
  const auto number = static_cast<std::size_t>((row * board_.cols + col) / 2);
  if (row < 0 || col < 0 || row >= board_.rows || col >= board_.cols || number >= markers_.size())
    return false;
  const PatternBits& bits = markers_[number];
  const Eigen::Vector2f corner_m =
      spacing_m_ * Eigen::Vector2f(static_cast<float>(col - 1), static_cast<float>(row - 1));
  const Eigen::Array2f place = (p - corner_m).array() - 0.5f * (spacing_m_ - tag_m_);
  if ((place < 0.0f).any() || (place >= tag_m_).any()) return false;
  const auto size = static_cast<int>(bits.size());
  const auto at = [&](float along_m) {
    return static_cast<int>(along_m / tag_m_ * static_cast<float>(size + 2)) - 1;
  };
  const int x = at(place.x()), y = at(place.y());
  if (x < 0 || y < 0 || x >= size || y >= size) return true;  // its border
  return !bits[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
}

bool BoardPattern::inTag(const Eigen::Vector2f& p) const {
  const auto row = static_cast<int>(std::floor(p.y() / spacing_m_)),
             col = static_cast<int>(std::floor(p.x() / spacing_m_));
  const Eigen::Vector2f within =
      p - spacing_m_ * Eigen::Vector2f(static_cast<float>(col), static_cast<float>(row));
  const bool right = within.x() >= tag_m_, below = within.y() >= tag_m_;
  if (right != below) return false;  // in a gap
  if (right) return true;            // where two gaps cross
  if (row < 0 || col < 0 || row >= board_.rows || col >= board_.cols) return false;
  const auto at = [&](float place) {
    return std::clamp(static_cast<int>(place / tag_m_ * kTagSide_modules), 0, kTagSide_modules - 1) -
           kBorderModules;
  };
  const int x = at(within.x()), y = at(within.y());
  if (x < 0 || y < 0 || x >= kTagSide_bits || y >= kTagSide_bits) return true;
  const auto tag = static_cast<std::size_t>((board_.rows - 1 - row) * board_.cols + col);
  return tag < tags_.size() && !tags_[tag].isBright(y, x);
}

}  // namespace evical
