// Cost of the measured ellipse centres of one view: two residuals for each circle (docs/maths.md, 9.1;
// eKalibr-Inertial, arXiv 2509.05923). Corners are circles of radius 0.
//
//   r_i = L_i^-1 [ centre(camera_from_world(t_i), circle i) + lead_i - measured_i ]
//   t_i = t_measured + time_offset + time_offset_drift (t_measured - t_0) + line_delay (row - middle row)
//         + exposure_share (exposure - mean exposure)
//   camera_from_world(t) = (world_from_imu(t) reference_from_camera)^-1
//
// L_i is the Cholesky factor of the centre's covariance in ideal pixels; lead_i is the edge localisation bias
// along the image motion (edge_localisation_bias.h), from the measured velocity, so that it is linear in its
// parameters. The residuals of the view are whitened for the displacement field of its circles
// (displacement_field.h). Then each circle's residual is shortened, so that its square is Huber's loss. With
// free intrinsics, the prediction is that of free_intrinsics.h.
//
// Parameter blocks, in this order; quaternions are x y z w, with the tangent space of calibration_problem.h:
//   size  unit  parameter
//   4     -     rotation control points of the view's segments, one block each
//   3     m     position control points of the view's segments, one block each
//   4     -     reference_from_camera, rotation
//   3     m     reference_from_camera, translation
//   1     s     time offset
//   1     ppm   time offset drift
//   1     us    line delay
//   1     px    edge localisation bias
//   1     px    additional bias of slow edges
//   1     -     board: scale
//   1     -     board: stretch
//   1     1/m   board: curvature of rows
//   1     1/m   board: curvature of columns
//   1     1/m   board: twist
//   1     -     share of the exposure
//   4     -     world_from_board, rotation
//   3     m     world_from_board, translation
//   9     -     fx fy cx cy [px], d0 ... d4, if intrinsics are free
// Bending moves the circles. Their radius and the plane's normal stay, since the change of the centres by
// these is negligible.
//
// Control points and the camera's pose in the rig move the circles only through the camera's pose at their
// times. So the derivatives are by that pose at one to three times (core/geometry/camera_motion.h), and the
// products of all circles go to the control points at once (docs/maths.md, 9.15). Longer views have
// derivatives by control points.
#pragma once

#include "core/data/calibration_state.h"
#include "core/geometry/camera_intrinsics.h"
#include "core/geometry/spline_segment.h"
#include "core/optimisation/displacement_field.h"
#include "core/optimisation/edge_localisation_bias.h"
#include "core/optimisation/free_intrinsics.h"

#include <ceres/cost_function.h>
#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace evical {

// One measured circle. Its time is on the camera's clock; the next three numbers are the derivatives of the
// time on the reference's clock by the drift, the line delay and the share of the exposure.
struct CircleMeasurement {
  double time_s = 0.0;
  double by_drift_s = 0.0;       // per ppm
  double by_line_s = 0.0;        // per us
  double by_exposure_s = 0.0;    // exposure of the frame less the mean one
  Eigen::Vector2d on_board_m;    // centre on the board
  Eigen::Vector2d centre_px;     // measured, ideal pixels
  Eigen::Matrix2d whitening_px;  // L^-1
  EdgeLocalisationBiasEffect lead;
  Eigen::Vector2d pixel_error_px = Eigen::Vector2d::Zero();  // PixelErrors::at
  double rho = 0.0;                                          // of DisplacementField
  int point = 0;                                             // index on the board
  int place = 0;                                             // cell of the image (placeOf)
};

// Data that all circles of one camera share.
struct CircleModel {
  CameraIntrinsics camera;   // those of the detection, to which ideal pixels refer
  double radius_m = 0.0;     // 0 for corners
  double huber_sigma = 0.0;  // threshold of the loss
  FieldModes modes;          // of the displacement field; none without one
  bool free_intrinsics = false;
};

// Two rows for each circle, in columns of the tangent space: the camera's poses at some times, or the control
// points and the camera's pose in the rig; the view's other free blocks; and the residual.
struct ViewRows {
  using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Eigen::Index stride = 0, poses = 0;  // poses: columns of the poses, or of control points and camera
  std::vector<double> values;          // row-major; at least as many as needed
  // Derivatives of the poses at the times by control points, and by the camera's pose if it is free; empty if
  // rows have these columns.
  RowMajorMatrix chain;
};

class ViewCost final : public ceres::CostFunction {
 public:
  enum class PoseColumns { AtTimes, ControlPoints };
  // `circles` in order of time. Derivatives by control points are exact, as tests want them.
  ViewCost(const CircleModel& model, const SegmentTimes& segments, std::vector<CircleMeasurement> circles,
           PoseColumns columns = PoseColumns::AtTimes);

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

  // `widths`: columns of each block after the control points, 0 if it is fixed. Without any, rows are
  // residuals only.
  void evaluate(double const* const* parameters, std::span<const int> widths, ViewRows& rows) const;
  // Errors before the displacement field is removed: two for each circle, infinite behind the camera.
  std::vector<double> errorsInSigmas(double const* const* parameters) const;

  std::size_t controlPoints() const { return controlPointsOf(segments_); }
  const std::vector<CircleMeasurement>& circles() const { return circles_; }
  // Removes the displacement field of the view from errors over sigmas: two for each circle.
  void whiten(double* errors) const { field_.whiten(errors, 1); }

 private:
  void shorten(ViewRows& rows) const;

  const CircleModel& model_;
  SegmentTimes segments_;
  std::vector<CircleMeasurement> circles_;
  std::vector<SeenCentre> seen_;  // of the circles, where intrinsics are free
  DisplacementField field_;
  PoseColumns columns_;
};

// Shortens r so that |result|^2 is Huber's loss of |r|^2 (r^2 up to the threshold d, 2 d |r| - d^2 beyond)
// and returns the derivative of the result by r.
Eigen::Matrix2d shortenByHuber(double threshold, Eigen::Vector2d& residual);

}  // namespace evical
