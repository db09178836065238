#include "core/frontend/board_scene.h"

#include "core/geometry/camera_model.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <mutex>
#include <utility>

namespace evical {
namespace {

std::shared_ptr<const IdealPixels> idealPixels(const CameraIntrinsics& camera, Resolution resolution_px) {
  auto pixels = std::make_shared<IdealPixels>();
  pixels->ideal = UndistortionTable(camera);
  pixels->stretch.reserve(static_cast<std::size_t>(resolution_px.pixelCount()));
  for (int y = 0; y < resolution_px.height_px; ++y) {
    for (int x = 0; x < resolution_px.width_px; ++x) {
      const Eigen::Vector2d pixel = pixels->ideal(x, y).cast<double>();
      Eigen::Matrix2f j = Eigen::Matrix2f::Constant(std::numeric_limits<float>::quiet_NaN());
      if (pixel.allFinite()) j = idealPixelScale(camera, pixel).cast<float>();
      const Eigen::Matrix2f jj = j * j.transpose();
      pixels->stretch.push_back({jj(0, 0), jj(0, 1), jj(1, 1)});
    }
  }
  return pixels;
}

// The edge that begins or ends at a corner and goes into a direction, from the corner to its middle.
PrintedEdge armAt(const std::vector<PrintedEdge>& edges, const Eigen::Vector2d& corner_m,
                  const Eigen::Vector2d& direction, double tolerance_m) {
  for (const PrintedEdge& edge : edges) {
    for (const bool backwards : {false, true}) {
      const Eigen::Vector2d &from_m = backwards ? edge.to_m : edge.from_m,
                            &to_m = backwards ? edge.from_m : edge.to_m;
      if ((from_m - corner_m).norm() > tolerance_m || (to_m - from_m).dot(direction) < tolerance_m) continue;
      return {corner_m, 0.5 * (from_m + to_m), edge.paper, edge.ink_m, edge.paper_m};
    }
  }
  return {};  // of length 0: it has no image
}

}  // namespace

EdgeMap::EdgeMap(const std::vector<PrintedEdge>& edges) {
  constexpr double kCellsInRoom = 8.0, kCellsAcross = 512.0;
  low_m_.setConstant(std::numeric_limits<double>::infinity());
  high_m_ = -low_m_;
  double room_m = std::numeric_limits<double>::infinity();
  for (const PrintedEdge& edge : edges) {
    low_m_ = low_m_.cwiseMin(edge.from_m);
    high_m_ = high_m_.cwiseMax(edge.to_m);
    room_m = std::min({room_m, edge.ink_m, edge.paper_m});
  }
  cell_m_ = std::min(room_m / kCellsInRoom, (high_m_ - low_m_).maxCoeff() / kCellsAcross);
  reach_ = std::min(static_cast<int>(0.5 * room_m / cell_m_), kNone - 1);
  low_m_.array() -= room_m;
  high_m_.array() += room_m;
  columns_ = static_cast<int>(std::ceil((high_m_.x() - low_m_.x()) / cell_m_));
  rows_ = static_cast<int>(std::ceil((high_m_.y() - low_m_.y()) / cell_m_));
  high_m_ = low_m_ + cell_m_ * Eigen::Vector2d(columns_, rows_);
  for (std::vector<std::uint8_t>& plane : cells_)
    plane.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNone);
  for (const PrintedEdge& edge : edges) draw(edge);
}

// Cells up to half the room from the edge.
void EdgeMap::draw(const PrintedEdge& edge) {
  const bool along_x = edge.paper.x() != 0.0;
  const int direction = (along_x ? kPlusX : kPlusY) + (edge.paper.sum() < 0.0 ? 1 : 0);
  std::vector<std::uint8_t>& plane = cells_[static_cast<std::size_t>(direction)];
  const Eigen::Vector2d from = (edge.from_m - low_m_) / cell_m_, to = (edge.to_m - low_m_) / cell_m_;
  const double line = along_x ? from.x() : from.y();
  const int begin = static_cast<int>(std::round(along_x ? from.y() : from.x())),
            end = static_cast<int>(std::round(along_x ? to.y() : to.x())),
            first = static_cast<int>(std::floor(line)) - reach_;
  for (int across = first; across <= first + 2 * reach_; ++across) {
    const auto distance = static_cast<std::uint8_t>(std::abs(across + 0.5 - line));
    if (distance >= reach_) continue;
    for (int along = begin; along < end; ++along) {
      const int column = along_x ? across : along, row = along_x ? along : across;
      if (column < 0 || row < 0 || column >= columns_ || row >= rows_) continue;
      std::uint8_t& cell = plane[static_cast<std::size_t>(row * columns_ + column)];
      cell = std::min(cell, distance);
    }
  }
}

BoardEdges::BoardEdges(const Board& board, const TagPrint& print)
    : pattern(board, print), edges(pattern.edges()), map(edges), print(print) {
  constexpr double kSamePlace = 1e-3;  // of the spacing
  for (const Eigen::Vector2d& corner_m : boardPoints_m(board)) {
    std::array<PrintedEdge, 4>& own = arms.emplace_back();
    for (std::size_t k = 0; k < own.size(); ++k) {
      const double sign = k % 2 == 0 ? 1.0 : -1.0;
      const Eigen::Vector2d direction = sign * (k < 2 ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY());
      own[k] = armAt(edges, corner_m, direction, kSamePlace * board.spacing_m);
    }
  }
}

std::shared_ptr<const BoardEdges> edgesOf(const Board& board, const TagPrint& print) {
  struct Kept {
    Board board;
    TagPrint print;
    std::shared_ptr<const BoardEdges> edges;
  };
  constexpr std::size_t kMaxKept = 32;
  static std::mutex mutex;
  static std::deque<Kept> all;
  const std::scoped_lock lock(mutex);
  for (const Kept& kept : all)
    if (kept.board == board && kept.print == print) return kept.edges;
  if (all.size() == kMaxKept) all.pop_front();
  return all.emplace_back(Kept{board, print, std::make_shared<const BoardEdges>(board, print)}).edges;
}

BoardScene::BoardScene(const Board& the_board, Resolution resolution,
                       std::optional<CameraIntrinsics> intrinsics)
    : board(the_board), resolution_px(resolution), camera(std::move(intrinsics)) {
  if (board.hasPattern() && !board.hasCircles()) edges = edgesOf(board, TagPrint{});
  if (camera) pixels = idealPixels(*camera, resolution);
}

}  // namespace evical
