// Statistics of one camera's reprojection residuals, prepared for plots.
#pragma once

#include "core/base/progress.h"
#include "core/data/calibration_result.h"
#include "core/data/calibration_setup.h"
#include "core/data/calibration_state.h"
#include "core/geometry/camera_intrinsics.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
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

// IMU signals predicted by the estimated trajectory, next to the measured ones, for plots.

// One entry for each sample of this sensor within both splines' range.
struct SensorSignal {
  std::vector<double> time_s;  // the IMU's own clock, since start_ns
  std::vector<Eigen::Vector3d> measured, predicted;
};

// In the IMU's own frame. Predictions include scale, misalignment, bias, lever arm, time offset and delay, so
// that measured - predicted is noise if the model is correct.
struct SignalPrediction {
  SensorSignal rate_rad_s, force_m_s2;
};

// `imu` is the index of `data` among state.imus. Throws Cancelled when asked to stop.
SignalPrediction predictSignals(const ImuData& data, std::int64_t start_ns, const CalibrationState& state,
                                std::size_t imu, const RunContext& context = {});

}  // namespace evical
