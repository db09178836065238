// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/result/rig_drawing.h"

#include "ui/jobs/file_saver.h"
#include "ui/theme/theme.h"

#include <QContextMenuEvent>
#include <QKeyEvent>
#include <QMenu>
#include <QPainter>

#include <algorithm>
#include <array>
#include <cmath>

namespace evical::ui {
namespace {

using Eigen::Vector3d;

constexpr double kHomeAzimuth_rad = -0.65, kHomeElevation_rad = 0.45;
constexpr double kTurn_rad_per_px = 0.01, kTurn_rad_per_key = 0.1;
constexpr double kMillimetresPerMetre = 1e3;
constexpr double kMinExtent_m = 0.02;  // for sensors on one chip

// Edges and far border of the field of view, at distance `depth`.
std::vector<Vector3d> cameraOutline(const std::optional<CameraIntrinsics>& lens, double depth_m) {
  constexpr double kWidestHalf = 1.2;  // shows the centre of a fisheye's view
  double half_x = 0.4, half_y = 0.3;
  if (lens && lens->focal_length_px.minCoeff() > 0.0) {
    half_x = std::min(kWidestHalf, 0.5 * lens->resolution_px.width_px / lens->focal_length_px.x());
    half_y = std::min(kWidestHalf, 0.5 * lens->resolution_px.height_px / lens->focal_length_px.y());
  }
  const std::array<Vector3d, 4> rim = {
      Vector3d(-half_x, -half_y, 1.0) * depth_m, Vector3d(half_x, -half_y, 1.0) * depth_m,
      Vector3d(half_x, half_y, 1.0) * depth_m, Vector3d(-half_x, half_y, 1.0) * depth_m};
  std::vector<Vector3d> lines;
  for (std::size_t k = 0; k < rim.size(); ++k) {
    lines.insert(lines.end(), {Vector3d::Zero(), rim[k]});
    lines.insert(lines.end(), {rim[k], rim[(k + 1) % rim.size()]});
  }
  return lines;
}

// A flat box about the origin.
std::vector<Vector3d> imuOutline(double half_m) {
  const auto corner = [half_m](unsigned k) {
    return Vector3d((k & 1u) != 0 ? half_m : -half_m, (k & 2u) != 0 ? half_m : -half_m,
                    0.4 * ((k & 4u) != 0 ? half_m : -half_m));
  };
  std::vector<Vector3d> lines;
  for (unsigned k = 0; k < 8; ++k)
    for (const unsigned bit : {1u, 2u, 4u})
      if ((k & bit) == 0) lines.insert(lines.end(), {corner(k), corner(k | bit)});
  return lines;
}

QString millimetres(double length_m) {
  return QObject::tr("%1 mm").arg(kMillimetresPerMetre * length_m, 0, 'f', 1);
}

// 1, 2 or 5 times a power of ten, at most the value.
double roundedDown(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double first = value / power;
  return power * (first >= 5.0 ? 5.0 : first >= 2.0 ? 2.0 : 1.0);
}

// Candidates around a point: first below or above, away from the axes, then to the sides, then farther away.
std::vector<QPointF> around(const QPointF& point, const QSizeF& size, bool below) {
  constexpr double kGap_px = 8.0;
  const double side = below ? 1.0 : -1.0;
  const double across = 0.5 * size.width() + kGap_px, along = 0.5 * size.height() + kGap_px;
  std::vector<QPointF> all;
  for (const double further : {1.0, 1.7, 2.6, 3.6})
    for (const QPointF& direction :
         {QPointF(0.0, side), QPointF(1.0, 0.0), QPointF(-1.0, 0.0), QPointF(0.0, -side), QPointF(0.8, side),
          QPointF(-0.8, side), QPointF(0.8, -side), QPointF(-0.8, -side)})
      all.push_back(point + further * QPointF(direction.x() * across, direction.y() * along));
  return all;
}

// Candidates along the line, from its middle.
std::vector<QPointF> along(const QPointF& from, const QPointF& to) {
  std::vector<QPointF> all;
  for (const double share : {0.5, 0.62, 0.38, 0.74, 0.26}) all.push_back(from + share * (to - from));
  for (const double aside_px : {16.0, -16.0, 30.0, -30.0})
    for (const double share : {0.5, 0.7, 0.3})
      all.push_back(from + share * (to - from) + QPointF(0.0, aside_px));
  return all;
}

QFont boldOf(QFont font) {
  font.setWeight(QFont::DemiBold);
  return font;
}

QSizeF sizeOf(const QString& text, const QFont& font) {
  return QFontMetricsF(font).boundingRect(text).size() + QSizeF(6.0, 2.0);
}

}  // namespace

// Orthographic projection: lengths along an axis are comparable.
struct RigDrawing::View {
  Eigen::Matrix3d screen_from_reference;
  Vector3d centre_m;
  QPointF middle;
  double px_per_m = 1.0;

  QPointF operator()(const Vector3d& point_m) const {
    const Vector3d on_screen = screen_from_reference * (point_m - centre_m);
    return middle + px_per_m * QPointF(on_screen.x(), on_screen.y());
  }
};

RigDrawing::RigDrawing(QWidget* parent)
    : QWidget(parent),
      azimuth_rad_(kHomeAzimuth_rad),
      elevation_rad_(kHomeElevation_rad),
      saver_(new FileSaver(this)) {
  setFocusPolicy(Qt::StrongFocus);
  setToolTip(
      tr("Calibrated rig: x red, y green, z blue.\nDrag or arrow keys: rotate. 1, 2, 3: front, side, "
         "top. Home: initial view. Right button: save."));
}

void RigDrawing::setResult(const NamedResult& named) {
  const CalibrationState& state = named.result->state;
  sensors_.clear();
  for (std::size_t i = 0; i < state.cameras.size(); ++i)
    sensors_.push_back({QString::fromStdString(named.cameras.at(i).name),
                        state.cameras[i].reference_from_camera,
                        named.cameras[i].name == named.reference,
                        {}});
  for (std::size_t i = 0; i < state.imus.size(); ++i)
    sensors_.push_back({QString::fromStdString(named.imus.at(i).name),
                        state.imus[i].reference_from_imu,
                        named.imus[i].name == named.reference,
                        {}});
  const double length_m = axisLength_m();
  for (std::size_t i = 0; i < sensors_.size(); ++i)
    sensors_[i].outline_m = i < state.cameras.size()
                                ? cameraOutline(state.cameras[i].lens.inUse(), 0.7 * length_m)
                                : imuOutline(0.35 * length_m);
  if (!state.cameras.empty())
    reference_from_world_ = state.cameras.front().reference_from_camera.rotation.toRotationMatrix();
  setAccessibleName(tr("Drawing of the rig"));
  setAccessibleDescription(text());
  update();
}

QString RigDrawing::text() const {
  QStringList sentences;
  const auto reference =
      std::find_if(sensors_.begin(), sensors_.end(), [](const Sensor& sensor) { return sensor.reference; });
  for (const Sensor& sensor : sensors_) {
    if (sensor.reference || reference == sensors_.end()) continue;
    sentences << tr("%1 is %2 from %3")
                     .arg(sensor.name, millimetres(sensor.reference_from_sensor.translation_m.norm()),
                          reference->name);
  }
  return sentences.join("; ");
}

double RigDrawing::axisLength_m() const {
  constexpr double kShare = 0.4;
  double extent_m = kMinExtent_m;
  for (const Sensor& sensor : sensors_)
    extent_m = std::max(extent_m, sensor.reference_from_sensor.translation_m.norm());
  return kShare * extent_m;
}

RigDrawing::View RigDrawing::view(const QSizeF& size) const {
  constexpr double kMargin_px = 46.0;  // for letters, names and the scale
  Vector3d low = Vector3d::Zero(), high = Vector3d::Zero();
  for (const Sensor& sensor : sensors_) {
    low = low.cwiseMin(sensor.reference_from_sensor.translation_m);
    high = high.cwiseMax(sensor.reference_from_sensor.translation_m);
  }
  // Axes of a camera: x right, y down, z away.
  const Eigen::Matrix3d turned = (Eigen::AngleAxisd(elevation_rad_, Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(azimuth_rad_, Vector3d::UnitY()))
                                     .toRotationMatrix();
  const double radius_m = 0.5 * (high - low).norm() + axisLength_m();
  return {turned * reference_from_world_.transpose(),
          0.5 * (low + high),
          {0.5 * size.width(), 0.5 * size.height() - 8.0},
          std::max(1.0, 0.5 * std::min(size.width(), size.height()) - kMargin_px * 0.5) / radius_m};
}

void RigDrawing::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  paint(painter, size());
  if (!hasFocus()) return;
  painter.setBrush(Qt::NoBrush);
  painter.setPen(theme().accent);
  painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 6, 6);
}

void RigDrawing::paint(QPainter& painter, const QSizeF& size) const {
  painter.fillRect(QRectF(QPointF(), size), theme().panel);
  if (sensors_.empty()) return;
  painter.setRenderHint(QPainter::Antialiasing);
  const View from = view(size);
  paintDistances(painter, from);
  // Painted from back to front.
  std::vector<const Sensor*> sensors;
  for (const Sensor& sensor : sensors_) sensors.push_back(&sensor);
  const auto depth = [&](const Sensor* sensor) {
    return (from.screen_from_reference * sensor->reference_from_sensor.translation_m).z();
  };
  std::sort(sensors.begin(), sensors.end(),
            [&](const Sensor* a, const Sensor* b) { return depth(a) > depth(b); });
  for (const Sensor* const sensor : sensors) paintSensor(painter, from, *sensor);
  paintScale(painter, from, size);
  for (const Label& label : labels(size)) {
    if (!label.letter) painter.fillRect(label.place, theme().panel);  // lines do not cross it
    painter.setFont(label.name ? boldOf(font()) : font());
    painter.setPen(label.colour);
    painter.drawText(label.place, Qt::AlignCenter | Qt::TextDontClip, label.text);
  }
  painter.setFont(font());
}

// Letters of short axes would overlap.
void RigDrawing::addLetters(const View& view, const Sensor& sensor, std::vector<Label>& labels) const {
  constexpr double kMinAxis_px = 12.0, kBeyond = 1.14, kBox_px = 14.0;
  const double length_m = axisLength_m();
  const QPointF origin = view(sensor.reference_from_sensor.translation_m);
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = [&](double share) {
      return view(sensor.reference_from_sensor * Vector3d(share * length_m * Vector3d::Unit(axis)));
    };
    if (QLineF(origin, at(1.0)).length() < kMinAxis_px) continue;
    QRectF place(0.0, 0.0, kBox_px, kBox_px);
    place.moveCenter(at(kBeyond));
    labels.push_back(
        {QString(QChar("xyz"[axis])), place, false, true, theme().axes[static_cast<std::size_t>(axis)]});
  }
}

std::vector<RigDrawing::Label> RigDrawing::labels(const QSizeF& size) const {
  constexpr double kMinLine_px = 24.0, kScale_px = 26.0;
  const View from = view(size);
  std::vector<Label> all;
  for (const Sensor& sensor : sensors_) addLetters(from, sensor, all);
  LabelPlaces places(QRectF(QPointF(), size).adjusted(2.0, 2.0, -2.0, -2.0));
  places.occupy(QRectF(0.0, size.height() - kScale_px, 0.5 * size.width(), kScale_px));
  for (const Label& letter : all) places.occupy(letter.place);
  const double length_m = axisLength_m();
  for (const Sensor& sensor : sensors_) {
    const QPointF origin = from(sensor.reference_from_sensor.translation_m);
    double tips = 0.0;  // positive if the axes point down on average
    for (int axis = 0; axis < 3; ++axis)
      tips += from(sensor.reference_from_sensor * Vector3d(length_m * Vector3d::Unit(axis))).y() - origin.y();
    const QString name = sensor.reference ? tr("%1 (reference)").arg(sensor.name) : sensor.name;
    const QSizeF needed = sizeOf(name, boldOf(font()));
    all.push_back(
        {name, places.place(needed, around(origin, needed, tips <= 0.0)), true, false, theme().text});
  }
  for (const Sensor& sensor : sensors_) {
    if (sensor.reference) continue;
    const QPointF origin = from(Vector3d::Zero()), end = from(sensor.reference_from_sensor.translation_m);
    if (QLineF(origin, end).length() < kMinLine_px) continue;
    const QString text = millimetres(sensor.reference_from_sensor.translation_m.norm());
    const QSizeF needed = sizeOf(text, font());
    std::vector<QPointF> middles = along(origin, end);
    for (const bool below : {true, false})
      for (const QPointF& middle : around(0.5 * (origin + end), needed, below)) middles.push_back(middle);
    all.push_back({text, places.place(needed, middles), false, false, theme().text});
  }
  // If both do not fit, the letter is dropped.
  std::erase_if(all, [&](const Label& letter) {
    return letter.letter && std::any_of(all.begin(), all.end(), [&](const Label& other) {
             return !other.letter && other.place.intersects(letter.place);
           });
  });
  return all;
}

void RigDrawing::paintDistances(QPainter& painter, const View& view) const {
  painter.setPen(QPen(theme().faint_text, 1.2, Qt::DashLine));
  for (const Sensor& sensor : sensors_)
    if (!sensor.reference)
      painter.drawLine(view(Vector3d::Zero()), view(sensor.reference_from_sensor.translation_m));
}

void RigDrawing::paintSensor(QPainter& painter, const View& view, const Sensor& sensor) const {
  const auto at = [&](const Vector3d& in_sensor_m) {
    return view(sensor.reference_from_sensor * in_sensor_m);
  };
  painter.setPen(QPen(theme().faint_text, 1.2));
  for (std::size_t k = 0; k + 1 < sensor.outline_m.size(); k += 2)
    painter.drawLine(at(sensor.outline_m[k]), at(sensor.outline_m[k + 1]));
  const QPointF origin = at(Vector3d::Zero());
  for (int axis = 0; axis < 3; ++axis) {
    painter.setPen(QPen(theme().axes[static_cast<std::size_t>(axis)], 2.2, Qt::SolidLine, Qt::RoundCap));
    painter.drawLine(origin, at(axisLength_m() * Vector3d::Unit(axis)));
  }
  painter.setPen(Qt::NoPen);
  painter.setBrush(theme().text);
  painter.drawEllipse(origin, 2.5, 2.5);
}

void RigDrawing::paintScale(QPainter& painter, const View& view, const QSizeF& size) const {
  constexpr double kShare = 0.25, kInset_px = 10.0, kTick_px = 4.0;
  const double length_m = roundedDown(kShare * size.width() / view.px_per_m);
  const QPointF left(kInset_px, size.height() - kInset_px);
  const QPointF right = left + QPointF(view.px_per_m * length_m, 0.0);
  painter.setPen(QPen(theme().text, 1.5));
  painter.drawLine(left, right);
  for (const QPointF& end : {left, right}) painter.drawLine(end, end - QPointF(0.0, kTick_px));
  const QString text = tr("%1 mm").arg(kMillimetresPerMetre * length_m, 0, 'g', 3);
  painter.drawText(right + QPointF(6.0, 3.0), text);
}

void RigDrawing::look(double azimuth_rad, double elevation_rad) {
  azimuth_rad_ = std::remainder(azimuth_rad, 2.0 * M_PI);
  elevation_rad_ = std::clamp(elevation_rad, -M_PI_2, M_PI_2);
  update();
}

void RigDrawing::mousePressEvent(QMouseEvent* event) {
  last_at_ = event->position();
}

void RigDrawing::mouseMoveEvent(QMouseEvent* event) {
  if (!event->buttons().testFlag(Qt::LeftButton)) return;
  const QPointF step = event->position() - last_at_;
  last_at_ = event->position();
  look(azimuth_rad_ - kTurn_rad_per_px * step.x(), elevation_rad_ + kTurn_rad_per_px * step.y());
}

void RigDrawing::keyPressEvent(QKeyEvent* event) {
  switch (event->key()) {
    case Qt::Key_Left:
    case Qt::Key_Right:
      return look(azimuth_rad_ + (event->key() == Qt::Key_Left ? 1.0 : -1.0) * kTurn_rad_per_key,
                  elevation_rad_);
    case Qt::Key_Up:
    case Qt::Key_Down:
      return look(azimuth_rad_,
                  elevation_rad_ + (event->key() == Qt::Key_Up ? 1.0 : -1.0) * kTurn_rad_per_key);
    case Qt::Key_Home:
      return look(kHomeAzimuth_rad, kHomeElevation_rad);
    case Qt::Key_1:
      return look(0.0, 0.0);
    case Qt::Key_2:
      return look(M_PI_2, 0.0);
    case Qt::Key_3:
      return look(0.0, M_PI_2);
    default:
      QWidget::keyPressEvent(event);
  }
}

void RigDrawing::contextMenuEvent(QContextMenuEvent* event) {
  auto* const menu = new QMenu(this);
  menu->setAttribute(Qt::WA_DeleteOnClose);
  menu->addAction(tr("&Front (1)"), this, [this] { look(0.0, 0.0); });
  menu->addAction(tr("&Side (2)"), this, [this] { look(M_PI_2, 0.0); });
  menu->addAction(tr("&Top (3)"), this, [this] { look(0.0, M_PI_2); });
  menu->addAction(tr("&Initial view (Home)"), this, [this] { look(kHomeAzimuth_rad, kHomeElevation_rad); });
  menu->addSeparator();
  menu->addAction(icon("save"), tr("Save &picture (PNG, SVG, PDF)..."), this, &RigDrawing::save);
  menu->popup(event->globalPos());
}

void RigDrawing::save() {
  constexpr double kPictureScale = 2.0;
  saver_->askAndSave(tr("Save the drawing of the rig"), "rig",
                     pictureForms(size(), kPictureScale, [this](QPaintDevice& device) {
                       QPainter painter(&device);
                       painter.setFont(font());
                       paint(painter, size());
                     }));
}

namespace {

double areaOf(const QRectF& place) {
  return place.width() * place.height();
}

}  // namespace

// Area outside counts like overlap with another text.
double LabelPlaces::covered(const QRectF& place) const {
  double sum = areaOf(place) - areaOf(place.intersected(area_));
  for (const QRectF& other : taken_) sum += areaOf(place.intersected(other));
  return sum;
}

QRectF LabelPlaces::place(const QSizeF& size, const std::vector<QPointF>& middles) {
  QRectF best;
  double least = -1.0;
  for (const QPointF& middle : middles) {
    QRectF candidate(QPointF(), size);
    candidate.moveCenter(middle);
    const double covers = covered(candidate);
    if (least >= 0.0 && covers >= least) continue;
    least = covers;
    best = candidate;
    if (least <= 0.0) break;
  }
  occupy(best);
  return best;
}

}  // namespace evical::ui
