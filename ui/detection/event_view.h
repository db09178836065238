// SPDX-License-Identifier: GPL-3.0-or-later
// The sensor's picture with what is drawn over it: zoom to pixels by wheel, pan by drag, F to fit, and what
// the pixel under the mouse last saw. Draws what it is given; computes nothing.
#pragma once

#include "ui/detection/colour_legend.h"
#include "ui/detection/surface_frame.h"

#include <QPointF>
#include <QRect>
#include <QString>
#include <QWidget>

#include <functional>
#include <memory>
#include <optional>

class QPainter;

namespace evical::ui {

class EventView : public QWidget {
  Q_OBJECT

 public:
  // Paints in the sensor's pixels, (0, 0) being the middle of the top left one; `scale` is
  // widget pixels per sensor pixel.
  using Overlay = std::function<void(QPainter& painter, double scale)>;

  explicit EventView(QWidget* parent = nullptr);

  void setFrame(std::shared_ptr<const SurfaceFrame> frame);  // null: nothing to show
  const std::shared_ptr<const SurfaceFrame>& frame() const { return frame_; }
  void setOverlay(Overlay overlay);
  void setCaption(const QString& caption);  // top left, over the picture
  const QString& caption() const { return caption_; }
  void setLegend(ColourLegend legend);  // of the picture's colours
  ColourLegend legend() const { return legend_; }
  const QString& message() const { return message_; }
  void setMessage(const QString& message);  // in the middle, where there is no picture

  void fit();
  void zoomBy(double factor, const QPointF& about);
  double scale() const { return scale_; }
  QPointF sensorFromWidget(const QPointF& point) const;
  QPointF widgetFromSensor(const QPointF& pixel) const;
  QString readout() const;  // of the pixel under the mouse; empty if there is none

  QSize sizeHint() const override { return {700, 480}; }
  QSize minimumSizeHint() const override { return {240, 160}; }

 protected:
  void paintEvent(QPaintEvent*) override;
  void resizeEvent(QResizeEvent*) override;
  void wheelEvent(QWheelEvent*) override;
  void mousePressEvent(QMouseEvent*) override;
  void mouseMoveEvent(QMouseEvent*) override;
  void mouseReleaseEvent(QMouseEvent*) override;
  void mouseDoubleClickEvent(QMouseEvent*) override;
  void keyPressEvent(QKeyEvent*) override;
  void leaveEvent(QEvent*) override;

 private:
  void keepInSight();
  double fitScale() const;
  void paintPicture(QPainter& painter);
  QRect pictureInSight() const;
  QRect noteBox(const QSize& size, bool below) const;
  void paintNote(QPainter& painter, const QString& text, bool below) const;

  std::shared_ptr<const SurfaceFrame> frame_;
  Overlay overlay_;
  QString caption_, message_;
  ColourLegend legend_ = ColourLegend::None;
  bool fitted_ = true;
  double scale_ = 1.0;
  QPointF origin_;  // widget position of the top left pixel's outer corner
  std::optional<QPointF> mouse_, drag_from_;
};

}  // namespace evical::ui
