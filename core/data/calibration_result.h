// Result of a calibration: the state, its uncertainty, and how well it explains the data.
#pragma once

#include "core/base/error.h"
#include "core/data/calibration_state.h"
#include "core/data/calibration_status.h"
#include "core/data/quality_warning.h"
#include "core/data/quantity_address.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace evical {

struct Timing {
  double read_s = 0.0, detect_s = 0.0, initialise_s = 0.0, optimise_s = 0.0, split_half_check_s = 0.0,
         total_s = 0.0;
};

struct CameraUncertainty {
  Eigen::Vector3d rotation_std_rad = Eigen::Vector3d::Zero();   // about the reference's axes
  Eigen::Vector3d translation_std_m = Eigen::Vector3d::Zero();  // in the reference
  double time_offset_std_s = 0.0;
  double edge_localisation_bias_std_px = 0.0;
  double slow_edge_localisation_bias_std_px = 0.0;
  // Sigmas of the lens in use if this recording determined it, in the order of IntrinsicsJacobian
  // (camera_model.h); 0 for fixed coefficients.
  std::optional<std::array<double, 9>> intrinsics_std = {};
  double time_offset_drift_std_ppm = 0.0;
  double line_delay_std_us = 0.0;
  double exposure_share_std = 0.0;
};

struct ImuUncertainty {
  Eigen::Vector3d rotation_std_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d translation_std_m = Eigen::Vector3d::Zero();
  double time_offset_std_s = 0.0;
  Eigen::Vector3d gyroscope_bias_std_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias_std_m_s2 = Eigen::Vector3d::Zero();
  Eigen::Matrix3d gyroscope_scale_misalignment_std = Eigen::Matrix3d::Zero();  // upper triangle
  Eigen::Matrix3d accelerometer_scale_misalignment_std = Eigen::Matrix3d::Zero();
  // Sigmas of the biases at the knots of their drift.
  std::vector<Eigen::Vector3d> gyroscope_drift_std_rad_s, accelerometer_drift_std_m_s2;
  Eigen::Vector3d gyroscope_rotation_std_rad = Eigen::Vector3d::Zero();  // about the accelerometer's axes
  double time_offset_drift_std_ppm = 0.0;
  double accelerometer_delay_std_s = 0.0;
};

struct BoardUncertainty {
  Eigen::Vector3d rotation_std_rad = Eigen::Vector3d::Zero();   // about the world's axes
  Eigen::Vector3d translation_std_m = Eigen::Vector3d::Zero();  // in the world
  double scale_std = 0.0, stretch_std = 0.0;
  double row_curvature_std_1_m = 0.0, column_curvature_std_1_m = 0.0, twist_std_1_m = 0.0;
};

// Uncertainty of all calibrated quantities, in the order of `columns`. In SI units, as in QuantityPart::unit.
struct UncertaintyReport {
  std::vector<QuantityAddress> columns;
  Eigen::VectorXd standard_deviations;
  Eigen::MatrixXd correlation;
  std::vector<CameraUncertainty> cameras;
  std::vector<ImuUncertainty> imus;
  BoardUncertainty board;
  std::vector<BoardUncertainty> further_boards;
  std::vector<std::string> given;  // fixed at known values, not estimated: "left.time_offset"
  double gravity_direction_std_rad = 0.0;
  double gravity_norm_std_m_s2 = 0.0;  // 0: its norm is fixed

  // Eigenvalues of the information matrix in units of the required accuracy (0.1 deg, 1 mm, 0.1 ms), with the
  // board and gravity known: below 1, the requirement is not met in that direction. Ascending.
  std::vector<double> observability;
  std::string weakest;                  // "translation along the camera's z axis"
  std::vector<std::string> directions;  // description of each of `observability`; empty in older files

  Eigen::MatrixXd covariance() const {
    return standard_deviations.asDiagonal() * correlation * standard_deviations.asDiagonal();
  }
  // Index 0 is the world's board.
  BoardUncertainty& boardAt(std::size_t index) { return index == 0 ? board : further_boards.at(index - 1); }
  const BoardUncertainty& boardAt(std::size_t index) const {
    return index == 0 ? board : further_boards.at(index - 1);
  }
};

// Latency between two cameras that share one sensor: how much later the first one stamps the same scene (a
// DAVIS's events compared with its frames), in the middle of the recording.
struct SensorLatency {
  std::size_t camera = 0, against = 0;
  double latency_s = 0.0, std_s = 0.0;
};

struct CameraFit {
  double reprojection_rms_px = 0.0;
  double normalised_rms = 0.0;       // of residuals divided by their sigmas, with weights
  double neighbour_agreement = 0.0;  // correlation of the errors of neighbouring circles in an event window
  int windows_total = 0, windows_complete = 0, windows_partial = 0, windows_used = 0;
  int windows_rejected = 0;  // by a user
  int circles_used = 0, circles_rejected = 0;
};

struct ImuFit {
  double gyroscope_rms_rad_s = 0.0;
  double accelerometer_rms_m_s2 = 0.0;
};

// One optimiser iteration, for convergence curves.
struct IterationRecord {
  int stage = 0, iteration = 0;
  double cost = 0.0, gradient = 0.0, step = 0.0;
  std::vector<CameraState> cameras;
  std::vector<std::string> released =
      {};  // first iteration of a stage: quantities that were fixed in the stage before
};

// One residual of one circle, for plots and CSV.
struct CircleResidual {
  int camera = 0, view = 0, circle = 0;
  double time_s = 0.0;
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero(), residual_px = Eigen::Vector2d::Zero(),
                  sigma_px = Eigen::Vector2d::Zero();
  bool used = true;
};

// A window with the board that a user rejected.
struct RejectedWindow {
  std::size_t camera = 0;
  double time_s = 0.0;  // middle of the window, on the camera's clock since the recording's start

  bool operator==(const RejectedWindow&) const = default;
};

// Difference of one number of a quantity between two estimates: the halves of a recording, or a result and
// the truth.
struct QuantityDifference {
  std::string name, unit;                // "left.rotation.x", "deg"
  double difference = 0.0, sigma = 0.0;  // sigma of the difference; 0: not estimated, or unknown

  double normalised() const { return sigma > 0.0 ? difference / sigma : 0.0; }
};

// Separate estimates from alternating blocks of the recording: if the sigmas are correct, they differ by
// about one sigma.
struct SplitHalfCheck {
  double block_s = 0.0;
  std::array<int, 2> windows = {0, 0};  // with the board, per half
  std::vector<QuantityDifference> quantities;
  double rms_sigmas = 0.0;  // over the quantities that have a sigma
  std::string failure;      // why a half could not be estimated; empty if there is no failure
};

struct CalibrationResult {
  CalibrationStatus status = CalibrationStatus::Ok;
  std::string reason;                    // why not ok
  std::optional<Repair> repair;          // of the first reason
  std::vector<QualityWarning> causes;    // the separate reasons, the likeliest first
  std::vector<QualityWarning> freed;     // options that were `auto` and had to be set, with the reason
  std::optional<std::int64_t> start_ns;  // of the recording: origin of times in seconds
  CalibrationState state;
  UncertaintyReport uncertainty;
  std::vector<SensorLatency> latencies;
  std::vector<CameraFit> cameras;
  std::vector<ImuFit> imus;
  std::vector<IterationRecord> iterations;
  std::vector<CircleResidual> circle_residuals;
  std::vector<RejectedWindow> rejected_windows;    // by a user: camera by camera, in time order
  std::optional<SplitHalfCheck> split_half_check;  // absent if not requested
  std::vector<std::string> notes;                  // messages of initialisation and data checks
  Timing timing;
  double memory_peak_mb = 0.0;
};

}  // namespace evical
