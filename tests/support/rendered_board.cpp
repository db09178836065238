#include "tests/support/rendered_board.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/circle_conic.h"
#include "core/geometry/marker_bits.h"
#include "core/geometry/so3.h"
#include "tests/support/aruco_library.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <opencv2/imgproc.hpp>

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <random>

namespace evical {
namespace {

using Pattern = std::function<double(const Eigen::Vector2d&)>;

int floorOf(double value) {
  return static_cast<int>(std::floor(value));
}

Pattern circles(const Board& board) {
  const std::vector<Eigen::Vector2d> centres = boardPoints_m(board);
  const bool dark = board.circles == CircleShade::Dark;
  return [board, centres, dark](const Eigen::Vector2d& at) {
    const int row = floorOf(at.y() / board.spacing_m + 0.5);
    const double stagger = board.type == BoardType::AsymmetricCircles ? (row & 1) : 0;
    const double step = board.type == BoardType::AsymmetricCircles ? 2.0 * board.spacing_m : board.spacing_m;
    const int col = floorOf((at.x() - stagger * board.spacing_m) / step + 0.5);
    const bool on_board = row >= 0 && col >= 0 && row < board.rows && col < board.cols;
    const bool inside = on_board && (board.point_m(row, col) - at).norm() < board.radius_m;
    return inside == dark ? 0.0 : 1.0;
  };
}

Pattern checkerboard(const Board& board) {
  return [board](const Eigen::Vector2d& at) {
    const int i = floorOf(at.x() / board.spacing_m), j = floorOf(at.y() / board.spacing_m);
    const bool on_board = i >= -1 && j >= -1 && i < board.cols && j < board.rows;
    return on_board && (i + j) % 2 == 0 ? 0.0 : 1.0;
  };
}

void rotateClockwise(cv::Mat& picture, int quarter_turns) {
  for (int turn = 0; turn < quarter_turns; ++turn) cv::rotate(picture, picture, cv::ROTATE_90_CLOCKWISE);
}

int tagAt(const Board& board, TagOrder order, int row, int col) {
  const int from_below = board.rows - 1 - row;
  switch (order) {
    case TagOrder::RowsUp:
      return from_below * board.cols + col;
    case TagOrder::RowsDown:
      return row * board.cols + col;
    case TagOrder::ColumnsUp:
      return col * board.rows + from_below;
    case TagOrder::ColumnsDown:
      break;
  }
  return col * board.rows + row;
}

Pattern tagGrid(const PrintedBoard& printed) {
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(),
                                                                                tag36h11_destroy);
  const Board board = printed.board;
  std::vector<cv::Mat> tags;  // 6 x 6 bits
  for (int id = printed.first_tag; id < printed.first_tag + board.rows * board.cols; ++id) {
    cv::Mat& tag = tags.emplace_back(6, 6, CV_8UC1);
    for (std::uint32_t bit = 0; bit < family->nbits; ++bit) {
      const bool bright = (family->codes[id] >> (family->nbits - 1 - bit) & 1) != 0;
      tag.at<std::uint8_t>(static_cast<int>(family->bit_y[bit]) - 1,
                           static_cast<int>(family->bit_x[bit]) - 1) = bright ? 255 : 0;
    }
    rotateClockwise(tag, printed.clockwise_turns);
  }
  return [board, tags, border = printed.border_bits, order = printed.order](const Eigen::Vector2d& at) {
    const double gap = board.spacing_m - board.tag_size_m;
    const int col = floorOf(at.x() / board.spacing_m), row = floorOf(at.y() / board.spacing_m);
    const Eigen::Vector2d in_cell = at - board.spacing_m * Eigen::Vector2d(col, row);
    const bool beside_x = in_cell.x() >= board.tag_size_m, beside_y = in_cell.y() >= board.tag_size_m;
    // The small squares between tags and at the board's corners.
    if (beside_x && beside_y)
      return col >= -1 && row >= -1 && col < board.cols && row < board.rows && gap > 0.0 ? 0.0 : 1.0;
    if (beside_x || beside_y || col < 0 || row < 0 || col >= board.cols || row >= board.rows) return 1.0;
    const double cells = 6 + 2 * border;
    const int x = floorOf(in_cell.x() / board.tag_size_m * cells) - border;
    const int y = floorOf(in_cell.y() / board.tag_size_m * cells) - border;
    if (x < 0 || y < 0 || x >= 6 || y >= 6) return 0.0;
    return tags[static_cast<std::size_t>(tagAt(board, order, row, col))].at<std::uint8_t>(y, x) > 127 ? 1.0
                                                                                                      : 0.0;
  };
}

Pattern charuco(const PrintedBoard& printed) {
  const Board board = printed.board;
  const auto dictionary = test::aruco::dictionary(printed.dictionary);
  const int cells = dictionary->markerSize + 2;
  std::map<std::pair<int, int>, cv::Mat> markers;
  int id = 0;
  for (const BoardSquare& square : charucoMarkers(board, printed.first_is_bright)) {
    cv::Mat& marker = markers[{square.row, square.col}];
    test::aruco::drawMarker(*dictionary, id++, cells, marker);
    rotateClockwise(marker, printed.clockwise_turns);
  }
  return [board, markers, cells](const Eigen::Vector2d& at) {
    const int col = floorOf(at.x() / board.spacing_m) + 1, row = floorOf(at.y() / board.spacing_m) + 1;
    if (col < 0 || row < 0 || col >= board.cols || row >= board.rows) return 1.0;
    const auto marker = markers.find({row, col});
    if (marker == markers.end()) return 0.0;
    const Eigen::Vector2d in_square = at - squareCorner_m(board, {row, col});
    const double margin = 0.5 * (board.spacing_m - board.tag_size_m);
    const int x = floorOf((in_square.x() - margin) / board.tag_size_m * cells);
    const int y = floorOf((in_square.y() - margin) / board.tag_size_m * cells);
    if (x < 0 || y < 0 || x >= cells || y >= cells) return 1.0;
    return marker->second.at<std::uint8_t>(y, x) > 127 ? 1.0 : 0.0;
  };
}

// Board coordinates behind the corners of all pixels.
std::vector<Eigen::Vector2d> planeBehind(const CameraIntrinsics& camera,
                                         const RigidTransform& camera_from_board) {
  const RigidTransform board_from_camera = inverse(camera_from_board);
  std::vector<Eigen::Vector2d> places;
  for (int y = 0; y <= camera.resolution_px.height_px; ++y) {
    for (int x = 0; x <= camera.resolution_px.width_px; ++x) {
      const auto ray = unproject(camera, {x - 0.5, y - 0.5});
      places.emplace_back(1e3, 1e3);
      if (!ray) continue;
      const Eigen::Vector3d way = board_from_camera.rotation * ray->homogeneous();
      const Eigen::Vector3d from = board_from_camera.translation_m;
      const double length = -from.z() / way.z();
      if (length > 0.0) places.back() = (from + length * way).head<2>();
    }
  }
  return places;
}

}  // namespace

CameraIntrinsics distortingCamera() {
  CameraIntrinsics camera;
  camera.resolution_px = {752, 480};
  camera.focal_length_px = {460.0, 458.0};
  camera.principal_point_px = {367.0, 248.0};
  camera.distortion = {-0.28, 0.074, 0.0002, 0.0, 0.0};
  return camera;
}

Pattern patternOf(const PrintedBoard& printed) {
  if (printed.mirrored) {
    PrintedBoard upright = printed;
    upright.mirrored = false;
    return [width_m = printed.board.extent_m().x(), pattern = patternOf(upright)](const Eigen::Vector2d& at) {
      return pattern({width_m - at.x(), at.y()});
    };
  }
  switch (printed.board.type) {
    case BoardType::Checkerboard:
      return checkerboard(printed.board);
    case BoardType::AprilGrid:
      return tagGrid(printed);
    case BoardType::Charuco:
      return charuco(printed);
    default:
      return circles(printed.board);
  }
}

GrayImage renderBoard(const PrintedBoard& printed, const CameraIntrinsics& camera,
                      const RigidTransform& camera_from_board, const Exposure& exposure) {
  // Each sample of a pixel at a different height and width, so that edges along rows are as fine as others.
  constexpr int kParts = 25;
  const Pattern pattern = patternOf(printed);
  const std::vector<Eigen::Vector2d> corners = planeBehind(camera, camera_from_board);
  const int width = camera.resolution_px.width_px, height = camera.resolution_px.height_px;
  cv::Mat exact(height, width, CV_32FC1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Eigen::Vector2d* corner = &corners[static_cast<std::size_t>(y * (width + 1) + x)];
      double sum = 0.0;
      for (int k = 0; k < kParts; ++k) {
        const double u = (k + 0.5) / kParts, v = (k * 7 % kParts + 0.5) / kParts;
        sum += pattern((1 - v) * ((1 - u) * corner[0] + u * corner[1]) +
                       v * ((1 - u) * corner[width + 1] + u * corner[width + 2]));
      }
      exact.at<float>(y, x) =
          static_cast<float>(exposure.dark + (exposure.bright - exposure.dark) * sum / kParts);
    }
  }
  if (exposure.blur_px > 0.0) cv::GaussianBlur(exact, exact, {0, 0}, exposure.blur_px);
  std::mt19937 random(exposure.seed);
  std::normal_distribution<double> noise(0.0, std::max(exposure.noise, 1e-9));
  GrayImage image{camera.resolution_px, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.pixels.push_back(cv::saturate_cast<std::uint8_t>(exact.at<float>(y, x) + noise(random)));
  return image;
}

std::optional<Eigen::Vector2d> truePoint(const Board& board, int point, const CameraIntrinsics& camera,
                                         const RigidTransform& camera_from_board) {
  const auto ideal = projectedCircleCentre(camera, camera_from_board, board.point_m(point), board.radius_m);
  if (!ideal) return std::nullopt;
  return pixelFromIdeal(camera, *ideal);
}

FoundPoints asTrue(FoundPoints points, const Board& board, const CameraIntrinsics& camera,
                   const RigidTransform& camera_from_board) {
  if (points.empty() || !board.hasHalfTurnAmbiguity()) return points;
  const auto truth = truePoint(board, points.front().point, camera, camera_from_board);
  if (truth && (*truth - points.front().at_px).norm() < 20.0) return points;
  for (FoundPoint& point : points) point.point = board.pointCount() - 1 - point.point;
  return points;
}

RigidTransform lookAt(const Board& board, double distance_m, const Eigen::Vector3d& turn_rad,
                      const Eigen::Vector2d& beside_m) {
  RigidTransform camera_from_board;
  camera_from_board.rotation = quaternionExp(turn_rad);
  const Eigen::Vector2d middle = 0.5 * board.extent_m();
  camera_from_board.translation_m = Eigen::Vector3d(beside_m.x(), beside_m.y(), distance_m) -
                                    camera_from_board.rotation * Eigen::Vector3d(middle.x(), middle.y(), 0.0);
  return camera_from_board;
}

}  // namespace evical
