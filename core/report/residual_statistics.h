// Statistics of one camera's reprojection residuals, prepared for plots.
#pragma once

#include "core/data/calibration_result.h"

#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace evical {

struct WindowResidual {
  int view = 0;  // index into the camera's views
  double time_s = 0.0;
  double rms_px = 0.0;  // over its used circles
  int circles = 0;
};

// Pixels are ideal ones, as in the result; those of cells are the sensor's own.
struct ResidualStatistics {
  std::vector<CircleResidual> used, dropped;  // by x of the residual; dropped: outliers to the optimiser
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();  // of those used, as all below
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();

  // Residuals of x and y over their sigmas; densities of bins of equal width.
  double bin_width = 0.0, normalised_mean = 0.0, normalised_std = 0.0;
  std::vector<double> bin_middle, bin_density;

  std::vector<WindowResidual> windows;  // in time order; without windows that have no used circles

  struct Cell {
    int count = 0;
    Eigen::Vector2d middle_px = Eigen::Vector2d::Zero(), mean_px = Eigen::Vector2d::Zero();
  };
  Resolution resolution_px;
  int columns = 0, rows = 0;
  std::vector<Cell> cells;  // row by row; empty if the intrinsics are unknown
};

ResidualStatistics residualStatistics(const std::vector<CircleResidual>& residuals, int camera,
                                      const std::optional<CameraIntrinsics>& intrinsics);

// Points of the ellipse that contains 1 - exp(-sigmas^2 / 2) of a normal distribution.
std::vector<Eigen::Vector2d> sigmaEllipse(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance,
                                          double sigmas);

}  // namespace evical
