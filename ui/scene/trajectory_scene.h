// SPDX-License-Identifier: GPL-3.0-or-later
// Board, trajectory, cameras, IMU, gravity and ground in a VTK renderer. GUI thread only; one scene per view.
#pragma once

#include "core/data/board_observations.h"
#include "core/geometry/board.h"
#include "core/geometry/camera_intrinsics.h"
#include "ui/scene/placed_board.h"
#include "ui/scene/trajectory_track.h"

#include <QColor>
#include <QString>

#include <memory>
#include <optional>
#include <vector>

class QPainter;
class QRectF;
class vtkRenderer;

namespace evical::ui {

// Mapping of values to colours, and its colour bar.
struct ColourScale {
  QString title;  // with unit
  double high = 1.0;
  bool dark = false;  // for a dark background

  // Values outside 0 to high are clamped; NaN gets a faint colour that is not part of the scale.
  QColor colourOf(double value) const;
};

// End of a scale from 0: a round number that 98 of 100 values do not exceed; NaN does not count.
double scaleEnd(std::vector<double> values);

void paintColourBar(QPainter& painter, const QRectF& area, const ColourScale& scale);

enum class SceneLayer {
  Board,
  Trajectory,
  Cameras,
  CurrentCamera,
  ImuAxes,
  RawPoses,
  Gravity,
  Ground,
  Axes,
  Events
};
inline constexpr int kSceneLayerCount = 10;

enum class TrajectoryColour { Speed, Residual };

struct SceneLabel {
  Eigen::Vector3d at_m;
  QString text;
  QColor colour;
};

// Meaning of a colour.
struct LegendEntry {
  QString text;
  QColor colour;
};
QColor cameraColour(CameraKind kind);  // of the theme

struct SceneExtent {
  Eigen::Vector3d up, front, centre_m;
  double radius_m = 0.0;
};

class TrajectoryScene {
 public:
  explicit TrajectoryScene(vtkRenderer* renderer);
  ~TrajectoryScene();

  void setBoard(const std::optional<Board>& board);  // its frame is the world frame
  void setFurtherBoards(std::vector<PlacedBoard> boards);
  void setIntrinsics(const std::vector<std::optional<CameraIntrinsics>>& cameras);
  // By camera; by default event cameras. Kinds differ in colour and in the length of their frustums, since
  // cameras of one sensor coincide.
  void setCameraKinds(const std::vector<CameraKind>& kinds);
  void setSensorNames(std::vector<QString> cameras, std::vector<QString> imus);  // shown at their poses
  void setTrack(std::shared_ptr<const TrajectoryTrack> track);
  void setGravity(const std::optional<Eigen::Vector3d>& gravity_in_world_m_s2);
  // Poses from single views, of cameras or converted to the IMU.
  void setRawPoses(const std::vector<RigidTransform>& world_from_bodies);
  void setInstant(const std::vector<RigidTransform>& world_from_cameras,
                  const std::vector<RigidTransform>& world_from_imus);

  // They move with their camera.
  void setEvents(FrustumEvents events);

  void setTrajectoryColour(TrajectoryColour colour);
  void setVisible(SceneLayer layer, bool visible);
  bool isVisible(SceneLayer layer) const;
  void setPixelRatio(double ratio);
  void applyTheme();  // the current theme

  // Quantity of the trajectory's colours; none without a trajectory.
  std::optional<ColourScale> colourScale() const;
  std::vector<SceneLabel> labels() const;
  std::vector<LegendEntry> legend() const;  // for the kinds of cameras, if there are several
  bool empty() const;                       // no board and no poses
  SceneExtent extent() const;
  double gridSpacing_m() const;

 private:
  void buildBoard();
  void buildTrack();
  void buildStations();
  void buildRawPoses();
  void buildInstant();
  void buildEvents();
  void buildSurroundings();  // objects whose size depends on the others

  struct Private;
  std::unique_ptr<Private> d_;
};

}  // namespace evical::ui
