// SPDX-License-Identifier: GPL-3.0-or-later
// Widget with a VTK scene and its own mouse and keyboard. Works without a display; without OpenGL it shows a
// message instead.
//
// Mouse: left orbits, right or middle (or shift and left) pans, the wheel zooms. Keys: arrows orbit, with
// shift they pan, + and - zoom, 1 front, 2 side, 3 top, 0 everything.
#pragma once

#include "ui/scene/turntable_camera.h"

#include <QColor>
#include <QImage>
#include <QWidget>

#include <functional>
#include <memory>
#include <optional>

class vtkRenderer;

namespace evical::ui {

class View3D : public QWidget {
  Q_OBJECT

 public:
  explicit View3D(QWidget* parent = nullptr);
  ~View3D() override;

  // Loads the graphics driver, which takes a fifth of a second and more, in a separate thread, and draws the
  // objects there that `fill` adds to a renderer, so that the first similar frame finds its shaders compiled.
  // Until then the view shows a message. Call before the first painting, at most once; without it the first
  // painting does all that.
  void startInBackground(const std::function<void(vtkRenderer* renderer)>& fill);
  bool starting() const;

  // For the actors of scenes; an actor belongs to one view only. Lives as long as the view.
  vtkRenderer* renderer() const;
  // Call after changes of the scene: many changes make one frame.
  void redraw();

  void setBackground(const QColor& colour);
  // Painted over the picture, in widget coordinates.
  void setOverlay(std::function<void(QPainter&)> paint);

  // World of the standard views: directions for the turntable, and a sphere around the content. Takes effect
  // with the next look().
  void setWorld(const Eigen::Vector3d& up, const Eigen::Vector3d& front, const Eigen::Vector3d& centre_m,
                double radius_m);
  void setFocus(const Eigen::Vector3d& focus_m);
  // Overrides the turntable until the user moves it.
  void lookThrough(const std::optional<ViewPose>& pose);

  ViewPose viewPose() const;
  std::optional<QPointF> project(const Eigen::Vector3d& point_m) const;

  // Current view with its overlay, with `scale` pixels per screen pixel. Null without a picture.
  QImage picture(double scale);

  // Reason why there is no picture; empty if there is one. Known after the first painting.
  QString problem() const;

  QSize sizeHint() const override { return {900, 600}; }

 public slots:
  void look(evical::ui::StandardView view);

 signals:
  void clicked(const QPointF& position);
  void hovered(const QPointF& position);  // no button pressed
  void turned();                          // by the user, with mouse or keyboard
  void pixelRatioChanged(double ratio);   // before the frame that needs it
  void menuRequested(
      const QPoint& position);  // on the screen: by the menu key, or the right button without a drag

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;

 private:
  QImage drawFrame(double ratio);
  void refreshFrame();
  void drawText(QPainter& painter, const QString& text) const;
  void finishStart();
  bool turnByKey(int key, Qt::KeyboardModifiers modifiers);
  void fitWorld();
  void userTurned();

  struct Private;
  std::unique_ptr<Private> d_;
};

}  // namespace evical::ui
