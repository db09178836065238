#include "core/optimisation/circle_cost.h"

#include "core/geometry/circle_conic.h"
#include "core/geometry/so3.h"
#include "core/geometry/so3_spline.h"
#include "core/geometry/vector_spline.h"

#include <array>
#include <cmath>

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
  kEdgeLead,
  kBlocks
};

template <int Columns>
auto rowsOf(double** jacobians, int block, Eigen::Index row) {
  return Eigen::Map<Eigen::Matrix<double, 2, Columns, Columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>>(
      jacobians[block] + row * Columns);
}

void writeRotation(double** jacobians, int block, Eigen::Index row, const Matrix23d& by_delta) {
  auto rows = rowsOf<4>(jacobians, block, row);
  rows.leftCols<3>() = by_delta;
  rows.col(3).setZero();
}

constexpr std::array<int, kBlocks> kBlockSizes = {4, 4, 4, 4, 3, 3, 3, 3, 4, 3, 1, 1};

void writeZero(double** jacobians, Eigen::Index row) {
  for (int block = 0; block < kBlocks; ++block) {
    const int size = kBlockSizes[static_cast<std::size_t>(block)];
    if (jacobians[block]) std::fill_n(jacobians[block] + row * size, 2 * size, 0.0);
  }
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
  mutable_parameter_block_sizes()->assign(kBlockSizes.begin(), kBlockSizes.end());
  set_num_residuals(2 * static_cast<int>(circles_.size()));
}

bool CircleCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const double* const* r = parameters + kRotation;
  const double* const* p = parameters + kPosition;
  const Matrix3d imu_from_camera =
      Eigen::Map<const Eigen::Quaterniond>(parameters[kCameraRotation]).toRotationMatrix();
  const Matrix3d camera_from_imu = imu_from_camera.transpose();
  const Eigen::Map<const Vector3d> camera_in_imu(parameters[kCameraTranslation]);
  const double time_offset_s = *parameters[kTimeOffset], edge_lead_px = *parameters[kEdgeLead];
  const So3Segment rotation_segment(r[0], r[1], r[2], r[3], segment_.rotation_spacing_s,
                                    jacobians != nullptr);
  const RotationOrder order =
      jacobians && jacobians[kTimeOffset] ? RotationOrder::Velocity : RotationOrder::Rotation;
  const bool by_rotation = jacobians && (jacobians[0] || jacobians[1] || jacobians[2] || jacobians[3]);

  for (std::size_t i = 0; i < circles_.size(); ++i) {
    const CircleMeasurement& circle = circles_[i];
    const auto row = static_cast<Eigen::Index>(2 * i);
    Eigen::Map<Vector2d> residual(residuals + row);
    const double time_s = circle.time_s + time_offset_s;
    RotationSample rotation;
    RotationJacobians by_control_points;
    rotation_segment.evaluate((time_s - segment_.rotation_start_s) / segment_.rotation_spacing_s, order,
                              rotation, by_rotation ? &by_control_points : nullptr);
    const VectorSample position = evaluateVectorSegment(
        p[0], p[1], p[2], p[3], (time_s - segment_.position_start_s) / segment_.position_spacing_s,
        segment_.position_spacing_s);
    const Matrix3d imu_from_world = rotation.rotation.transpose();
    const Vector3d in_imu =
        imu_from_world * (Vector3d(circle.on_board_m.x(), circle.on_board_m.y(), 0.0) - position.value);
    const Vector3d normal_in_imu = imu_from_world.col(2);
    const Vector3d in_camera = camera_from_imu * (in_imu - camera_in_imu);
    const Vector3d normal_in_camera = camera_from_imu * normal_in_imu;
    const auto projected = projectCircle(model_.camera, in_camera, normal_in_camera, model_.radius_m);
    if (!projected) {
      residual.setConstant(kBehindCamera_sigma);
      if (jacobians) writeZero(jacobians, row);
      continue;
    }
    Vector2d error = circle.whitening_px *
                     (projected->centre_px + edge_lead_px * circle.lead_direction - circle.centre_px);
    const Eigen::Matrix2d by_error = shortenByHuber(model_.huber_sigma, error);
    residual = error;
    if (!jacobians) continue;

    const Eigen::Matrix2d by_px = by_error * circle.whitening_px;
    const Matrix23d by_centre = by_px * projected->by_centre, by_normal = by_px * projected->by_normal;
    const Matrix23d by_imu_centre = by_centre * camera_from_imu, by_imu_normal = by_normal * camera_from_imu;
    const Matrix23d by_attitude = by_imu_centre * skew(in_imu) + by_imu_normal * skew(normal_in_imu);
    const Matrix23d by_position = -by_imu_centre * imu_from_world;
    for (int k = 0; k < 4; ++k) {
      if (jacobians[kRotation + k]) {
        writeRotation(jacobians, kRotation + k, row,
                      by_attitude * by_control_points.rotation[static_cast<std::size_t>(k)]);
      }
      if (jacobians[kPosition + k])
        rowsOf<3>(jacobians, kPosition + k, row) = position.value_weights[k] * by_position;
    }
    if (jacobians[kCameraRotation]) {
      writeRotation(jacobians, kCameraRotation, row,
                    by_centre * skew(in_camera) + by_normal * skew(normal_in_camera));
    }
    if (jacobians[kCameraTranslation]) rowsOf<3>(jacobians, kCameraTranslation, row) = -by_imu_centre;
    if (jacobians[kTimeOffset]) {
      rowsOf<1>(jacobians, kTimeOffset, row) =
          by_attitude * rotation.angular_velocity_rad_s + by_position * position.velocity;
    }
    if (jacobians[kEdgeLead]) rowsOf<1>(jacobians, kEdgeLead, row) = by_px * circle.lead_direction;
  }
  return true;
}

}  // namespace evical
