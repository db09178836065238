#include "core/initialisation/camera_poses.h"

#include "core/geometry/camera_model.h"
#include "core/geometry/circle_conic.h"
#include "core/geometry/so3.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace evical {
namespace {

constexpr std::size_t kMinCircles = 4;
constexpr double kNoFit_px = 1e9;

using Points = std::vector<std::pair<int, Eigen::Vector2d>>;  // board circle, ideal pixel

Points atOneTime(const BoardView& view) {
  Points points;
  for (const CircleObservation& circle : view.circles) {
    points.emplace_back(circle.circle,
                        circle.centre_px + circle.velocity_px_s * (view.time_s - circle.time_s));
  }
  return points;
}

// Gauss-Newton on the ellipses' centres; returns the RMS error in pixels, per circle.
double refine(const Points& points, const CameraIntrinsics& camera, const Board& board,
              RigidTransform& camera_from_board) {
  constexpr int kIterations = 8;
  constexpr double kConverged = 1e-5;  // rad, m: a hundredth of the effect of noise
  double rms = kNoFit_px;
  for (int iteration = 0; iteration <= kIterations; ++iteration) {
    Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> vector = Eigen::Matrix<double, 6, 1>::Zero();
    double squares = 0.0;
    for (const auto& [circle, pixel] : points) {
      Eigen::Matrix<double, 2, 6> jacobian;
      const auto centre =
          projectedCircleCentre(camera, camera_from_board, board.point_m(circle), board.radius_m, &jacobian);
      if (!centre) return kNoFit_px;
      const Eigen::Vector2d error = *centre - pixel;
      matrix += jacobian.transpose() * jacobian;
      vector -= jacobian.transpose() * error;
      squares += error.squaredNorm();
    }
    rms = std::sqrt(squares / static_cast<double>(points.size()));
    if (iteration == kIterations) break;
    const Eigen::Matrix<double, 6, 1> step = matrix.ldlt().solve(vector);
    if (!step.allFinite()) return kNoFit_px;
    camera_from_board.rotation = (camera_from_board.rotation * quaternionExp(step.head<3>())).normalized();
    camera_from_board.translation_m += step.tail<3>();
    if (step.lpNorm<Eigen::Infinity>() < kConverged) break;
  }
  return rms;
}

std::vector<std::pair<double, RigidTransform>> planarPoses(const Points& points,
                                                           const CameraIntrinsics& camera,
                                                           const Board& board) {
  std::vector<cv::Point3d> on_board;
  std::vector<cv::Point2d> rays;
  for (const auto& [circle, pixel] : points) {
    const Eigen::Vector2d centre = board.point_m(circle);
    on_board.emplace_back(centre.x(), centre.y(), 0.0);
    const Eigen::Vector2d ray =
        (pixel - camera.principal_point_px).cwiseQuotient(idealFocalLength_px(camera));
    rays.emplace_back(ray.x(), ray.y());
  }
  std::vector<cv::Mat> rotations, translations;
  try {
    cv::solvePnPGeneric(on_board, rays, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations, translations,
                        false, cv::SOLVEPNP_IPPE);
  } catch (const cv::Exception&) {
    return {};  // degenerate points: no pose for this view
  }
  std::vector<std::pair<double, RigidTransform>> poses;
  for (std::size_t k = 0; k < rotations.size(); ++k) {
    const double* const r = rotations[k].ptr<double>();
    const double* const t = translations[k].ptr<double>();
    RigidTransform camera_from_board{quaternionExp({r[0], r[1], r[2]}), {t[0], t[1], t[2]}};
    const double rms = refine(points, camera, board, camera_from_board);
    poses.emplace_back(rms, camera_from_board);
  }
  std::sort(poses.begin(), poses.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return poses;
}

// Difference of the rotation's magnitude from a neighbouring pose from the gyroscope's.
double disagreement(const RigidTransform& pose, double time_s, const CameraPose& neighbour,
                    const GyroRotation& gyro, double time_offset_s) {
  const double seen = rotationAngleBetween_rad(pose.rotation, neighbour.world_from_camera.rotation);
  const double felt = gyro.between(time_s + time_offset_s, neighbour.time_s + time_offset_s).norm();
  return std::abs(seen - felt);
}

}  // namespace

CameraPoses estimateCameraPoses(const CameraData& camera, const Board& board,
                                const InitialisationOptions& options, const RunContext& context) {
  CameraPoses result;
  std::vector<double> errors_px;
  for (std::size_t v = 0; v < camera.observations.views.size(); ++v) {
    context.throwIfStopped();
    const BoardView& view = camera.observations.views[v];
    if (view.circles.size() < kMinCircles) continue;
    const auto found = planarPoses(atOneTime(view), *camera.lens.detection_intrinsics, board);
    if (!found.empty()) errors_px.push_back(found.front().first);
    if (found.empty() || !(found.front().first <= options.max_reprojection_px)) {
      ++result.rejected;
      continue;
    }
    CameraPose pose;
    pose.time_s = view.time_s;
    pose.world_from_camera = inverse(found.front().second);
    pose.reprojection_px = found.front().first;
    pose.view = v;
    if (found.size() > 1 &&
        found[1].first < options.ambiguous_pose_ratio * found[0].first + options.ambiguous_pose_px &&
        rotationAngleBetween_rad(found[0].second.rotation, found[1].second.rotation) > 1e-3) {
      pose.other_world_from_camera = inverse(found[1].second);
    }
    result.poses.push_back(pose);
  }
  result.median_reprojection_px = medianOf(std::move(errors_px), result.median_reprojection_px);
  return result;
}

int resolveAmbiguousPoses(std::vector<CameraPose>& poses, const GyroRotation& gyro, double time_offset_s,
                          double max_pair_s) {
  int swapped = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    CameraPose& pose = poses[k];
    if (!pose.other_world_from_camera) continue;
    double kept = 0.0, other = 0.0;
    for (const std::size_t n : {k - 1, k + 1}) {
      if (n >= poses.size() || std::abs(poses[n].time_s - pose.time_s) > max_pair_s) continue;
      if (poses[n].other_world_from_camera && n > k) continue;  // not yet resolved
      kept += disagreement(pose.world_from_camera, pose.time_s, poses[n], gyro, time_offset_s);
      other += disagreement(*pose.other_world_from_camera, pose.time_s, poses[n], gyro, time_offset_s);
    }
    if (other < 0.5 * kept) {
      std::swap(pose.world_from_camera, *pose.other_world_from_camera);
      ++swapped;
    }
  }
  return swapped;
}

double PoseSpread::between2(const RigidTransform& a, const RigidTransform& b) const {
  return squared(rotationAngleBetween_rad(a.rotation, b.rotation),
                 (a.translation_m - b.translation_m).norm());
}

MeanPose meanPose(std::span<const RigidTransform> poses, const RigidTransform& start,
                  const PoseSpread& spread, int rounds) {
  MeanPose result;
  result.mean = start;
  RigidTransform& mean = result.mean;
  for (int round = 0; round < rounds; ++round) {
    Eigen::Vector3d turn = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero();
    double weights = 0.0, turns2 = 0.0, shifts2 = 0.0;
    int near = 0;
    for (const RigidTransform& pose : poses) {
      const Eigen::Vector3d angle = quaternionLog(mean.rotation.conjugate() * pose.rotation),
                            way = pose.translation_m - mean.translation_m;
      const double weight = cauchyWeight(spread.squared(angle.norm(), way.norm()));
      near += weight > 0.5;
      turn += weight * angle;
      shift += weight * way;
      weights += weight;
      turns2 += weight * angle.squaredNorm();
      shifts2 += weight * way.squaredNorm();
    }
    mean.rotation = (mean.rotation * quaternionExp(turn / weights)).normalized();
    mean.translation_m += shift / weights;
    result.agreeing = static_cast<double>(near) / static_cast<double>(poses.size());
    result.rotation_rms_rad = std::sqrt(turns2 / weights);
    result.position_rms_m = std::sqrt(shifts2 / weights);
  }
  return result;
}

}  // namespace evical
