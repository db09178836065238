#include "core/initialisation/camera_poses.h"

#include "core/base/time.h"
#include "core/geometry/camera_model.h"
#include "core/geometry/circle_conic.h"
#include "core/geometry/so3.h"
#include "core/geometry/trajectory.h"
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

struct SeenPoint {
  int circle;
  Eigen::Vector2d pixel;                                 // ideal
  Eigen::Matrix2d weight = Eigen::Matrix2d::Identity();  // of its directions
};
using Points = std::vector<SeenPoint>;

Points atOneTime(const BoardView& view) {
  constexpr double kUnknown = 1e-3;  // weight of a direction in which a corner is not known
  Points points;
  for (const CircleObservation& circle : view.circles) {
    SeenPoint& point = points.emplace_back(
        SeenPoint{circle.circle, circle.centre_px + circle.velocity_px_s * (view.time_s - circle.time_s)});
    if (const auto known = onlyKnownDirection(circle.covariance_px2))
      point.weight = kUnknown * point.weight + (1.0 - kUnknown) * *known * known->transpose();
  }
  return points;
}

// False if all corners are known in the same direction only.
bool determinePose(const Points& points) {
  constexpr double kMinShare = 0.05;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const SeenPoint& point : points) sum += point.weight / static_cast<double>(points.size());
  const double half_trace = 0.5 * sum.trace();
  const double least = half_trace - std::sqrt(std::max(half_trace * half_trace - sum.determinant(), 0.0));
  return least > kMinShare;
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
    for (const auto& [circle, pixel, weight] : points) {
      Eigen::Matrix<double, 2, 6> jacobian;
      const auto centre =
          projectedCircleCentre(camera, camera_from_board, board.point_m(circle), board.radius_m, &jacobian);
      if (!centre) return kNoFit_px;
      const Eigen::Vector2d error = *centre - pixel;
      matrix += jacobian.transpose() * weight * jacobian;
      vector -= jacobian.transpose() * weight * error;
      squares += error.dot(weight * error);
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
  for (const auto& [circle, pixel, weight] : points) {
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
    const Points points = atOneTime(view);
    if (!determinePose(points)) continue;
    const auto found = planarPoses(points, *camera.lens.detection_intrinsics, board);
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

int resolveBySmoothness(std::vector<CameraPose>& poses, double max_pair_s) {
  constexpr int kPasses = 3;
  int swapped = 0;
  for (int round = 0; round < kPasses; ++round) {
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (!poses[k].other_world_from_camera) continue;
      const auto strain_rad = [&](const RigidTransform& candidate) {
        double sum = 0.0;
        for (const std::size_t i : {k - 1, k + 1}) {  // 0 - 1 is beyond the end, too
          if (i >= poses.size() || std::abs(poses[i].time_s - poses[k].time_s) > max_pair_s) continue;
          sum += rotationAngleBetween_rad(poses[i].world_from_camera.rotation, candidate.rotation);
        }
        return sum;
      };
      if (strain_rad(*poses[k].other_world_from_camera) >= strain_rad(poses[k].world_from_camera)) continue;
      std::swap(*poses[k].other_world_from_camera, poses[k].world_from_camera);
      ++swapped;
    }
  }
  return swapped;
}

bool CameraTrajectory::isKnownAt(double time_s, double gap_s) const {
  const auto after = std::lower_bound(view_times_s.begin(), view_times_s.end(), time_s);
  if (after == view_times_s.begin() || after == view_times_s.end()) return false;
  return *after - time_s <= gap_s && time_s - *(after - 1) <= gap_s;
}

CameraTrajectory trajectoryThrough(const std::vector<CameraPose>& poses, double begin_s, double end_s,
                                   double knot_spacing_s) {
  CameraTrajectory trajectory;
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<Eigen::Vector3d> positions_m;
  for (const CameraPose& pose : poses) {
    if (pose.time_s < begin_s || pose.time_s > end_s) continue;
    trajectory.view_times_s.push_back(pose.time_s);
    rotations.push_back(pose.world_from_camera.rotation);
    positions_m.push_back(pose.world_from_camera.translation_m);
  }
  trajectory.world_from_camera_rotation =
      fitSo3Spline(trajectory.view_times_s, rotations, begin_s, end_s, knot_spacing_s);
  trajectory.camera_in_world_m =
      fitVectorSpline(trajectory.view_times_s, positions_m, begin_s, end_s, knot_spacing_s);
  return trajectory;
}

std::vector<ImuSample> angularRatesOf(const CameraTrajectory& trajectory, std::int64_t start_ns) {
  constexpr double kPeriod_s = 0.005;
  const So3Spline& rotation = trajectory.world_from_camera_rotation;
  std::vector<ImuSample> samples;
  for (double time_s = rotation.start_s; time_s <= rotation.endTime_s(); time_s += kPeriod_s) {
    ImuSample sample;
    sample.time_ns = start_ns + nanosecondsFrom(time_s);
    sample.angular_rate_rad_s = evaluate(rotation, time_s, RotationOrder::Velocity).angular_velocity_rad_s;
    samples.push_back(sample);
  }
  return samples;
}

std::optional<RelativePose> relativePose(const CameraTrajectory& reference,
                                         const std::vector<CameraPose>& poses, double time_offset_s,
                                         double gap_s, int min_views) {
  std::vector<RigidTransform> each;
  for (const CameraPose& pose : poses) {
    const double time_s = pose.time_s + time_offset_s;
    if (!reference.isKnownAt(time_s, gap_s)) continue;
    const RigidTransform world_from_reference =
        worldFromImu(reference.world_from_camera_rotation, reference.camera_in_world_m, time_s);
    each.push_back(inverse(world_from_reference) * pose.world_from_camera);
  }
  if (static_cast<int>(each.size()) < std::max(1, min_views)) return std::nullopt;
  // Mirrored solutions of planar poses are outliers.
  constexpr int kRounds = 20;
  constexpr PoseSpread kSpread{0.02, 0.01};
  return RelativePose{meanPose(each, each[each.size() / 2], kSpread, kRounds), static_cast<int>(each.size())};
}

}  // namespace evical
