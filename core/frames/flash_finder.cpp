#include "core/frames/flash_finder.h"

#include "core/frames/board_finder.h"
#include "core/frames/corner_measurement.h"
#include "core/frames/gray_image.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

// Enlargement factor. Edges of circles are measured with subpixel accuracy, so circles need less enlargement.
int enlargement(const Board& board, const Resolution& size_px, int min_side_px) {
  constexpr int kEnoughForCircles_px = 200;
  const int longest = std::max({size_px.width_px, size_px.height_px, 1});
  if (board.hasCircles()) min_side_px = std::min(min_side_px, kEnoughForCircles_px);
  return std::max(1, (min_side_px + longest - 1) / longest);
}

// Options in the enlarged picture's pixels.
FrameOptions enlargedOptions(FrameOptions options, int times) {
  options.subpixel_window_px *= times;
  options.min_sigma_px *= times;
  options.max_move_px *= times;
  options.prediction_gate_px *= times;
  return options;
}

// Distance from a corner within which there are no other features.
double plain_m(const Board& board) {
  const double gap_m = board.spacing_m - board.tag_size_m;
  constexpr double kBorder = 0.2;  // of Kalibr's tags
  return board.type == BoardType::AprilGrid ? std::min(kBorder * board.tag_size_m, gap_m)
         : board.type == BoardType::Charuco ? 0.5 * gap_m
                                            : board.spacing_m;
}

// Pixels' centres are at integers.
Eigen::Vector2d onSensor(const Eigen::Vector2d& at_px, int times) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5);
  return (at_px + half) / times - half;
}
Eigen::Vector2d inLarger(const Eigen::Vector2d& at_px, int times) {
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5);
  return times * (at_px + half) - half;
}

}  // namespace

FlashFinder::FlashFinder(const Board& board, Resolution size_px, const FrameOptions& frames,
                         const BlinkOptions& options)
    : board_(board),
      size_px_(size_px),
      times_(enlargement(board, size_px, options.min_side_px)),
      options_(enlargedOptions(frames, times_)),
      finder_(board, options_, CheckerboardParts::Any) {}

FoundPoints FlashFinder::find(const FlashCounts& sum) {
  for (const Flashing flashing : {Flashing::Ink, Flashing::Paper}) {
    if (flashing_ && *flashing_ != flashing) continue;
    const GrayImage picture = pictureOf(sum, size_px_, flashing), larger = enlarged(picture, times_);
    FoundPoints found = finder_.find(larger);
    if (found.empty()) continue;
    flashing_ = flashing;
    last_found_ = found;
    return onSensor(picture, larger, std::move(found));
  }
  return {};
}

FoundPoints FlashFinder::measure(const FlashCounts& sum, const FoundPoints& near, double gate_px) const {
  FoundPoints expected = near;
  for (FoundPoint& point : expected) point.at_px = inLarger(point.at_px, times_);
  const std::optional<PlaneMap> map = mapOf(expected, board_);
  if (!map || !flashing_) return {};
  const GrayImage picture = pictureOf(sum, size_px_, *flashing_), larger = enlarged(picture, times_);
  FoundPoints found = finder_.measure(larger, *map, times_ * gate_px);
  if (board_.type == BoardType::Checkerboard) keepThoseOf(last_found_, found);
  return onSensor(picture, larger, std::move(found));
}

FoundPoints FlashFinder::onSensor(const GrayImage& picture, const GrayImage& larger,
                                  FoundPoints found) const {
  if (!board_.hasCircles()) found = saddles(picture, larger, found);
  // Neighbouring edge points of an enlarged picture have correlated noise.
  const double shared = board_.hasCircles() ? times_ : 1.0;
  for (FoundPoint& point : found) {
    point.at_px = evical::onSensor(point.at_px, times_);
    point.covariance_px2 *= shared / (times_ * times_);
    point.ellipse_px2 /= times_ * times_;
  }
  return found;
}

FoundPoints FlashFinder::saddles(const GrayImage& picture, const GrayImage& larger,
                                 const FoundPoints& found) const {
  constexpr double kSmoothed = 0.1, kReach = 0.3;  // relative to the distance without other features
  constexpr double kMin_px = 0.5, kMax_px = 1.5;   // on the sensor
  const std::optional<PlaneMap> map = mapOf(found, board_);
  if (!map) return {};
  const double noise = noiseSigma(picture);
  const Eigen::Matrix2d floor_px2 = std::pow(options_.min_sigma_px, 2) * Eigen::Matrix2d::Identity();
  FoundPoints measured;
  for (const FoundPoint& point : found) {
    const double plain_px =
        plain_m(board_) *
        std::sqrt(std::abs(map->placeOf(board_.point_m(point.point)).px_per_m.determinant()));
    const double sigma_px = std::clamp(kSmoothed * plain_px, kMin_px * times_, kMax_px * times_);
    const auto corner = measureSaddle(larger, point.at_px, sigma_px, kReach * plain_px, noise, times_);
    if (corner)
      measured.push_back({point.point, corner->at_px, corner->covariance_px2 + floor_px2, point.ellipse_px2});
  }
  return measured;
}

}  // namespace evical
