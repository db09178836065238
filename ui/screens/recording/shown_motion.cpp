// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/screens/recording/shown_motion.h"

#include "core/numerics/angles.h"
#include "core/pipeline/rig/recording_assessment.h"

#include <QObject>

#include <algorithm>
#include <cmath>

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
           "Move the board once around the image, into all corners: a lens is calibrated only where circles "
           "were seen."),
       &intoCorners, ahead},
      {"together", QObject::tr("All at once"),
       QObject::tr(
           "Now record 20 to 30 seconds of all these motions, mixed. Circles should cross the image in one "
           "or two seconds: the check rates a median of %1 to %2 pixels per second as good. An event camera "
           "at rest sees nothing, so pauses at the start or at the end are not needed. Light the board "
           "evenly, by daylight or a lamp that does not flicker, and keep moving objects out of view.")
           .arg(kGoodSpeed_px_s)
           .arg(kFastSpeed_px_s),
       &together, ahead}};
  return all;
}

}  // namespace evical::ui
