// SPDX-License-Identifier: GPL-3.0-or-later
// Drawing of the calibrated rig, to scale: axes with letters, fields of view, distances from the reference.
// Drag or arrow keys rotate it; 1, 2 and 3 are the front, side and top views; Home restores the initial view.
#pragma once

#include "core/report/result_yaml.h"

#include <QColor>
#include <QRectF>
#include <QString>
#include <QWidget>

#include <vector>

namespace evical::ui {

class FileSaver;

class RigDrawing : public QWidget {
  Q_OBJECT

 public:
  explicit RigDrawing(QWidget* parent = nullptr);

  void setResult(const NamedResult& named);
  QString text() const;  // the distances between sensors, as text
  void save();           // asks for the file
  // Positions of names, lengths and the axes' letters in a drawing of this size.
  struct Label {
    QString text;
    QRectF place;
    bool name = false, letter = false;
    QColor colour;
  };
  std::vector<Label> labels(const QSizeF& size) const;
  QSize minimumSizeHint() const override { return {220, 150}; }
  QSize sizeHint() const override { return {320, 190}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void contextMenuEvent(QContextMenuEvent* event) override;

 private:
  struct Sensor {
    QString name;
    RigidTransform reference_from_sensor;
    bool reference = false;
    std::vector<Eigen::Vector3d> outline_m;  // pairs of end points, in the sensor's frame
  };
  struct View;

  void look(double azimuth_rad, double elevation_rad);
  double axisLength_m() const;
  View view(const QSizeF& size) const;
  void paint(QPainter& painter, const QSizeF& size) const;
  void paintSensor(QPainter& painter, const View& view, const Sensor& sensor) const;
  void paintDistances(QPainter& painter, const View& view) const;
  void addLetters(const View& view, const Sensor& sensor, std::vector<Label>& labels) const;
  void paintScale(QPainter& painter, const View& view, const QSizeF& size) const;

  std::vector<Sensor> sensors_;
  // Orientation of the initial view: the first camera's image.
  Eigen::Matrix3d reference_from_world_ = Eigen::Matrix3d::Identity();
  double azimuth_rad_, elevation_rad_;
  QPointF last_at_;
  FileSaver* saver_;
};

// Placement of texts in a drawing without overlaps.
class LabelPlaces {
 public:
  explicit LabelPlaces(const QRectF& area) : area_(area) {}

  void occupy(const QRectF& place) { taken_.push_back(place); }
  // Around the first of these centres without overlap inside the area; else around the one with the least.
  // Occupies the place.
  QRectF place(const QSizeF& size, const std::vector<QPointF>& middles);

 private:
  double covered(const QRectF& place) const;

  QRectF area_;
  std::vector<QRectF> taken_;
};

}  // namespace evical::ui
