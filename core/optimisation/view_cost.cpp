#include "core/optimisation/view_cost.h"

#include "core/geometry/camera_motion.h"
#include "core/geometry/circle_conic.h"
#include "core/geometry/so3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace evical {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix23d = Eigen::Matrix<double, 2, 3>;
using Matrix26d = Eigen::Matrix<double, 2, 6>;

constexpr double kBehindCamera_sigma = 1e3;  // so large that no step leads there

// Blocks after the control points.
enum Block : std::size_t {
  kCameraRotation,
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
constexpr std::array<int, kBlocks> kBlockSizes = {4, 3, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 4, 3, 9};

// Quaternion blocks as in calibration_problem.h.
int tangentSize(int block_size) {
  return block_size == 4 ? 3 : block_size;
}

// The blocks of the camera and the board, ready for use.
struct Mount {
  Matrix3d imu_from_camera;
  Vector3d camera_in_imu;
  double time_offset_s, time_offset_drift_ppm, line_delay_us, exposure_share;
  EdgeLocalisationBias lead;
  BoardState board;
  Matrix3d world_from_board;  // its rotation

  explicit Mount(double const* const* blocks)
      : imu_from_camera(Eigen::Map<const Eigen::Quaterniond>(blocks[kCameraRotation]).toRotationMatrix()),
        camera_in_imu(blocks[kCameraTranslation]),
        time_offset_s(*blocks[kTimeOffset]),
        time_offset_drift_ppm(*blocks[kTimeOffsetDrift]),
        line_delay_us(*blocks[kLineDelay]),
        exposure_share(*blocks[kExposureShare]),
        lead{*blocks[kEdgeLocalisationBias], *blocks[kSlowEdgeLocalisationBias]},
        board{*blocks[kBoardScale],
              *blocks[kBoardStretch],
              *blocks[kBoardRowCurvature],
              *blocks[kBoardColumnCurvature],
              *blocks[kBoardTwist],
              {Eigen::Quaterniond(blocks[kBoardRotation]), Vector3d(blocks[kBoardTranslation])}},
        world_from_board(board.world_from_board.rotation.toRotationMatrix()) {}

  double timeOf(const CircleMeasurement& circle) const {
    return circle.time_s + time_offset_s + circle.by_drift_s * time_offset_drift_ppm +
           circle.by_line_s * line_delay_us + circle.by_exposure_s * exposure_share;
  }
};

// Two rows of one circle, column by column.
class RowPair {
 public:
  RowPair(double* first, Eigen::Index stride) : first_(first), second_(first + stride) {}

  void append(const Vector2d& column) {
    *first_++ = column.x();
    *second_++ = column.y();
  }
  template <class Matrix>
  void append(const Matrix& columns, Eigen::Index count) {
    for (Eigen::Index k = 0; k < count; ++k) append(columns.col(k));
  }

 private:
  double *first_, *second_;
};

// One circle in the camera, and the derivatives of its residual.
struct SeenCircle {
  Vector3d on_sheet_m, in_camera_m, normal;
  Vector2d residual;
  Matrix23d by_place, by_normal;  // in the camera's frame
  IntrinsicsJacobian by_intrinsics;

  void place(const Mount& mount, const CameraMotion& motion, const Vector2d& on_board_m) {
    on_sheet_m = mount.board.onSheet_m(on_board_m);
    const Vector3d in_world =
        mount.world_from_board * on_sheet_m + mount.board.world_from_board.translation_m;
    in_camera_m = motion.camera_from_world * (in_world - motion.camera_in_world);
    normal = motion.camera_from_world * mount.world_from_board.col(2);
  }
  Matrix26d byPose() const {
    Matrix26d by_pose;
    by_pose << by_place * skew(in_camera_m) + by_normal * skew(normal), -by_place;
    return by_pose;
  }
};

// `by_place`: by the circle's position in the board's frame.
void appendSheet(const BoardState& board, const Vector2d& on_board_m, const Matrix23d& by_place,
                 std::span<const int> widths, RowPair& rows) {
  const double x = on_board_m.x(), y = on_board_m.y();
  const auto append = [&](Block block, const Vector3d& by_block) {
    if (widths[block] > 0) rows.append(Vector2d(by_place * by_block));
  };
  append(kBoardScale, {(1.0 + 0.5 * board.stretch) * x, (1.0 - 0.5 * board.stretch) * y, 0.0});
  append(kBoardStretch, {0.5 * board.scale * x, -0.5 * board.scale * y, 0.0});
  append(kBoardRowCurvature, {0.0, 0.0, 0.5 * x * x});
  append(kBoardColumnCurvature, {0.0, 0.0, 0.5 * y * y});
  append(kBoardTwist, {0.0, 0.0, x * y});
}

// Columns of the blocks after the camera's pose, in their order.
void appendOwn(const Mount& mount, const CameraMotion& motion, const CircleMeasurement& circle,
               const SeenCircle& seen, const Matrix26d& by_pose, std::span<const int> widths, RowPair& rows) {
  const Vector2d by_time =
      by_pose.leftCols<3>() * motion.angularVelocity() + by_pose.rightCols<3>() * motion.velocity();
  rows.append(by_time, widths[kTimeOffset]);
  rows.append(circle.by_drift_s * by_time, widths[kTimeOffsetDrift]);
  rows.append(circle.by_line_s * by_time, widths[kLineDelay]);
  rows.append(Vector2d(circle.whitening_px * circle.lead.of_lead), widths[kEdgeLocalisationBias]);
  rows.append(Vector2d(circle.whitening_px * circle.lead.of_slow), widths[kSlowEdgeLocalisationBias]);
  const Matrix3d camera_from_board = motion.camera_from_world * mount.world_from_board;
  const Matrix23d by_board_place = seen.by_place * camera_from_board;
  appendSheet(mount.board, circle.on_board_m, by_board_place, widths, rows);
  rows.append(circle.by_exposure_s * by_time, widths[kExposureShare]);
  if (widths[kBoardRotation] > 0)
    rows.append(Matrix23d(-by_board_place * skew(seen.on_sheet_m) -
                          seen.by_normal * camera_from_board * skew(Vector3d::UnitZ())),
                3);
  if (widths[kBoardTranslation] > 0) rows.append(Matrix23d(seen.by_place * motion.camera_from_world), 3);
  if (widths.size() > kIntrinsics) rows.append(seen.by_intrinsics, widths[kIntrinsics]);
}

// Rows of a view before they are whitened.
class ViewEvaluation {
 public:
  ViewEvaluation(const CircleModel& model, const SegmentTimes& segments, double const* const* parameters,
                 std::span<const int> widths, ViewRows& rows)
      : model_(model),
        segments_(segments),
        parameters_(parameters),
        widths_(widths),
        rows_(rows),
        mount_(blocks()),
        camera_(model.free_intrinsics ? intrinsicsFrom(blocks()[kIntrinsics], model.camera.model, {})
                                      : model.camera) {}

  // False if a circle is behind the camera.
  bool run(std::span<const CircleMeasurement> circles, std::span<const SeenCentre> centres,
           ViewCost::PoseColumns columns) {
    if (columns == ViewCost::PoseColumns::AtTimes) times_ = timesOf(circles);
    placeColumns(circles.size());
    const bool by_points = !widths_.empty() && times_.count == 0;
    CameraMotion motion(segments_, parameters_, mount_.imu_from_camera, mount_.camera_in_imu,
                        widths_.empty() ? RotationOrder::Rotation : RotationOrder::Velocity, by_points);
    by_points_.resize(6, by_points ? rows_.poses : 0);
    bool all_in_front = true;
    SeenCircle seen;
    for (std::size_t i = 0; i < circles.size(); ++i) {
      double* const row = rows_.values.data() + 2 * static_cast<Eigen::Index>(i) * rows_.stride;
      motion.moveTo(mount_.timeOf(circles[i]));
      if (!see(circles[i], centres.empty() ? nullptr : &centres[i], motion, seen)) {
        std::fill_n(row, 2 * rows_.stride, 0.0);
        seen.residual.setConstant(kBehindCamera_sigma);
        all_in_front = false;
      } else if (!widths_.empty()) {
        write(circles[i], motion, seen, row);
      }
      row[rows_.stride - 1] = seen.residual.x();
      row[2 * rows_.stride - 1] = seen.residual.y();
    }
    return all_in_front;
  }

 private:
  using Rows = Eigen::Map<ViewRows::RowMajorMatrix, 0, Eigen::OuterStride<>>;

  double const* const* blocks() const { return parameters_ + controlPointsOf(segments_); }

  PoseTimes timesOf(std::span<const CircleMeasurement> circles) const {
    double first_s = mount_.timeOf(circles.front()), last_s = first_s;
    for (const CircleMeasurement& circle : circles) {
      first_s = std::min(first_s, mount_.timeOf(circle));
      last_s = std::max(last_s, mount_.timeOf(circle));
    }
    return {first_s, last_s, std::min(segments_.rotation_spacing_s, segments_.position_spacing_s)};
  }

  void placeColumns(std::size_t circles) {
    rows_.poses = 0;
    rows_.stride = 1;
    rows_.chain.resize(0, 0);
    if (!widths_.empty()) {
      rows_.poses = 3 * static_cast<Eigen::Index>(controlPointsOf(segments_)) + widths_[kCameraRotation] +
                    widths_[kCameraTranslation];
      if (times_.count > 0) writeChain();
      rows_.stride = std::accumulate(widths_.begin() + kTimeOffset, widths_.end(), rows_.poses) + 1;
    }
    rows_.values.resize(std::max(rows_.values.size(), 2 * circles * static_cast<std::size_t>(rows_.stride)));
  }

  void writeChain() {
    CameraMotion motion(segments_, parameters_, mount_.imu_from_camera, mount_.camera_in_imu,
                        RotationOrder::Rotation, true);
    rows_.chain.resize(static_cast<Eigen::Index>(6 * times_.count), rows_.poses);
    for (std::size_t k = 0; k < times_.count; ++k) {
      motion.moveTo(times_.times_s[k]);
      motion.writeDerivatives(widths_[kCameraRotation] > 0, widths_[kCameraTranslation] > 0,
                              rows_.chain.middleRows<6>(static_cast<Eigen::Index>(6 * k)));
    }
    rows_.poses = rows_.chain.rows();
  }

  void write(const CircleMeasurement& circle, const CameraMotion& motion, const SeenCircle& seen,
             double* row) {
    const Matrix26d by_pose = seen.byPose();
    if (times_.count == 0) {
      motion.writeDerivatives(widths_[kCameraRotation] > 0, widths_[kCameraTranslation] > 0, by_points_);
      Rows(row, 2, rows_.poses, Eigen::OuterStride<>(rows_.stride)) = by_pose.lazyProduct(by_points_);
    }
    const std::array<double, PoseTimes::kMax> weights = times_.weightsAt(mount_.timeOf(circle));
    for (std::size_t k = 0; k < times_.count; ++k)
      Rows(row + 6 * k, 2, 6, Eigen::OuterStride<>(rows_.stride)) = weights[k] * by_pose;
    RowPair own(row + rows_.poses, rows_.stride);
    appendOwn(mount_, motion, circle, seen, by_pose, widths_, own);
  }

  // False if it is not in front of the camera.
  bool see(const CircleMeasurement& circle, const SeenCentre* centre, const CameraMotion& motion,
           SeenCircle& seen) const {
    seen.place(mount_, motion, circle.on_board_m);
    const bool by_intrinsics = widths_.size() > kIntrinsics && widths_[kIntrinsics] > 0;
    const auto projected =
        centre ? projectCircleBeside(*centre, camera_, seen.in_camera_m, seen.normal, model_.radius_m,
                                     by_intrinsics ? &seen.by_intrinsics : nullptr)
               : projectCircle(camera_, seen.in_camera_m, seen.normal, model_.radius_m);
    if (!projected) return false;
    seen.residual =
        circle.whitening_px * (projected->centre_px + mount_.lead.times(circle.lead) - circle.centre_px);
    seen.by_place = circle.whitening_px * projected->by_centre;
    seen.by_normal = circle.whitening_px * projected->by_normal;
    if (by_intrinsics) seen.by_intrinsics = (circle.whitening_px * seen.by_intrinsics).eval();
    return true;
  }

  const CircleModel& model_;
  const SegmentTimes& segments_;
  double const* const* parameters_;
  std::span<const int> widths_;
  ViewRows& rows_;
  Mount mount_;
  CameraIntrinsics camera_;
  PoseTimes times_;
  ViewRows::RowMajorMatrix by_points_;  // derivatives of a circle's pose, if there are no times
};

DisplacementField fieldOf(const CircleModel& model, std::span<const CircleMeasurement> circles) {
  if (model.modes.size() == 0) return {};
  std::vector<DisplacementField::Circle> displaced;
  for (const CircleMeasurement& circle : circles) displaced.push_back({circle.point, circle.rho});
  return {model.modes, displaced};
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

ViewCost::ViewCost(const CircleModel& model, const SegmentTimes& segments,
                   std::vector<CircleMeasurement> circles, PoseColumns columns)
    : model_(model),
      segments_(segments),
      circles_(std::move(circles)),
      field_(fieldOf(model, circles_)),
      columns_(columns) {
  std::vector<int>& sizes = *mutable_parameter_block_sizes();
  sizes.assign(rotationPointsOf(segments), 4);
  sizes.insert(sizes.end(), positionPointsOf(segments), 3);
  sizes.insert(sizes.end(), kBlockSizes.begin(), kBlockSizes.end() - (model.free_intrinsics ? 0 : 1));
  set_num_residuals(2 * static_cast<int>(circles_.size()));
  if (!model.free_intrinsics) return;
  seen_.reserve(circles_.size());
  for (const CircleMeasurement& circle : circles_)
    seen_.push_back(seenCentre(model.camera, circle.centre_px));
}

void ViewCost::evaluate(double const* const* parameters, std::span<const int> widths, ViewRows& rows) const {
  if (ViewEvaluation(model_, segments_, parameters, widths, rows).run(circles_, seen_, columns_))
    field_.whiten(rows.values.data(), rows.stride);
  shorten(rows);
}

std::vector<double> ViewCost::errorsInSigmas(double const* const* parameters) const {
  ViewRows rows;
  ViewEvaluation(model_, segments_, parameters, {}, rows).run(circles_, seen_, columns_);
  std::ranges::replace(rows.values, kBehindCamera_sigma, std::numeric_limits<double>::infinity());
  return std::move(rows.values);
}

void ViewCost::shorten(ViewRows& rows) const {
  const Eigen::Index columns = rows.stride - 1;
  for (Eigen::Index k = 0; k < num_residuals(); k += 2) {
    double *const first = rows.values.data() + k * rows.stride, *const second = first + rows.stride;
    Vector2d error(first[columns], second[columns]);
    if (error.norm() <= model_.huber_sigma || error.x() == kBehindCamera_sigma) continue;
    const Eigen::Matrix2d by_error = shortenByHuber(model_.huber_sigma, error);
    for (Eigen::Index at = 0; at < columns; ++at) {
      const Vector2d column = by_error * Vector2d(first[at], second[at]);
      first[at] = column.x();
      second[at] = column.y();
    }
    first[columns] = error.x();
    second[columns] = error.y();
  }
}

bool ViewCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const std::size_t points = controlPoints(), own = parameter_block_sizes().size() - points;
  std::array<int, kBlocks> widths{};
  for (std::size_t block = 0; jacobians && block < own; ++block)
    if (jacobians[points + block]) widths[block] = tangentSize(kBlockSizes[block]);
  ViewRows rows;
  evaluate(parameters, {widths.data(), jacobians ? own : 0}, rows);
  ViewRows::RowMajorMatrix all =
      Eigen::Map<const ViewRows::RowMajorMatrix>(rows.values.data(), num_residuals(), rows.stride);
  Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = all.rightCols<1>();
  if (rows.chain.size() > 0) {
    const ViewRows::RowMajorMatrix others = all.rightCols(rows.stride - rows.poses);
    const ViewRows::RowMajorMatrix by_points = all.leftCols(rows.poses) * rows.chain;
    all.resize(num_residuals(), by_points.cols() + others.cols());
    all << by_points, others;
  }
  Eigen::Index at = 0;
  for (std::size_t block = 0; jacobians && block < points + own; ++block) {
    const int width = block < points ? 3 : widths[block - points];
    if (jacobians[block]) {
      Eigen::Map<ViewRows::RowMajorMatrix> by_block(jacobians[block], num_residuals(),
                                                    parameter_block_sizes()[block]);
      by_block.setZero();
      by_block.leftCols(width) = all.middleCols(at, width);
    }
    at += width;
  }
  return true;
}

}  // namespace evical
