// Camera intrinsics from board views, and their uncertainty. Parameters in the order of IntrinsicsJacobian
// (camera_model.h): fx fy cx cy d0 d1 d2 d3 d4.
#pragma once

#include "core/data/calibration_status.h"

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical {

inline constexpr int kIntrinsicsCount = 9;
using IntrinsicsVector = Eigen::Matrix<double, kIntrinsicsCount, 1>;
using IntrinsicsMatrix = Eigen::Matrix<double, kIntrinsicsCount, kIntrinsicsCount>;

// A rectangular cell of the image.
struct ImageCell {
  Eigen::Vector2d middle_px = Eigen::Vector2d::Zero();
  int circles = 0;        // in the used views
  double sigma_px = 0.0;  // of the projection of a given ray; infinite if there is no ray
};

struct ImageMap {
  int columns = 0, rows = 0;
  std::vector<ImageCell> cells;  // row by row
  double rms_px = 0.0, max_px = 0.0;
};

struct IntrinsicsResult {
  CalibrationStatus status = CalibrationStatus::Ok;
  std::string reason;               // why not ok
  std::vector<std::string> advice;  // additional views that would improve the result
  CameraIntrinsics intrinsics;
  IntrinsicsMatrix covariance = IntrinsicsMatrix::Zero();  // zero for fixed parameters
  double edge_localisation_bias_px = 0.0, edge_localisation_bias_std_px = 0.0;
  ImageMap image;                    // coverage and projection uncertainty
  double reprojection_rms_px = 0.0;  // of distances, on the sensor
  double normalised_rms = 0.0;       // of residuals divided by their sigmas
  double largest_tilt_deg = 0.0;     // of the board relative to the image plane, in the used views
  int views_found = 0, views_used = 0, circles_used = 0, circles_rejected = 0;
  int passes = 0;         // over the recording
  double moved_px = 0.0;  // change of projections by the last refit, RMS over the image
  double elapsed_s = 0.0;

  IntrinsicsVector standardDeviations() const { return covariance.diagonal().cwiseMax(0.0).cwiseSqrt(); }
};

// Number of coefficients in use: all of the model; 4 for radtan, or 5 with k3.
inline int distortionCount(const CameraIntrinsics& camera) {
  const bool without_k3 = camera.model == CameraModel::PinholeRadtan && camera.distortion[4] == 0.0;
  return coefficientCount(camera.model) - (without_k3 ? 1 : 0);
}

// History of an intrinsics calibration, for display; not part of results and their files.

// A tested model, and how well it explained the views.
struct TriedModel {
  CameraModel model = CameraModel::PinholeRadtan;
  double spread_sigma = 0.0;  // median-based spread of normalised errors
  int circles_used = 0, circles = 0;
};

// Pose of the board in a used view.
struct IntrinsicsView {
  double time_s = 0.0;
  double distance_m = 0.0;  // from the camera to the board's middle
  double tilt_deg = 0.0;    // of the board relative to the image plane
  int circles = 0;          // used
  double reprojection_rms_px = 0.0;
};

struct IntrinsicsStory {
  std::vector<TriedModel> tried;      // includes the selected one; empty if the model was not changed
  std::vector<IntrinsicsView> views;  // in order of time
};

}  // namespace evical
