#include "core/initialisation/further_boards.h"

#include "core/base/error.h"
#include "core/base/time.h"
#include "core/geometry/trajectory.h"
#include "core/numerics/angles.h"
#include "core/numerics/robust.h"

#include <fmt/format.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace evical {
namespace {

bool agrees(const std::optional<BoardAlignment>& found, const InitialisationOptions& options) {
  return found && found->agreeing >= options.min_board_agreement;
}

void checkAlignment(const std::string& board, const CalibrationInput& input,
                    const std::optional<BoardAlignment>& found, double gap_s,
                    const InitialisationOptions& options) {
  if (!found) {
    throw calibrationFailed(
        board,
        fmt::format(
            "fewer than {} views of it are within {:.2g} s of views of '{}', so their relative pose is "
            "unknown",
            options.min_views, gap_s, input.boardName(0)),
        "Keep each board in its camera's view at the same time, for most of the recording");
  }
  if (agrees(found, options)) return;
  throw calibrationFailed(
      board,
      fmt::format("only {:.0f} % of its views agree on its pose relative to '{}'", 100.0 * found->agreeing,
                  input.boardName(0)),
      "Check that the boards do not move relative to each other, and which camera sees which board");
}

}  // namespace

void alignFurtherBoards(const CalibrationInput& input, const std::map<std::size_t, AlignedCamera>& aligned,
                        const CameraTrajectory& body, double gap_s, const InitialisationOptions& options,
                        Initialisation& result) {
  result.state.further_boards.resize(input.further_boards.size());
  for (std::size_t board = 1; board < input.boardCount(); ++board) {
    Stopwatch stopwatch;
    std::vector<BoardSight> sights;
    std::vector<std::size_t> cameras;
    for (const auto& [k, camera] : aligned) {
      if (input.cameras[k].board != board) continue;
      sights.push_back({camera.poses, camera.hand_eye.time_offset_s, camera.hand_eye.reference_from_sensor,
                        input.cameras[k].prior.translation});
      cameras.push_back(k);
    }
    const std::string& name = input.boardName(board);
    const auto found = alignBoard(body, sights, gap_s, options.min_views);
    const auto negated = alignBoard(body, sights, gap_s, options.min_views, -1.0);
    if (agrees(negated, options) &&
        (!agrees(found, options) || negated->position_rms_m < options.far_better * found->position_rms_m))
      throw calibrationFailed(
          name,
          fmt::format("its views agree with '{}' only if the images of the cameras of one of the two boards "
                      "are mirrored",
                      input.boardName(0)),
          "Check whether writing is readable in the cameras' pictures. If not, turn the mirroring off in the "
          "driver, or set mirrored: x, y or transposed for the camera");
    checkAlignment(name, input, found, gap_s, options);
    result.state.boardAt(board).world_from_board = found->world_from_board;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      CameraState& state = result.state.cameras.at(cameras[i]);
      state.reference_from_camera = {sights[i].body_from_camera, found->cameras_in_body_m[i]};
      state.time_offset_s = sights[i].time_offset_s;
    }
    result.steps.push_back(
        {"board to board", name,
         fmt::format("{} views agree to {:.3f} deg and {:.2f} mm on its pose relative to {}", found->views,
                     found->rotation_rms_rad * kDegPerRad, 1e3 * found->position_rms_m, input.boardName(0)),
         found->position_rms_m, 0.0, stopwatch.restart_s()});
  }
}

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
                                         double gap_s, int min_views, double scale) {
  const std::vector<Moment> moments = momentsOf(body, sights, gap_s, scale);
  if (moments.empty() || static_cast<int>(moments.size()) < min_views) return std::nullopt;
  BoardAlignment result;
  result.views = static_cast<int>(moments.size());
  const MeanPose rotation = meanRotation(sights, moments);
  result.world_from_board.rotation = rotation.mean.rotation;
  result.rotation_rms_rad = rotation.rotation_rms_rad;
  Translations(sights, moments, rotation.mean.rotation).solve(result);
  return result;
}

}  // namespace evical
