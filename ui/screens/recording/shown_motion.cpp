// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/shown_motion.h"

#include "core/numerics/angles.h"

#include <QObject>

#include <algorithm>
#include <cmath>

namespace evical::ui {
namespace {

constexpr double kSwings = 3.0;  // to and fro in the ten seconds
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
// The board goes along the image's rim, once round.
RigidTransform intoCorners(double share) {
  constexpr double kAside_rad = 17.0 * kRadPerDeg, kUp_rad = 12.0 * kRadPerDeg;
  const double angle_rad = 2.0 * kPi * share;
  const auto squared = [](double value) { return std::clamp(1.4 * value, -1.0, 1.0); };
  return turned(Eigen::Vector3d::UnitY(), kAside_rad * squared(std::cos(angle_rad))) *
         turned(Eigen::Vector3d::UnitX(), kUp_rad * squared(std::sin(angle_rad)));
}
// As a recording is: all at once, none in step with another.
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
  const Eigen::Vector3d ahead(0.0, 0.0, 0.28), corner(0.066, -0.05, 0.1);
  static const std::vector<ShownMotion> all = {
      {"left_right", QObject::tr("Turn left and right"),
       QObject::tr("Turn the camera to the left and to the right, 20 degrees to either side, and back. Turns "
                   "show how the "
                   "camera and the IMU are rotated relative to each other, and how far they are apart."),
       &leftAndRight, ahead},
      {"up_down", QObject::tr("Turn up and down"),
       QObject::tr("Nod with the camera, up and down, while the board stays in view."), &upAndDown, ahead},
      {"about_lens", QObject::tr("Roll about the optical axis"),
       QObject::tr("Turn the camera as one turns a key, 30 degrees to either side. This turn is the one that "
                   "is forgotten "
                   "most, and nothing else stands in for it."),
       &aboutTheLens, corner},
      {"sideways",
       QObject::tr("Move left and right"),
       QObject::tr("Move the camera sideways, briskly: the accelerometer feels only changes of speed."),
       &sideways,
       {}},
      {"upwards", QObject::tr("Move up and down"), QObject::tr("The same up and down."), &upwards, {}},
      {"nearer",
       QObject::tr("Nearer and farther"),
       QObject::tr(
           "Go towards the board and back, between 0.4 and 1 m. Near, the board may reach beyond the image."),
       &nearer,
       {}},
      {"corners", QObject::tr("Into the corners"),
       QObject::tr(
           "Let the board go once round the image, into all corners: a lens is known only where circles "
           "were seen."),
       &intoCorners, ahead},
      {"together", QObject::tr("All at once"),
       QObject::tr(
           "Then record: 20 to 30 seconds of all of it, mixed. Circles should cross the image in a second or "
           "two, "
           "at 50 to 400 pixels a second. An event camera at rest sees nothing, so neither stills at the "
           "start nor at the end are needed. Light the board evenly, by daylight or a lamp that does not "
           "flicker, and keep what moves out of view."),
       &together, ahead}};
  return all;
}

}  // namespace evical::ui
