#include "tests/support/perturbing.h"

#include "core/geometry/camera_model.h"
#include "core/numerics/angles.h"
#include "core/synthetic/sinusoid_motion.h"
#include "tests/support/seen_through.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical::test {
namespace {

// Sets the session's lens; circles are then those that the front end sees through it.
template <class Change>
void changeLens(Recorded& recorded, Change&& change) {
  for (std::size_t k = 0; k < recorded.detections.cameras.size(); ++k) {
    const CameraIntrinsics truth = *recorded.detections.lenses[k].detection_intrinsics;
    CameraIntrinsics said = truth;
    change(said);
    recorded.session.cameras[k].intrinsics = said;
    recorded.detections.lenses[k] = givenLens(said);
    seeThrough(truth, said, recorded.detections.cameras[k]);
  }
}

void focalLength(Recorded& recorded, double percent) {
  changeLens(recorded, [&](CameraIntrinsics& lens) { lens.focal_length_px *= 1.0 + 0.01 * percent; });
}
void focalLengthX(Recorded& recorded, double percent) {
  changeLens(recorded, [&](CameraIntrinsics& lens) { lens.focal_length_px.x() *= 1.0 + 0.01 * percent; });
}
void centre(Recorded& recorded, double shift_px) {
  changeLens(recorded, [&](CameraIntrinsics& lens) { lens.principal_point_px.x() += shift_px; });
}
void swappedCentre(Recorded& recorded, double) {
  changeLens(recorded, [](CameraIntrinsics& lens) {
    std::swap(lens.principal_point_px.x(), lens.principal_point_px.y());
  });
}
void distortion(Recorded& recorded, double share) {
  changeLens(recorded, [&](CameraIntrinsics& lens) {
    for (double& coefficient : lens.distortion) coefficient *= share;
  });
}

// The session assumes a lens of the other kind, with a focal length that fits in the image centre.
void otherModel(Recorded& recorded, double) {
  changeLens(recorded, [](CameraIntrinsics& lens) {
    lens.model = lens.model == CameraModel::PinholeRadtan ? CameraModel::PinholeEquidistant
                                                          : CameraModel::PinholeRadtan;
    lens.distortion = {};
  });
}

void shadeSwapped(Recorded& recorded, double) {
  CircleShade& shade = recorded.session.board.circles;
  shade = shade == CircleShade::Dark ? CircleShade::Bright : CircleShade::Dark;
}

// From 60 % of the recording on the camera has another orientation; truth is the first one.
void cameraMoved(Recorded& recorded, double angle_deg) {
  constexpr double kFrom = 0.6;
  const Eigen::Quaterniond turn(
      Eigen::AngleAxisd(kRadPerDeg * angle_deg, Eigen::Vector3d(1.0, 1.0, 0.0).normalized()));
  moveCircles(recorded, [&](const RigidTransform& camera_from_world, const Eigen::Vector3d& point_m,
                            const BoardView& view) {
    const Eigen::Vector3d in_camera_m = camera_from_world * point_m;
    const bool moved = view.time_s >= kFrom * recorded.scenario.duration_s;
    return std::pair<Eigen::Vector3d, Eigen::Vector3d>(
        in_camera_m, moved ? (turn.conjugate() * in_camera_m).eval() : in_camera_m);
  });
}

template <class Hidden>
void hide(Recorded& recorded, Hidden&& isHidden) {
  for (BoardObservations& observations : recorded.detections.cameras) {
    for (BoardView& view : observations.views)
      std::erase_if(view.circles, [&](const CircleObservation& circle) {
        return isHidden(view.time_s, recorded.scenario.board.point_m(circle.circle));
      });
    constexpr std::size_t kFewest = 6;
    std::erase_if(observations.views, [](const BoardView& view) { return view.circles.size() < kFewest; });
  }
}

// A hand that appears for one second in every two, each time elsewhere, and hides nearby circles.
void handOverBoard(Recorded& recorded, double share) {
  const Board& board = recorded.scenario.board;
  const Eigen::Vector2d far_m = board.point_m(board.pointCount() - 1);
  const double reach_m = share * far_m.norm();
  hide(recorded, [&](double time_s, const Eigen::Vector2d& circle_m) {
    const double turn = std::floor(0.5 * time_s);
    const Eigen::Vector2d hand_m = far_m.cwiseProduct(
        Eigen::Vector2d(0.5 + 0.5 * std::sin(2.0 * turn), 0.5 + 0.5 * std::sin(3.0 * turn)));
    return 0.5 * time_s - turn < 0.5 && (circle_m - hand_m).norm() < reach_m;
  });
}

void hiddenAtFirst(Recorded& recorded, double duration_s) {
  const Board& board = recorded.scenario.board;
  const double from_m = 2.0 / 3.0 * board.point_m(board.rows - 1, 0).y();
  hide(recorded, [&](double time_s, const Eigen::Vector2d& circle_m) {
    return time_s < duration_s && circle_m.y() > from_m;
  });
}

constexpr double kPriorSigma_deg = 0.05, kPriorSigma_ms = 0.1;

// The lens whose image is the mirror image of this one's.
CameraIntrinsics mirroredLens(Mirroring how, CameraIntrinsics lens) {
  lens.resolution_px = mirroredSize(how, lens.resolution_px);
  mirrorPoint(how, lens.resolution_px, lens.principal_point_px.x(), lens.principal_point_px.y());
  double &p1 = lens.distortion[2], &p2 = lens.distortion[3];  // tangential, of the model pinhole_radtan
  if (how == Mirroring::X) p2 = -p2;
  if (how == Mirroring::Y) p1 = -p1;
  if (how == Mirroring::Transposed) {
    std::swap(p1, p2);
    std::swap(lens.focal_length_px.x(), lens.focal_length_px.y());
  }
  return lens;
}

// The circle at whose place a mirror image of the board has this one. Asymmetric grids with an odd number of
// rows are their own mirror images with rows exchanged; given points are recognised from behind, too.
int mirroredCircle(const Board& board, int circle) {
  if (!board.hasPattern()) return circle;
  const int per_row = board.pointsInRow();
  return board.index(board.rows - 1 - circle / per_row, circle % per_row);
}

template <int kImage>
void imageMirrored(Recorded& recorded, double) {
  mirrorImage(static_cast<Mirroring>(kImage), 0, false, recorded.session, recorded.detections);
}

void wrongRotationPrior(Recorded& recorded, double sigmas) {
  const Eigen::Quaterniond truth = recorded.scenario.cameras.front().imu_from_camera.rotation;
  const double sigma_rad = kRadPerDeg * kPriorSigma_deg;
  const Eigen::Quaterniond error(Eigen::AngleAxisd(sigmas * sigma_rad, Eigen::Vector3d::UnitY()));
  recorded.session.cameras.front().prior.rotation =
      KnownRotation{truth * error, Eigen::Vector3d::Constant(sigma_rad)};
}
void wrongOffsetPrior(Recorded& recorded, double sigmas) {
  const SimulatedCamera& camera = recorded.scenario.cameras.front();
  recorded.session.cameras.front().prior.time_offset = KnownNumber{
      camera.time_offset_s - camera.pixel.delay_s() + 1e-3 * sigmas * kPriorSigma_ms, 1e-3 * kPriorSigma_ms};
}

}  // namespace

void mirrorImage(Mirroring how, std::size_t camera, bool same_lens, Session& session,
                 DetectionResult& detections) {
  BoardObservations& seen = detections.cameras[camera];
  const Board& board = session.boardOf(camera);
  const CameraIntrinsics lens = *detections.lenses[camera].detection_intrinsics;
  const CameraIntrinsics mirrored = mirroredLens(how, lens);
  if (board.hasTags()) seen.views.clear();
  Eigen::Matrix2d image = Eigen::Matrix2d::Identity();
  if (how == Mirroring::Transposed) image << 0.0, 1.0, 1.0, 0.0;
  if (how == Mirroring::X) image(0, 0) = -1.0;
  if (how == Mirroring::Y) image(1, 1) = -1.0;
  for (BoardView& view : seen.views) {
    for (CircleObservation& circle : view.circles) {
      circle.circle = mirroredCircle(board, circle.circle);
      mirrorPoint(how, mirrored.resolution_px, circle.centre_px.x(), circle.centre_px.y());
      circle.covariance_px2 = (image * circle.covariance_px2 * image.transpose()).eval();
      circle.velocity_px_s = (image * circle.velocity_px_s).eval();
      circle.edge_localisation_bias_effect = (image * circle.edge_localisation_bias_effect).eval();
    }
    std::ranges::sort(view.circles, {}, &CircleObservation::circle);
  }
  if (same_lens) return seeThrough(mirrored, lens, seen);
  detections.lenses[camera] = givenLens(mirrored);
  if (!detections.resolutions_px.empty()) detections.resolutions_px[camera] = mirrored.resolution_px;
  session.cameras[camera].resolution_px = mirrored.resolution_px;
  session.cameras[camera].intrinsics = mirrored;
}

std::vector<Perturbation> cameraPerturbations() {
  return {{"focal length", "%", {0.3, 1, 5, 100, -50}, {"lens", "focal", "intrinsics"}, focalLength},
          {"focal length x", "%", {0.3, 1, 3}, {"lens", "focal", "intrinsics"}, focalLengthX},
          {"centre", "px", {1, 2, 10}, {"lens", "principal", "intrinsics"}, centre},
          {"swapped centre", "", {1}, {"lens", "principal", "intrinsics"}, swappedCentre},
          {"distortion", "of truth", {0.9, 0.5, 0, -1}, {"lens", "distortion", "intrinsics"}, distortion},
          {"other lens model", "", {1}, {"lens", "model", "intrinsics", "focal_length"}, otherModel},
          {"dark for bright", "", {1}, {"dark", "bright"}, shadeSwapped, PerturbedStage::FrontEnd},
          {"camera moved", "deg", {0.2, 1, 5}, {"moved", "parts", "halves", "thirds"}, cameraMoved},
          {"hand over board", "of it", {0.1, 0.3, 0.5}, {}, handOverBoard},
          {"third hidden at first", "s", {1, 3, 5}, {}, hiddenAtFirst},
          {"image mirrored in x", "", {1}, {"mirror"}, imageMirrored<1>},
          {"image mirrored in y", "", {1}, {"mirror"}, imageMirrored<2>},
          {"image transposed", "", {1}, {"mirror"}, imageMirrored<3>},
          {"prior of rotation", "sigmas", {10, 20, 40}, {"prior"}, wrongRotationPrior},
          {"prior of time offset", "sigmas", {10, 20, 40}, {"prior"}, wrongOffsetPrior}};
}

}  // namespace evical::test
