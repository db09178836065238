// SPDX-License-Identifier: GPL-3.0-or-later
// Shapes of a calibration scene as coloured lines and polygons. For sources that draw with VTK.
#pragma once

#include "ui/scene/camera_shape.h"
#include "ui/scene/placed_board.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <Eigen/Core>
#include <QColor>

#include <array>
#include <optional>
#include <span>

class vtkPolyData;

namespace evical::ui {

// Collects many shapes in one polydata: one actor each would take several times as long to draw.
class ShapeBuilder {
 public:
  ShapeBuilder();

  void setColour(const QColor& colour) { colour_ = colour; }
  void point(const Eigen::Vector3d& at);
  void line(const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  void polyline(std::span<const Eigen::Vector3d> points, std::span<const QColor> colours);
  void polygon(std::span<const Eigen::Vector3d> corners);
  void writeTo(vtkPolyData* data) const;

 private:
  vtkIdType add(const Eigen::Vector3d& at);

  QColor colour_ = Qt::black;
  vtkNew<vtkPoints> points_;
  vtkNew<vtkUnsignedCharArray> colours_;
  vtkNew<vtkCellArray> vertices_, lines_, polygons_;
};

struct BoardColours {
  QColor paper, ink, back, edge;
};
// Rectangle of the paper in the board frame: first and opposite corner.
std::array<Eigen::Vector2d, 2> paperCorners_m(const Board& board);

void addBoard(ShapeBuilder& shapes, const PlacedBoard& placed, const BoardColours& colours);
void addBoardEdge(ShapeBuilder& shapes, const PlacedBoard& placed);

void addFrustum(ShapeBuilder& shapes, const CameraShape& camera, const RigidTransform& world_from_camera,
                double depth_m);
void addImagePlane(ShapeBuilder& shapes, const CameraShape& camera, const RigidTransform& world_from_camera,
                   double depth_m);

void addAxes(ShapeBuilder& shapes, const RigidTransform& world_from_axes, double length_m,
             const std::array<QColor, 3>& colours);
void addArrow(ShapeBuilder& shapes, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

// Square in the plane through `centre_m` perpendicular to `up`, with lines at multiples of the spacing from
// there.
void addGrid(ShapeBuilder& shapes, const Eigen::Vector3d& centre_m, const Eigen::Vector3d& up,
             const Eigen::Vector3d& along, double spacing_m, int half_count);

}  // namespace evical::ui

// Contains every kind of object of the trajectory's scene: drawing it once compiles all shaders.

class vtkRenderer;

namespace evical::ui {

void addSampleScene(vtkRenderer* renderer);

}  // namespace evical::ui
