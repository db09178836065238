// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing of a motion: a person with the camera in front of the board, and the camera's image.
#pragma once

#include "core/geometry/so3.h"

#include <QElapsedTimer>
#include <QString>
#include <QTimer>
#include <QWidget>

#include <vector>

class QPainter;

namespace evical::ui {

// Motions that a recording needs, for animations: camera poses over ten seconds, repeated.

inline constexpr double kShownMotion_s = 10.0;
// Distance from the camera's rest position to the board in the drawing's world; x to the right, y down.
inline constexpr double kShownDistance_m = 0.6;

struct ShownMotion {
  QString name, title, words;  // name for programs; words: instructions and reasons
  // Pose at a share of the ten seconds; the drawing's world is the camera's frame at rest.
  RigidTransform (*world_from_camera)(double share) = nullptr;
  // Point of the camera, in its frame, whose path is drawn as an arrow.
  Eigen::Vector3d followed = Eigen::Vector3d::Zero();
};

const std::vector<ShownMotion>& shownMotions();

class MotionPicture : public QWidget {
  Q_OBJECT

 public:
  explicit MotionPicture(QWidget* parent = nullptr);

  void setMotion(const ShownMotion& motion);            // from its start
  void setSceneOnly(bool only) { scene_only_ = only; }  // without the camera's image
  void setPlaying(bool playing);                        // else it pauses
  bool playing() const { return timer_.isActive(); }
  double share() const { return share_; }  // elapsed share of the ten seconds
  void setShare(double share);
  QSize sizeHint() const override { return {560, 300}; }
  QSize minimumSizeHint() const override { return scene_only_ ? QSize(120, 120) : QSize(360, 190); }

 protected:
  void paintEvent(QPaintEvent* event) override;
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  void tick();
  void paintScene(QPainter& painter, const QRectF& box) const;
  void paintView(QPainter& painter, const QRectF& box) const;
  void paintCaption(QPainter& painter, const QRectF& box, const QString& text) const;

  ShownMotion motion_;
  QTimer timer_;
  QElapsedTimer since_tick_;
  double share_ = 0.0;
  bool scene_only_ = false;
  bool wanted_ = false;  // plays while visible
};

}  // namespace evical::ui
