// Zero when the measured ellipse centres of one view are those of the projected circles, displaced by the edge localisation
// bias along their image motion (docs/maths.md, 9.1):
//   r = L^-1 [ centre(camera_from_world(t), circle) + lead (edge_localisation_bias.h) - measured ],
//   t = t_measured + time_offset + time_offset_drift (t_measured - t_0) + line_delay (row - middle row)
//     + exposure_share (exposure - mean exposure),
//   camera_from_world(t) = (world_from_imu(t) reference_from_camera)^-1,
// L the Cholesky factor of the centre's covariance, ideal pixels. The residuals of the view are then whitened
// for the displacement field of its circles (displacement_field.h), and each circle's residual is
// shortened so that its square is Huber's loss.
//
// With free intrinsics, the prediction is that of free_intrinsics.h.
//
// Blocks: rotation control points (x y z w) and position control points [m] of the view's segments, then
// reference_from_camera rotation (x y z w) and translation [m], time offset [s] and its drift [ppm], line delay [us], edge
// localisation bias [px] and that of slow edges [px], the board's scale, stretch, two curvatures and twist
// [1/m] (BoardState; its circles keep the radius that was given and the plane's normal, which changes their
// centres by far less than could be seen), the exposure's share, world_from_board's rotation (x y z w) and
// translation [m]; where intrinsics are free also those, fx fy cx cy d0..d4. Without unit. Quaternion blocks
// as in so3_manifold.h.
//
// v is the measured image velocity: of the right direction to a percent or so where it matters, and it keeps
// the lead linear.
//
// Control points and the camera's pose in the rig move the circles only through the camera's pose at their times. So the
// derivatives are by that pose at one to three times (core/geometry/pose_times.h), and the products of all circles go to the
// control points at once (docs/maths.md, 9.15). Longer views have derivatives by control points.
#pragma once

#include "core/data/calibration_state.h"
#include "core/geometry/intrinsics_numbers.h"
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

struct CircleMeasurement {
  double time_s = 0.0;         // camera clock
  double by_drift_s = 0.0;     // how far each ppm of its drift moves that
  double by_line_s = 0.0;      // and each microsecond of line delay
  double by_exposure_s = 0.0;  // and all of what the frame was exposed longer than others
  Eigen::Vector2d on_board_m, centre_px;
  Eigen::Matrix2d whitening_px;  // L^-1
  EdgeLocalisationBiasEffect lead;
  Eigen::Vector2d pixel_error_px = Eigen::Vector2d::Zero();  // PixelErrors::at
  double rho = 0.0;                                          // of DisplacementField
  int point = 0, place = 0;  // index on the board; cell of the image (placeOf)
};

// Data that all circles of one camera share.
struct CircleModel {
  CameraIntrinsics camera;  // that was seen with
  double radius_m = 0.0;
  double huber_sigma = 0.0;
  FieldModes modes;  // of the displacement; none without one
  bool free_intrinsics = false;
};

// Two rows for each circle, in columns of the tangent space: the camera's poses at some times, or the control points and the
// camera's pose in the rig; the view's other free blocks; and the residual.
struct ViewRows {
  using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Eigen::Index stride = 0, poses = 0;  // poses: columns of the poses, or of control points and camera
  std::vector<double> values;          // row-major; at least as many as needed
  // Derivatives of the poses at the times by control points, and by the camera's pose if it is free; empty if rows have
  // these columns.
  RowMajorMatrix chain;
};

class ViewCost final : public ceres::CostFunction {
 public:
  enum class PoseColumns { AtTimes, ControlPoints };
  // `circles` in order of time. Derivatives by control points are exact, as tests want them.
  ViewCost(const CircleModel& model, const SegmentTimes& segments, std::vector<CircleMeasurement> circles,
           PoseColumns columns = PoseColumns::AtTimes);

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

  // `widths`: columns of each block after the control points, 0 if it is fixed. Without any, rows are residuals only.
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
