#include "core/initialisation/board_alignment.h"

#include "core/geometry/trajectory.h"
#include "core/numerics/robust.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace evical {
namespace {

// One view: poses of the body, and of the camera relative to the board.
struct Moment {
  std::size_t sight;
  RigidTransform world_from_body, board_from_camera;
};

std::vector<Moment> momentsOf(const CameraTrajectory& body, std::span<const BoardSight> sights, double gap_s,
                              double scale) {
  std::vector<Moment> moments;
  for (std::size_t k = 0; k < sights.size(); ++k) {
    for (const CameraPose& pose : sights[k].poses) {
      const double time_s = pose.time_s + sights[k].time_offset_s;
      if (!body.isKnownAt(time_s, gap_s)) continue;
      moments.push_back({k,
                         worldFromImu(body.world_from_camera_rotation, body.camera_in_world_m, time_s),
                         {pose.world_from_camera.rotation, scale * pose.world_from_camera.translation_m}});
    }
  }
  return moments;
}

// Rotations as poses without a translation.
MeanPose meanRotation(std::span<const BoardSight> sights, const std::vector<Moment>& moments) {
  std::vector<RigidTransform> rotations;
  for (const Moment& moment : moments)
    rotations.push_back({moment.world_from_body.rotation * sights[moment.sight].body_from_camera *
                             moment.board_from_camera.rotation.conjugate(),
                         Eigen::Vector3d::Zero()});
  constexpr int kRounds = 20;
  constexpr PoseSpread kSpread{0.02, 1.0};  // mirrored solutions of planar poses are outliers
  return meanPose(rotations, rotations[rotations.size() / 2], kSpread, kRounds);
}

// Solves R_wb t_c - t_wB = R_wB p_Bc - p_wb over all views, with robust weights; unknown are t_wB and each
// t_c.
class Translations {
 public:
  Translations(std::span<const BoardSight> sights, const std::vector<Moment>& moments,
               const Eigen::Quaterniond& board_rotation)
      : sights_(sights), moments_(moments), world_from_board_(board_rotation.toRotationMatrix()) {}

  void solve(BoardAlignment& result) {
    constexpr int kRounds = 10;
    constexpr double kSpread_m = 0.01;
    Eigen::VectorXd solution = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 + 3 * sights_.size()));
    std::vector<double> weights(moments_.size(), 1.0);
    double errors2 = 0.0, all = 1.0;
    for (int round = 0; round < kRounds; ++round) {
      solution = weighted(weights);
      errors2 = all = 0.0;
      for (std::size_t i = 0; i < moments_.size(); ++i) {
        const double error2 = errorOf(moments_[i], solution).squaredNorm();
        weights[i] = cauchyWeight(error2 / (kSpread_m * kSpread_m));
        errors2 += weights[i] * error2;
        all += weights[i];
      }
    }
    result.position_rms_m = std::sqrt(errors2 / all);
    result.agreeing = agreeing(solution);
    result.world_from_board.translation_m = solution.head<3>();
    for (std::size_t k = 0; k < sights_.size(); ++k)
      result.cameras_in_body_m.emplace_back(solution.segment<3>(columnOf(k)));
  }

 private:
  static Eigen::Index columnOf(std::size_t sight) { return static_cast<Eigen::Index>(3 + 3 * sight); }

  Eigen::Vector3d measured(const Moment& moment) const {
    return world_from_board_ * moment.board_from_camera.translation_m - moment.world_from_body.translation_m;
  }
  Eigen::Vector3d errorOf(const Moment& moment, const Eigen::VectorXd& solution) const {
    return moment.world_from_body.rotation * solution.segment<3>(columnOf(moment.sight)) -
           solution.head<3>() - measured(moment);
  }

  double agreeing(const Eigen::VectorXd& solution) const {
    constexpr double kNear_m = 0.01, kTimes = 5.0;
    std::vector<double> errors_m;
    for (const Moment& moment : moments_) errors_m.push_back(errorOf(moment, solution).norm());
    std::sort(errors_m.begin(), errors_m.end());
    const double reach_m = std::max(kNear_m, kTimes * errors_m[errors_m.size() / 4]);
    const auto near = std::upper_bound(errors_m.begin(), errors_m.end(), reach_m) - errors_m.begin();
    return static_cast<double>(near) / static_cast<double>(errors_m.size());
  }

  Eigen::VectorXd weighted(const std::vector<double>& weights) const {
    constexpr double kOpen = 1e-6;   // undetermined values stay at zero
    constexpr double kGiven = 1e12;  // given values are fixed
    const Eigen::Index size = columnOf(sights_.size());
    Eigen::MatrixXd normal = kOpen * Eigen::MatrixXd::Identity(size, size);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
    for (std::size_t k = 0; k < sights_.size(); ++k) {
      if (!isGiven(sights_[k].translation)) continue;
      normal.diagonal().segment<3>(columnOf(k)).array() += kGiven;
      right.segment<3>(columnOf(k)) += kGiven * sights_[k].translation->value;
    }
    for (std::size_t i = 0; i < moments_.size(); ++i) {
      const Eigen::Matrix3d turn = moments_[i].world_from_body.rotation.toRotationMatrix();
      const Eigen::Vector3d goal = measured(moments_[i]);
      const Eigen::Index lever = columnOf(moments_[i].sight);
      normal.topLeftCorner<3, 3>().diagonal().array() += weights[i];
      normal.block<3, 3>(lever, lever).diagonal().array() += weights[i];
      normal.block<3, 3>(0, lever) -= weights[i] * turn;
      normal.block<3, 3>(lever, 0) -= weights[i] * turn.transpose();
      right.head<3>() -= weights[i] * goal;
      right.segment<3>(lever) += weights[i] * turn.transpose() * goal;
    }
    return normal.ldlt().solve(right);
  }

  std::span<const BoardSight> sights_;
  const std::vector<Moment>& moments_;
  Eigen::Matrix3d world_from_board_;
};

}  // namespace

std::optional<BoardAlignment> alignBoard(const CameraTrajectory& body, std::span<const BoardSight> sights,
                                         double gap_s, int least_views, double scale) {
  const std::vector<Moment> moments = momentsOf(body, sights, gap_s, scale);
  if (moments.empty() || static_cast<int>(moments.size()) < least_views) return std::nullopt;
  BoardAlignment result;
  result.views = static_cast<int>(moments.size());
  const MeanPose rotation = meanRotation(sights, moments);
  result.world_from_board.rotation = rotation.mean.rotation;
  result.rotation_rms_rad = rotation.rotation_rms_rad;
  Translations(sights, moments, rotation.mean.rotation).solve(result);
  return result;
}

}  // namespace evical
