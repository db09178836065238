// SPDX-License-Identifier: GPL-3.0-or-later
// Picture of the sensor with overlays: wheel zooms down to pixels, drag pans, F fits; shows the last event of
// the pixel under the mouse. Draws its input without any computation.
#pragma once

#include "ui/detection/surface_frame.h"

#include <QPointF>
#include <QRect>
#include <QString>
#include <QWidget>

#include <functional>
#include <memory>
#include <optional>

// Legend of the event view's colours, in a corner of the picture.

class QPainter;

namespace evical::ui {

enum class ColourLegend {
  None,       // frame without events
  Polarity,   // events: brighter and darker
  Direction,  // normal flow: a wheel of the directions
};

// In the lower right corner of `room`; nothing if it would fill the picture.
void paintLegend(QPainter& painter, const QRect& room, ColourLegend legend);

}  // namespace evical::ui

namespace evical::ui {

class EventView : public QWidget {
  Q_OBJECT

 public:
  // Paints in sensor pixels, with (0, 0) in the centre of the top left one; `scale` is widget pixels per
  // sensor pixel.
  using Overlay = std::function<void(QPainter& painter, double scale)>;

  explicit EventView(QWidget* parent = nullptr);

  void setFrame(std::shared_ptr<const SurfaceFrame> frame);  // null: no picture
  const std::shared_ptr<const SurfaceFrame>& frame() const { return frame_; }
  void setOverlay(Overlay overlay);
  void setCaption(const QString& caption);  // top left, on the picture
  const QString& caption() const { return caption_; }
  void setLegend(ColourLegend legend);  // for the picture's colours
  ColourLegend legend() const { return legend_; }
  const QString& message() const { return message_; }
  void setMessage(const QString& message);  // shown in the middle without a picture

  void fit();
  void zoomBy(double factor, const QPointF& about);
  double scale() const { return scale_; }
  QPointF sensorFromWidget(const QPointF& point) const;
  QPointF widgetFromSensor(const QPointF& pixel) const;
  QString readout() const;  // for the pixel under the mouse; empty without one

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
