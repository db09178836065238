// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/scene_shapes.h"

#include "ui/scene/trajectory_scene.h"

#include "core/base/error.h"
#include "core/geometry/printed_pattern.h"

#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace evical::ui {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kCircleCorners = 40;
constexpr int kConeCorners = 16;

using Corners = std::array<Vector3d, 4>;

Corners rectangle(const Vector2d& first, const Vector2d& last, double z_m) {
  return {Vector3d(first.x(), first.y(), z_m), Vector3d(last.x(), first.y(), z_m),
          Vector3d(last.x(), last.y(), z_m), Vector3d(first.x(), last.y(), z_m)};
}

Corners paperAt(const Board& board, double z_m, double wider_m = 0.0) {
  const auto [first, last] = paperCorners_m(board);
  return rectangle(first.array() - wider_m, last.array() + wider_m, z_m);
}

// Offset in depth between ink, paper and back.
double lift(const Board& board) {
  constexpr double kOfRadius = 0.05, kOfSpacing = 0.0125;
  return board.hasCircles() ? kOfRadius * board.radius_m : kOfSpacing * board.spacing_m;
}

// Empty for a board that cannot be printed.
std::vector<PaintedBox> squaresOf(const Board& board) {
  try {
    return boardSquares(board, {});
  } catch (const CalibrationError&) {
    return {};
  }
}

Corners inWorld(const PlacedBoard& placed, Corners corners) {
  for (Vector3d& corner : corners) corner = placed.world_from_board * corner;
  return corners;
}

}  // namespace

ShapeBuilder::ShapeBuilder() {
  colours_->SetNumberOfComponents(3);
  colours_->SetName("colours");
}

vtkIdType ShapeBuilder::add(const Vector3d& at) {
  const auto channel = [](int value) { return static_cast<unsigned char>(value); };
  const std::array<unsigned char, 3> rgb = {channel(colour_.red()), channel(colour_.green()),
                                            channel(colour_.blue())};
  colours_->InsertNextTypedTuple(rgb.data());
  return points_->InsertNextPoint(at.data());
}

void ShapeBuilder::point(const Vector3d& at) {
  const vtkIdType id = add(at);
  vertices_->InsertNextCell(1, &id);
}

void ShapeBuilder::line(const Vector3d& from, const Vector3d& to) {
  const std::array<vtkIdType, 2> ids = {add(from), add(to)};
  lines_->InsertNextCell(2, ids.data());
}

void ShapeBuilder::polyline(std::span<const Vector3d> points, std::span<const QColor> colours) {
  lines_->InsertNextCell(static_cast<int>(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    setColour(colours[k]);
    lines_->InsertCellPoint(add(points[k]));
  }
}

void ShapeBuilder::polygon(std::span<const Vector3d> corners) {
  polygons_->InsertNextCell(static_cast<int>(corners.size()));
  for (const Vector3d& corner : corners) polygons_->InsertCellPoint(add(corner));
}

void ShapeBuilder::writeTo(vtkPolyData* data) const {
  data->Initialize();
  data->SetPoints(points_);
  data->SetVerts(vertices_);
  data->SetLines(lines_);
  data->SetPolys(polygons_);
  data->GetPointData()->SetScalars(colours_);
}

std::array<Vector2d, 2> paperCorners_m(const Board& board) {
  const Vector2d least = board.corner_m(), most = least + board.extent_m();
  const Vector2d margin = Vector2d::Constant(board.printBeyond_m() + 0.5 * board.spacing_m);
  return {least - margin, most + margin};
}

void addBoard(ShapeBuilder& shapes, const PlacedBoard& placed, const BoardColours& colours) {
  const Board& board = placed.board;
  const bool dark_circles = board.circles == CircleShade::Dark;
  const QColor &paper = dark_circles ? colours.paper : colours.ink,
               &ink = dark_circles ? colours.ink : colours.paper;
  const double lift_m = lift(board);
  shapes.setColour(paper);
  shapes.polygon(inWorld(placed, paperAt(board, 0.0)));
  shapes.setColour(colours.back);
  shapes.polygon(inWorld(placed, paperAt(board, lift_m)));
  // Tags are dark with bright bits on top.
  for (const PaintedBox& box : squaresOf(board)) {
    const Vector2d last = box.corner_m + box.size_m;
    shapes.setColour(box.bright ? paper : ink);
    shapes.polygon(inWorld(placed, rectangle(box.corner_m, last, box.bright ? -2.0 * lift_m : -lift_m)));
  }
  if (!board.hasCircles()) return;
  shapes.setColour(ink);
  std::vector<Vector3d> rim(kCircleCorners);
  for (const Vector2d& centre : boardPoints_m(board)) {
    for (int k = 0; k < kCircleCorners; ++k) {
      const double angle = 2.0 * M_PI * k / kCircleCorners;
      rim[static_cast<std::size_t>(k)] =
          placed.world_from_board * Vector3d(centre.x() + board.radius_m * std::cos(angle),
                                             centre.y() + board.radius_m * std::sin(angle), -lift_m);
    }
    shapes.polygon(rim);
  }
}

void addBoardEdge(ShapeBuilder& shapes, const PlacedBoard& placed) {
  // Separate from the paper's edge.
  const auto corners = inWorld(placed, paperAt(placed.board, 0.0, 2.0 * lift(placed.board)));
  for (std::size_t k = 0; k < 4; ++k) shapes.line(corners[k], corners[(k + 1) % 4]);
}

void addFrustum(ShapeBuilder& shapes, const CameraShape& camera, const RigidTransform& world_from_camera,
                double depth_m) {
  std::array<Vector3d, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = world_from_camera * (depth_m * camera.corners[k]);
  for (std::size_t k = 0; k < 4; ++k) {
    shapes.line(world_from_camera.translation_m, corners[k]);
    shapes.line(corners[k], corners[(k + 1) % 4]);
  }
}

void addImagePlane(ShapeBuilder& shapes, const CameraShape& camera, const RigidTransform& world_from_camera,
                   double depth_m) {
  std::array<Vector3d, 4> corners;
  for (std::size_t k = 0; k < 4; ++k) corners[k] = world_from_camera * (depth_m * camera.corners[k]);
  shapes.polygon(corners);
}

void addAxes(ShapeBuilder& shapes, const RigidTransform& world_from_axes, double length_m,
             const std::array<QColor, 3>& colours) {
  for (int axis = 0; axis < 3; ++axis) {
    shapes.setColour(colours[static_cast<std::size_t>(axis)]);
    shapes.line(world_from_axes.translation_m, world_from_axes * (length_m * Vector3d::Unit(axis)));
  }
}

void addArrow(ShapeBuilder& shapes, const Vector3d& from, const Vector3d& to) {
  const Vector3d along = to - from, across = 0.07 * along.norm() * along.unitOrthogonal();
  const Vector3d neck = to - 0.25 * along, other = along.normalized().cross(across);
  shapes.line(from, neck);
  for (int k = 0; k < kConeCorners; ++k) {
    const auto rim = [&](int corner) -> Vector3d {
      const double angle = 2.0 * M_PI * corner / kConeCorners;
      return neck + std::cos(angle) * across + std::sin(angle) * other;
    };
    shapes.polygon(std::array<Vector3d, 3>{to, rim(k), rim(k + 1)});
  }
}

void addGrid(ShapeBuilder& shapes, const Vector3d& centre_m, const Vector3d& up, const Vector3d& along,
             double spacing_m, int half_count) {
  const Vector3d first = (along - along.dot(up) * up).normalized(), second = up.cross(first);
  const double half_m = spacing_m * half_count;
  for (int k = -half_count; k <= half_count; ++k) {
    const Vector3d on_first = centre_m + k * spacing_m * first, on_second = centre_m + k * spacing_m * second;
    shapes.line(on_first - half_m * second, on_first + half_m * second);
    shapes.line(on_second - half_m * first, on_second + half_m * first);
  }
}

void addSampleScene(vtkRenderer* renderer) {
  const RigidTransform pose{Eigen::Quaterniond::Identity(), {0.0, 0.0, -0.5}};
  auto track = std::make_shared<TrajectoryTrack>();
  for (const double time_s : {0.0, 1.0, 2.0}) {
    track->times_s.push_back(time_s);
    track->positions_m.emplace_back(0.1 * time_s, 0.0, -0.5);
    track->speeds_m_s.push_back(time_s);
  }
  track->stations.push_back({0.0, {pose}});
  TrajectoryScene scene(renderer);  // its additions stay with the renderer
  scene.setBoard(Board{});
  scene.setTrack(track);
  scene.setGravity(Eigen::Vector3d(0.0, 9.81, 0.0));
  scene.setRawPoses({pose});
  scene.setInstant({pose}, {pose});
}

}  // namespace evical::ui
