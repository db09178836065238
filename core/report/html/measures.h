// Measures of a recording: positions of the board, motion, residuals. Plots and advice use them.
#pragma once

#include "core/report/html/html_report.h"
#include "core/report/residual_statistics.h"

#include <Eigen/Core>

#include <array>
#include <vector>

namespace evical::html {

// One cell of the image plane: number of circles measured in it, and the mean of their residuals.
struct SensorCell {
  Eigen::Vector2d low_px = Eigen::Vector2d::Zero(), high_px = Eigen::Vector2d::Zero();  // on the sensor
  int circles = 0, residuals = 0;
  Eigen::Vector2d mean_residual_px = Eigen::Vector2d::Zero();  // predicted - measured
};

// Pose of the board in one view, from the trajectory.
struct BoardPose {
  double time_s = 0.0, distance_m = 0.0;
  double tilt_x_deg = 0.0, tilt_y_deg = 0.0;  // of its normal, about the camera's x and y axes
  double turn_deg = 0.0;                      // about the optical axis
};

struct CameraMeasures {
  static constexpr int kCols = 8, kRows = 6;  // of the image cells
  Resolution resolution_px;
  std::array<int, kWindowOutcomeCount> outcomes = {};
  int windows = 0, views = 0, partial = 0;
  double duration_s = 0.0;
  std::vector<Eigen::Vector2d> centres_px;  // on the sensor
  std::vector<SensorCell> cells;            // row by row; empty if the resolution is unknown
  std::vector<BoardPose> poses;             // empty without a trajectory

  // Includes windows that were rejected by hand.
  int found() const { return views + outcomes[static_cast<std::size_t>(WindowOutcome::RejectedByHand)]; }
  double detectionRate() const { return windows > 0 ? static_cast<double>(found()) / windows : 0.0; }
  double coveredShare() const;  // share of the cells with at least one circle
};

struct AxisMoments {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), deviation = Eigen::Vector3d::Zero(),
                  largest = Eigen::Vector3d::Zero();  // |value - mean|
};

struct ImuMeasures {
  double rate_hz = 0.0, duration_s = 0.0;
  AxisMoments rate_rad_s, force_m_s2;                     // as measured
  SignalPrediction signals;                               // empty without a trajectory
  AxisMoments rate_residual, force_residual;              // measured - predicted
  double rate_sigma_rad_s = 0.0, force_sigma_m_s2 = 0.0;  // of a sample, from the given noise densities
};

struct Measures {
  std::vector<CameraMeasures> cameras;
  std::vector<ImuMeasures> imus;
  double duration_s = 0.0;
};

Measures measure(const ReportData& data);

}  // namespace evical::html
