// Zero when the measured ellipse centres are those of the projected circles, displaced by the edge localisation
// bias along their image motion (docs/maths.md, 9.1):
//   r = L^-1 [ centre(camera_from_world(t), circle) + lead (edge_localisation_bias.h) - measured ],
//   t = t_measured + time_offset + time_offset_drift (t_measured - t_0) + line_delay (row - middle row)
//     + exposure_share (exposure - mean exposure),
//   camera_from_world(t) = (world_from_imu(t) reference_from_camera)^-1,
// L the Cholesky factor of the centre's covariance, ideal pixels. The residuals of a view are then whitened
// for the displacement that its circles have in common (common_displacement.h), and each circle's residual is
// shortened so that its square is Huber's loss. One cost function holds all circles of one camera whose times
// fall into one spline segment: they share parameter blocks, and a block per circle would leave Ceres with
// bookkeeping only.
//
// With free intrinsics, the prediction is that of free_intrinsics.h.
//
// Blocks: 4 rotation control points (x y z w), 4 position control points [m], reference_from_camera
// rotation (x y z w) and translation [m], time offset [s] and its drift [ppm], line delay [us], edge
// localisation bias [px] and that of slow edges [px], the board's scale, stretch, two curvatures and twist
// [1/m] (BoardState; its circles keep the radius that was given and the plane's normal, which changes their
// centres by far less than could be seen), the exposure's share, world_from_board's rotation (x y z w) and
// translation [m]; where intrinsics are free also those, fx fy cx cy d0..d4. Without unit. Quaternion blocks
// as in so3_manifold.h.
//
// v is the measured image velocity: of the right direction to a percent or so where it matters, and it keeps
// the lead linear.
#pragma once

#include "core/data/calibration_state.h"
#include "core/geometry/intrinsics_numbers.h"
#include "core/optimisation/common_displacement.h"
#include "core/optimisation/edge_localisation_bias.h"
#include "core/optimisation/free_intrinsics.h"
#include "core/optimisation/spline_segment.h"

#include <ceres/cost_function.h>
#include <Eigen/Core>

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
  double common_px = 0.0;                                    // commonDisplacement_px
  int view = 0, circle = 0;                                  // circle: position in the view's list
  int point = 0, place = 0;  // index on the board; cell of the image (placeOf)
};

// Data that all circles of one camera share.
struct CircleModel {
  CameraIntrinsics camera;  // that was seen with
  double radius_m = 0.0;
  double huber_sigma = 0.0;
  bool free_intrinsics = false;
};

class CircleCost final : public ceres::CostFunction {
 public:
  CircleCost(const CircleModel& model, const SegmentTimes& segment, std::vector<CircleMeasurement> circles);

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

  const std::vector<CircleMeasurement>& circles() const { return circles_; }
  // Removes the common displacement of each view from errors over sigmas: two for each circle.
  void whitenViews(double* errors) const { whitenViews(errors, nullptr); }

 private:
  void whitenViews(double* residuals, double** jacobians) const;
  void shorten(double* residuals, double** jacobians) const;

  const CircleModel& model_;
  SegmentTimes segment_;
  std::vector<CircleMeasurement> circles_;
  std::vector<SeenCentre> seen_;            // of the circles, where intrinsics are free
  std::vector<CommonDisplacement> common_;  // by view
};

// Shortens r so that |result|^2 is Huber's loss of |r|^2 (r^2 up to the threshold d, 2 d |r| - d^2 beyond)
// and returns the derivative of the result by r.
Eigen::Matrix2d shortenByHuber(double threshold, Eigen::Vector2d& residual);

}  // namespace evical
