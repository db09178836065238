#include "core/optimisation/circle_cost.h"

#include "core/geometry/circle_conic.h"
#include "core/geometry/so3.h"
#include "core/optimisation/jacobian_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace evical {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix23d = Eigen::Matrix<double, 2, 3>;

constexpr double kBehindCamera_sigma = 1e3;  // so large that no step leads there

enum Block {
  kRotation = 0,
  kPosition = 4,
  kCameraRotation = 8,
  kCameraTranslation,
  kTimeOffset,
  kTimeOffsetDrift,
  kLineDelay,
  kEdgeLocalisationBias,
  kSlowEdgeLocalisationBias,
  kBoardScale,
  kBoardStretch,
  kBoardRowCurvature,
  kBoardColumnCurvature,
  kBoardTwist,
  kExposureShare,
  kBoardRotation,
  kBoardTranslation,
  kIntrinsics,  // only if they are estimated
  kBlocks
};
constexpr std::array<int, kBlocks> kBlockSizes = {4, 4, 4, 4, 3, 3, 3, 3, 4, 3, 1, 1,
                                                  1, 1, 1, 1, 1, 1, 1, 1, 1, 4, 3, 9};

void writeZero(double** jacobians, int blocks, Eigen::Index row) {
  for (int block = 0; block < blocks; ++block) {
    const int size = kBlockSizes[static_cast<std::size_t>(block)];
    if (jacobians[block]) std::fill_n(jacobians[block] + row * size, 2 * size, 0.0);
  }
}

// The blocks of the camera and the board, ready for use.
struct Mount {
  Matrix3d camera_from_imu;
  Vector3d camera_in_imu;
  double time_offset_s, time_offset_drift_ppm, line_delay_us, exposure_share;
  EdgeLocalisationBias lead;
  BoardState board;
  Matrix3d world_from_board;  // its rotation

  explicit Mount(double const* const* parameters)
      : camera_from_imu(
            Eigen::Map<const Eigen::Quaterniond>(parameters[kCameraRotation]).toRotationMatrix().transpose()),
        camera_in_imu(parameters[kCameraTranslation]),
        time_offset_s(*parameters[kTimeOffset]),
        time_offset_drift_ppm(*parameters[kTimeOffsetDrift]),
        line_delay_us(*parameters[kLineDelay]),
        exposure_share(*parameters[kExposureShare]),
        lead{*parameters[kEdgeLocalisationBias], *parameters[kSlowEdgeLocalisationBias]},
        board{*parameters[kBoardScale],
              *parameters[kBoardStretch],
              *parameters[kBoardRowCurvature],
              *parameters[kBoardColumnCurvature],
              *parameters[kBoardTwist],
              {Eigen::Quaterniond(parameters[kBoardRotation]), Vector3d(parameters[kBoardTranslation])}},
        world_from_board(board.world_from_board.rotation.toRotationMatrix()) {}
};

// One circle at its time, and the motion on which its place depends.
struct PlacedCircle {
  RotationSample rotation;
  RotationJacobians by_control_points;
  VectorSample position;
  Matrix3d imu_from_world;
  Vector3d on_sheet_m, in_imu, normal_in_imu, in_camera, normal_in_camera;

  void place(const Mount& mount, const Vector2d& on_board_m) {
    imu_from_world = rotation.rotation.transpose();
    on_sheet_m = mount.board.onSheet_m(on_board_m);
    in_imu = imu_from_world * (mount.world_from_board * on_sheet_m +
                               mount.board.world_from_board.translation_m - position.value);
    normal_in_imu = imu_from_world * mount.world_from_board.col(2);
    in_camera = mount.camera_from_imu * (in_imu - mount.camera_in_imu);
    normal_in_camera = mount.camera_from_imu * normal_in_imu;
  }
};

bool movesInTime(double** jacobians) {
  return jacobians && (jacobians[kTimeOffset] || jacobians[kTimeOffsetDrift] || jacobians[kLineDelay] ||
                       jacobians[kExposureShare]);
}

// `by_place`: derivative of the residual by the circle's position in the board's frame.
void writeSheetJacobians(const BoardState& board, const Vector2d& on_board_m, const Matrix23d& by_place,
                         Eigen::Index row, double** jacobians) {
  const double x = on_board_m.x(), y = on_board_m.y();
  const auto write = [&](Block block, const Vector3d& place_by_block) {
    if (jacobians[block]) jacobianRows<2, 1>(jacobians, block, row) = by_place * place_by_block;
  };
  write(kBoardScale, {(1.0 + 0.5 * board.stretch) * x, (1.0 - 0.5 * board.stretch) * y, 0.0});
  write(kBoardStretch, {0.5 * board.scale * x, -0.5 * board.scale * y, 0.0});
  write(kBoardRowCurvature, {0.0, 0.0, 0.5 * x * x});
  write(kBoardColumnCurvature, {0.0, 0.0, 0.5 * y * y});
  write(kBoardTwist, {0.0, 0.0, x * y});
}

// `by_place`, `by_normal`: derivatives of the residual by the circle's position and the board's normal in the world.
void writeBoardJacobians(const Mount& mount, const PlacedCircle& placed, const Vector2d& on_board_m,
                         const Matrix23d& by_place, const Matrix23d& by_normal, Eigen::Index row,
                         double** jacobians) {
  writeSheetJacobians(mount.board, on_board_m, by_place * mount.world_from_board, row, jacobians);
  if (jacobians[kBoardRotation]) {
    writeRotationRows<2>(jacobians, kBoardRotation, row,
                         -by_place * mount.world_from_board * skew(placed.on_sheet_m) -
                             by_normal * mount.world_from_board * skew(Vector3d::UnitZ()));
  }
  if (jacobians[kBoardTranslation]) jacobianRows<2, 3>(jacobians, kBoardTranslation, row) = by_place;
}

// `by_px`: derivative of the residual with respect to the predicted centre.
void writeJacobians(const Mount& mount, const PlacedCircle& placed, const ProjectedCircle& projected,
                    const Eigen::Matrix2d& by_px, const CircleMeasurement& circle, Eigen::Index row,
                    double** jacobians) {
  const Matrix23d by_centre = by_px * projected.by_centre, by_normal = by_px * projected.by_normal;
  const Matrix23d by_imu_centre = by_centre * mount.camera_from_imu;
  const Matrix23d by_attitude =
      by_imu_centre * skew(placed.in_imu) + by_normal * mount.camera_from_imu * skew(placed.normal_in_imu);
  const Matrix23d by_position = -by_imu_centre * placed.imu_from_world;
  for (int k = 0; k < 4; ++k) {
    if (jacobians[kRotation + k]) {
      writeRotationRows<2>(jacobians, kRotation + k, row,
                           by_attitude * placed.by_control_points.rotation[static_cast<std::size_t>(k)]);
    }
    if (jacobians[kPosition + k]) {
      jacobianRows<2, 3>(jacobians, kPosition + k, row) = placed.position.value_weights[k] * by_position;
    }
  }
  if (jacobians[kCameraRotation]) {
    writeRotationRows<2>(jacobians, kCameraRotation, row,
                         by_centre * skew(placed.in_camera) + by_normal * skew(placed.normal_in_camera));
  }
  if (jacobians[kCameraTranslation]) jacobianRows<2, 3>(jacobians, kCameraTranslation, row) = -by_imu_centre;
  if (movesInTime(jacobians)) {
    const Vector2d by_time =
        by_attitude * placed.rotation.angular_velocity_rad_s + by_position * placed.position.velocity;
    if (jacobians[kTimeOffset]) jacobianRows<2, 1>(jacobians, kTimeOffset, row) = by_time;
    if (jacobians[kTimeOffsetDrift])
      jacobianRows<2, 1>(jacobians, kTimeOffsetDrift, row) = circle.by_drift_s * by_time;
    if (jacobians[kLineDelay]) jacobianRows<2, 1>(jacobians, kLineDelay, row) = circle.by_line_s * by_time;
    if (jacobians[kExposureShare])
      jacobianRows<2, 1>(jacobians, kExposureShare, row) = circle.by_exposure_s * by_time;
  }
  writeBoardJacobians(mount, placed, circle.on_board_m, -by_position,
                      by_normal * mount.camera_from_imu * placed.imu_from_world, row, jacobians);
  if (jacobians[kEdgeLocalisationBias])
    jacobianRows<2, 1>(jacobians, kEdgeLocalisationBias, row) = by_px * circle.lead.of_lead;
  if (jacobians[kSlowEdgeLocalisationBias])
    jacobianRows<2, 1>(jacobians, kSlowEdgeLocalisationBias, row) = by_px * circle.lead.of_slow;
}

// One for each view whose circles have a displacement in common.
std::vector<CommonDisplacement> commonDisplacements(const std::vector<CircleMeasurement>& circles) {
  std::map<int, std::vector<Eigen::Index>> rows_by_view;
  for (std::size_t i = 0; i < circles.size(); ++i)
    if (circles[i].common_px > 0.0) rows_by_view[circles[i].view].push_back(2 * static_cast<Eigen::Index>(i));
  std::vector<CommonDisplacement> all;
  std::vector<Eigen::Matrix2d> roots;
  for (auto& [view, rows] : rows_by_view) {
    roots.clear();
    for (const Eigen::Index row : rows) {
      const CircleMeasurement& circle = circles[static_cast<std::size_t>(row / 2)];
      roots.push_back(circle.common_px * circle.whitening_px);
    }
    all.emplace_back(std::move(rows), roots);
  }
  return all;
}

}  // namespace

Eigen::Matrix2d shortenByHuber(double threshold, Vector2d& residual) {
  const double length = residual.norm();
  if (length <= threshold) return Eigen::Matrix2d::Identity();
  const Vector2d direction = residual / length;
  const double shortened = std::sqrt(threshold * (2.0 * length - threshold));
  const Eigen::Matrix2d along = direction * direction.transpose();
  residual = shortened * direction;
  return threshold / shortened * along + shortened / length * (Eigen::Matrix2d::Identity() - along);
}

CircleCost::CircleCost(const CircleModel& model, const SegmentTimes& segment,
                       std::vector<CircleMeasurement> circles)
    : model_(model), segment_(segment), circles_(std::move(circles)) {
  mutable_parameter_block_sizes()->assign(
      kBlockSizes.begin(), kBlockSizes.begin() + (model.free_intrinsics ? kBlocks : kIntrinsics));
  set_num_residuals(2 * static_cast<int>(circles_.size()));
  common_ = commonDisplacements(circles_);
  if (!model.free_intrinsics) return;
  for (const CircleMeasurement& circle : circles_)
    seen_.push_back(seenCentre(model.camera, circle.centre_px));
}

bool CircleCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Mount mount(parameters);
  const So3Segment rotation_segment = rotationSegment(segment_, parameters + kRotation, jacobians != nullptr);
  const RotationOrder order = movesInTime(jacobians) ? RotationOrder::Velocity : RotationOrder::Rotation;
  const CameraIntrinsics camera = model_.free_intrinsics
                                      ? intrinsicsFrom(parameters[kIntrinsics], model_.camera.model, {})
                                      : model_.camera;
  const bool by_camera = model_.free_intrinsics && jacobians && jacobians[kIntrinsics];
  IntrinsicsJacobian by_intrinsics;
  PlacedCircle placed;
  for (std::size_t i = 0; i < circles_.size(); ++i) {
    const CircleMeasurement& circle = circles_[i];
    const auto row = static_cast<Eigen::Index>(2 * i);
    Eigen::Map<Vector2d> residual(residuals + row);
    const double time_s =
        circle.time_s + mount.time_offset_s + circle.by_drift_s * mount.time_offset_drift_ppm +
        circle.by_line_s * mount.line_delay_us + circle.by_exposure_s * mount.exposure_share;
    rotation_segment.evaluate(segment_.rotationPlace(time_s), order, placed.rotation,
                              jacobians ? &placed.by_control_points : nullptr);
    placed.position = positionAt(segment_, parameters + kPosition, time_s);
    placed.place(mount, circle.on_board_m);
    const auto projected =
        model_.free_intrinsics
            ? projectCircleBeside(seen_[i], camera, placed.in_camera, placed.normal_in_camera,
                                  model_.radius_m, by_camera ? &by_intrinsics : nullptr)
            : projectCircle(camera, placed.in_camera, placed.normal_in_camera, model_.radius_m);
    if (!projected) {
      residual.setConstant(kBehindCamera_sigma);
      if (jacobians) writeZero(jacobians, static_cast<int>(parameter_block_sizes().size()), row);
      continue;
    }
    const Vector2d lead_px = mount.lead.times(circle.lead);
    residual = circle.whitening_px * (projected->centre_px + lead_px - circle.centre_px);
    if (!jacobians) continue;
    writeJacobians(mount, placed, *projected, circle.whitening_px, circle, row, jacobians);
    if (by_camera) jacobianRows<2, 9>(jacobians, kIntrinsics, row) = circle.whitening_px * by_intrinsics;
  }
  whitenViews(residuals, jacobians);
  shorten(residuals, jacobians);
  return true;
}

void CircleCost::whitenViews(double* residuals, double** jacobians) const {
  for (const CommonDisplacement& common : common_) {
    const auto is_behind = [&](Eigen::Index row) { return residuals[row] == kBehindCamera_sigma; };
    if (std::ranges::any_of(common.rows(), is_behind)) continue;
    common.whiten(residuals, 1);
    if (!jacobians) continue;
    for (std::size_t block = 0; block < parameter_block_sizes().size(); ++block)
      if (jacobians[block]) common.whiten(jacobians[block], parameter_block_sizes()[block]);
  }
}

void CircleCost::shorten(double* residuals, double** jacobians) const {
  using Rows = Eigen::Map<Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor>>;
  for (Eigen::Index row = 0; row < num_residuals(); row += 2) {
    Vector2d error(residuals[row], residuals[row + 1]);
    if (error.norm() <= model_.huber_sigma || error.x() == kBehindCamera_sigma) continue;
    const Eigen::Matrix2d by_error = shortenByHuber(model_.huber_sigma, error);
    Eigen::Map<Vector2d>(residuals + row) = error;
    if (!jacobians) continue;
    for (std::size_t block = 0; block < parameter_block_sizes().size(); ++block) {
      if (!jacobians[block]) continue;
      const Eigen::Index columns = parameter_block_sizes()[block];
      Rows rows(jacobians[block] + row * columns, 2, columns);
      rows = (by_error * rows).eval();
    }
  }
}

}  // namespace evical
