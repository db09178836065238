// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/motion_picture.h"

#include "core/geometry/board.h"
#include "core/numerics/angles.h"
#include "core/pipeline/rig/recording_assessment.h"
#include "ui/theme/theme.h"

#include <QObject>
#include <QPainter>
#include <QPolygonF>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace evical::ui {

namespace {

constexpr double kSwings = 3.0;  // in the ten seconds
constexpr double kTurn_rad = 20.0 * kRadPerDeg, kRoll_rad = 30.0 * kRadPerDeg;
constexpr double kShift_m = 0.13, kNearer_m = 0.2;

double swing(double share, double swings = kSwings) {
  return std::sin(2.0 * kPi * swings * share);
}

RigidTransform turned(const Eigen::Vector3d& axis, double angle_rad) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis)), Eigen::Vector3d::Zero()};
}

RigidTransform shifted(const Eigen::Vector3d& by_m) {
  return {Eigen::Quaterniond::Identity(), by_m};
}

RigidTransform leftAndRight(double share) {
  return turned(Eigen::Vector3d::UnitY(), kTurn_rad * swing(share));
}
RigidTransform upAndDown(double share) {
  return turned(Eigen::Vector3d::UnitX(), kTurn_rad * swing(share));
}
RigidTransform aboutTheLens(double share) {
  return turned(Eigen::Vector3d::UnitZ(), kRoll_rad * swing(share));
}
RigidTransform sideways(double share) {
  return shifted({kShift_m * swing(share), 0.0, 0.0});
}
RigidTransform upwards(double share) {
  return shifted({0.0, kShift_m * swing(share), 0.0});
}
RigidTransform nearer(double share) {
  return shifted({0.0, 0.0, kNearer_m * swing(share, 2.0)});
}
// The board moves once around the image's border.
RigidTransform intoCorners(double share) {
  constexpr double kAside_rad = 17.0 * kRadPerDeg, kUp_rad = 12.0 * kRadPerDeg;
  const double angle_rad = 2.0 * kPi * share;
  const auto squared = [](double value) { return std::clamp(1.4 * value, -1.0, 1.0); };
  return turned(Eigen::Vector3d::UnitY(), kAside_rad * squared(std::cos(angle_rad))) *
         turned(Eigen::Vector3d::UnitX(), kUp_rad * squared(std::sin(angle_rad)));
}
// Like a recording: all motions at once, with different periods.
RigidTransform together(double share) {
  RigidTransform pose = turned(Eigen::Vector3d::UnitY(), 0.7 * kTurn_rad * swing(share, 4.0)) *
                        turned(Eigen::Vector3d::UnitX(), 0.6 * kTurn_rad * swing(share + 0.05, 5.0)) *
                        turned(Eigen::Vector3d::UnitZ(), 0.7 * kRoll_rad * swing(share, 3.0));
  pose.translation_m = {0.6 * kShift_m * swing(share + 0.1, 3.0), 0.5 * kShift_m * swing(share, 4.0),
                        0.5 * kNearer_m * swing(share, 2.0)};
  return pose;
}

}  // namespace

const std::vector<ShownMotion>& shownMotions() {
  const Eigen::Vector3d lens(0.0, 0.0, 0.0), ahead(0.0, 0.0, 0.28), corner(0.066, -0.05, 0.1);
  static const std::vector<ShownMotion> all = {
      {"left_right", QObject::tr("Turn left and right"),
       QObject::tr("Turn the camera to the left and to the right, 20 degrees to either side, and back. "
                   "Rotations "
                   "determine the rotation between camera and IMU, and the translation between them."),
       &leftAndRight, ahead},
      {"up_down", QObject::tr("Turn up and down"),
       QObject::tr("Nod with the camera, up and down, while the board stays in view."), &upAndDown, ahead},
      {"about_lens", QObject::tr("Roll about the optical axis"),
       QObject::tr("Turn the camera like a key, 30 degrees to either side. This rotation is "
                   "forgotten "
                   "most often, and no other motion replaces it."),
       &aboutTheLens, corner},
      {"sideways", QObject::tr("Move left and right"),
       QObject::tr("Move the camera sideways, briskly: the accelerometer measures only changes of speed."),
       &sideways, lens},
      {"upwards", QObject::tr("Move up and down"),
       QObject::tr("Move the camera up and down, just as briskly."), &upwards, lens},
      {"nearer", QObject::tr("Nearer and farther"),
       QObject::tr(
           "Move towards the board and back, between 0.4 and 1 m. Up close, the board may exceed the image."),
       &nearer, lens},
      {"corners", QObject::tr("Into the corners"),
       QObject::tr(
           "Move the board once around the image, into all corners: a lens is calibrated only where points "
           "were seen."),
       &intoCorners, ahead},
      {"together", QObject::tr("All at once"),
       QObject::tr(
           "Now record 20 to 30 seconds of all these motions, mixed. The board should cross the image in one "
           "or two seconds: the check rates a median of %1 to %2 pixels per second as good. An event camera "
           "at rest sees nothing, so pauses at the start or at the end are not needed. Light the board "
           "evenly, by daylight or a lamp that does not flicker, and keep moving objects out of view.")
           .arg(kGoodSpeed_px_s)
           .arg(kFastSpeed_px_s),
       &together, ahead}};
  return all;
}

namespace {

constexpr int kFrame_ms = 40;
constexpr double kFocal_px = 262.0, kWidth_px = 346.0, kHeight_px = 260.0;  // of the drawn camera

Board shownBoard() {
  Board board;
  board.spacing_m = 0.035;
  board.radius_m = 0.013;
  return board;
}

// The board's long side is parallel to the image's.
Eigen::Vector3d onBoard(const Board& board, const Eigen::Vector2d& point_m) {
  const Eigen::Vector2d from_middle_m = point_m - 0.5 * board.extent_m();
  return {from_middle_m.y(), -from_middle_m.x(), kShownDistance_m};
}

using FourPoints = std::array<Eigen::Vector3d, 4>;

// Pinhole view of the scene.
struct Looker {
  RigidTransform looker_from_world;
  double focal_px = 1.0;
  QPointF middle;

  QPointF project(const Eigen::Vector3d& point_m) const {
    const Eigen::Vector3d seen = looker_from_world * point_m;
    return middle + focal_px / std::max(seen.z(), 0.05) * QPointF(seen.x(), seen.y());
  }
  QPolygonF project(const FourPoints& points_m) const {
    QPolygonF seen;
    for (const Eigen::Vector3d& point_m : points_m) seen << project(point_m);
    return seen;
  }
};

// Camera body and field of view, as drawn.
constexpr double kSight_m = 0.1, kBody_m = 0.03, kBodyDepth_m = 0.04;

// Corners of a rectangle that faces the optical axis.
FourPoints rectangle(double x, double y, double z) {
  return {{{-x, -y, z}, {x, -y, z}, {x, y, z}, {-x, y, z}}};
}
FourPoints sightEnd() {
  return rectangle(0.5 * kWidth_px / kFocal_px * kSight_m, 0.5 * kHeight_px / kFocal_px * kSight_m, kSight_m);
}
FourPoints boardOutline(const Board& board) {
  constexpr double kAround_m = 0.03;
  const Eigen::Vector2d low = Eigen::Vector2d::Constant(-kAround_m), high = board.extent_m() - low;
  return {{onBoard(board, low), onBoard(board, {high.x(), low.y()}), onBoard(board, high),
           onBoard(board, {low.x(), high.y()})}};
}

// Area that board, camera and arrows need during all motions: the picture does not jump from one to the next.
QRectF neededArea(const Looker& looker) {
  constexpr int kSteps = 40;
  QPolygonF seen;
  for (const Eigen::Vector3d& point : boardOutline(shownBoard())) seen << looker.project(point);
  for (const ShownMotion& motion : shownMotions())
    for (int i = 0; i < kSteps; ++i) {
      const RigidTransform pose = motion.world_from_camera(static_cast<double>(i) / kSteps);
      for (const FourPoints& points : {sightEnd(), rectangle(kBody_m, kBody_m, -kBodyDepth_m)})
        for (const Eigen::Vector3d& point : points) seen << looker.project(pose * point);
      seen << looker.project(pose * motion.followed);
    }
  return seen.boundingRect();
}

// From behind and above, to the left of the person with the camera. All motions fit into the box.
Looker looksOver(const QRectF& box) {
  constexpr double kShare = 0.94;  // of the box: arrowheads and thick lines need some
  const Eigen::Vector3d eye(-0.6, -0.62, -0.62), at(0.02, 0.0, 0.32);
  const Eigen::Vector3d ahead = (at - eye).normalized();
  const Eigen::Vector3d right = Eigen::Vector3d::UnitY().cross(ahead).normalized();
  Eigen::Matrix3d rows;
  rows << right.transpose(), ahead.cross(right).transpose(), ahead.transpose();
  const Eigen::Quaterniond rotation(rows);
  Looker looker{{rotation, -(rotation * eye)}, 1.0, {}};
  static const QRectF needed = neededArea(looker);
  looker.focal_px = kShare * std::min(box.width() / needed.width(), box.height() / needed.height());
  looker.middle = box.center() - looker.focal_px * needed.center();
  return looker;
}

void paintArrowHead(QPainter& painter, QPointF tip, QPointF from) {
  constexpr double kHead_px = 9.0, kHalfWidth = 0.5;
  const QPointF way = tip - from;
  const double length = std::hypot(way.x(), way.y());
  if (length < 1e-6) return;
  const QPointF along = kHead_px / length * way, across(-along.y(), along.x());
  painter.drawPolygon(QPolygonF{tip, tip - along + kHalfWidth * across, tip - along - kHalfWidth * across});
}

// Path of the followed point, with an arrowhead at each end.
void paintWay(QPainter& painter, const Looker& looker, const ShownMotion& motion) {
  constexpr int kSteps = 240;
  QPolygonF way;
  for (int i = 0; i <= kSteps; ++i)
    way << looker.project(motion.world_from_camera(static_cast<double>(i) / kSteps) * motion.followed);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(theme().accent, 2.5));
  painter.drawPolyline(way);
  painter.setPen(Qt::NoPen);
  painter.setBrush(theme().accent);
  // The ends are the two points that are furthest apart.
  qsizetype first = 0, last = 0;
  const auto far = [&](qsizetype a, qsizetype b) {
    return std::hypot(way[a].x() - way[b].x(), way[a].y() - way[b].y());
  };
  for (qsizetype i = 0; i < way.size(); ++i)
    if (far(i, way.size() / 4) > far(last, way.size() / 4)) last = i;
  for (qsizetype i = 0; i < way.size(); ++i)
    if (far(i, last) > far(first, last)) first = i;
  const auto before = [&](qsizetype end) {
    constexpr qsizetype kBack = 12;
    return way[end >= kBack ? end - kBack : end + kBack];
  };
  paintArrowHead(painter, way[first], before(first));
  paintArrowHead(painter, way[last], before(last));
}

void paintBoard(QPainter& painter, const Looker& looker) {
  const Board board = shownBoard();
  painter.setPen(QPen(theme().grid_line, 1.0));
  painter.setBrush(Qt::white);
  painter.drawPolygon(looker.project(boardOutline(board)));
  painter.setPen(Qt::NoPen);
  painter.setBrush(Qt::black);
  constexpr int kCorners = 16;
  for (const Eigen::Vector2d& centre_m : boardPoints_m(board)) {
    QPolygonF circle;
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2.0 * M_PI * i / kCorners;
      circle << looker.project(
          onBoard(board, centre_m + board.radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle))));
    }
    painter.drawPolygon(circle);
  }
}

void paintCamera(QPainter& painter, const Looker& looker, const RigidTransform& world_from_camera,
                 double opacity) {
  const auto at = [&](FourPoints points) {
    for (Eigen::Vector3d& point : points) point = world_from_camera * point;
    return looker.project(points);
  };
  const QPolygonF front = at(sightEnd()), back = at(rectangle(kBody_m, kBody_m, -kBodyDepth_m)),
                  face = at(rectangle(kBody_m, kBody_m, 0.0));
  painter.save();
  painter.setOpacity(opacity);
  painter.setPen(QPen(theme().text, 1.5));
  painter.setBrush(theme().panel);
  painter.drawPolygon(face);
  for (int i = 0; i < 4; ++i)
    painter.drawPolygon(QPolygonF{back[i], back[(i + 1) % 4], face[(i + 1) % 4], face[i]});
  painter.drawPolygon(back);
  QColor sight = theme().accent;
  sight.setAlphaF(0.18F);
  painter.setBrush(sight);
  painter.setPen(QPen(theme().accent, 1.5));
  const QPointF centre = looker.project(world_from_camera.translation_m);
  for (int i = 0; i < 4; ++i) painter.drawPolygon(QPolygonF{centre, front[i], front[(i + 1) % 4]});
  // Upper edge, which makes rotations about the optical axis visible.
  painter.setPen(QPen(theme().warning, 3.0));
  painter.drawLine(front[0], front[1]);
  painter.restore();
}

Looker cameraAt(const RigidTransform& world_from_camera, const QRectF& image) {
  return {inverse(world_from_camera), kFocal_px * image.width() / kWidth_px, image.center()};
}

// Median image speed of the circles, for a sensor of 346 x 260 pixels.
double speed_px_s(const ShownMotion& motion, double share) {
  constexpr double kStep_s = 0.02;
  const QRectF sensor(0.0, 0.0, kWidth_px, kHeight_px);
  const Looker now = cameraAt(motion.world_from_camera(share), sensor),
               soon = cameraAt(motion.world_from_camera(share + kStep_s / kShownMotion_s), sensor);
  const Board board = shownBoard();
  std::vector<double> speeds;
  for (const Eigen::Vector2d& centre_m : boardPoints_m(board)) {
    const QPointF way = soon.project(onBoard(board, centre_m)) - now.project(onBoard(board, centre_m));
    speeds.push_back(std::hypot(way.x(), way.y()) / kStep_s);
  }
  std::nth_element(speeds.begin(), speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2),
                   speeds.end());
  return speeds[speeds.size() / 2];
}

}  // namespace

MotionPicture::MotionPicture(QWidget* parent) : QWidget(parent), motion_(shownMotions().front()) {
  setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
  timer_.setInterval(kFrame_ms);
  connect(&timer_, &QTimer::timeout, this, &MotionPicture::tick);
}

void MotionPicture::setMotion(const ShownMotion& motion) {
  motion_ = motion;
  setAccessibleName(motion.title);
  setAccessibleDescription(motion.words);
  setShare(0.0);
}

void MotionPicture::setShare(double share) {
  share_ = share - std::floor(share);
  update();
}

void MotionPicture::setPlaying(bool playing) {
  wanted_ = playing;
  since_tick_.start();
  playing&& isVisible() ? timer_.start() : timer_.stop();
}

void MotionPicture::showEvent(QShowEvent*) {
  setPlaying(wanted_);
}

void MotionPicture::hideEvent(QHideEvent*) {
  timer_.stop();
}

void MotionPicture::tick() {
  setShare(share_ + 1e-3 * static_cast<double>(since_tick_.restart()) / kShownMotion_s);
}

void MotionPicture::paintEvent(QPaintEvent*) {
  constexpr double kGap_px = 10.0, kCaption_px = 24.0;
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  if (scene_only_) return paintScene(painter, rect());
  const double column = 0.5 * (width() - kGap_px);
  const QRectF left(0.0, 0.0, column, height()), right(column + kGap_px, 0.0, column, height());
  for (const QRectF& box : {left, right}) {
    painter.setPen(QPen(theme().grid_line, 1.0));
    painter.setBrush(theme().panel);
    painter.drawRoundedRect(box.adjusted(0.5, 0.5, -0.5, -0.5), 8.0, 8.0);
  }
  paintScene(painter, left.adjusted(6.0, 6.0, -6.0, -kCaption_px));
  paintCaption(painter, left, tr("Motion"));
  paintView(painter, right.adjusted(8.0, 8.0, -8.0, -kCaption_px - 2.0));
  // In steps of ten: finer digits would change too fast to read.
  const int speed = 10 * static_cast<int>(std::lround(0.1 * speed_px_s(motion_, share_)));
  paintCaption(painter, right,
               playing() ? tr("Camera image: %1 px/s (good median: %2 to %3)")
                               .arg(speed)
                               .arg(kGoodSpeed_px_s)
                               .arg(kFastSpeed_px_s)
                         : tr("Camera image"));
}

void MotionPicture::paintCaption(QPainter& painter, const QRectF& box, const QString& text) const {
  painter.setPen(theme().faint_text);
  const QRectF place = box.adjusted(8.0, 0.0, -8.0, -5.0);
  painter.drawText(place, Qt::AlignHCenter | Qt::AlignBottom,
                   painter.fontMetrics().elidedText(text, Qt::ElideRight, static_cast<int>(place.width())));
}

void MotionPicture::paintScene(QPainter& painter, const QRectF& box) const {
  painter.save();
  painter.setClipRect(box);
  const Looker looker = looksOver(box);
  paintBoard(painter, looker);
  paintCamera(painter, looker, motion_.world_from_camera(share_), 1.0);
  paintWay(painter, looker, motion_);
  painter.restore();
}

void MotionPicture::paintView(QPainter& painter, const QRectF& box) const {
  const double scale = std::min(box.width() / kWidth_px, box.height() / kHeight_px);
  QRectF image(0.0, 0.0, scale * kWidth_px, scale * kHeight_px);
  image.moveCenter(box.center());
  painter.save();
  painter.setClipRect(image);
  painter.fillRect(image, theme().window);
  paintBoard(painter, cameraAt(motion_.world_from_camera(share_), image));
  painter.restore();
  painter.setBrush(Qt::NoBrush);
  painter.setPen(QPen(theme().accent, 1.5));
  painter.drawRect(image);
}

}  // namespace evical::ui
