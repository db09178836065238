// Options of the batch optimisation, in four groups; code that needs one group takes only that group.
#pragma once

#include "core/base/option_row.h"

namespace evical {

enum class CameraIntrinsicsChoice { Fixed, Free };
// Auto: estimated once a test shows for certain that it is needed.
enum class Estimated { Auto, No, Yes };
enum class BiasModel { Auto, Constant, Linear };

// Options of what the batch optimisation estimates, and of how it weights measurements.
struct ModelOptions {
  bool free_time_offsets;
  bool time_offset_drift;
  bool free_imu_intrinsics;
  bool free_gravity_norm;
  bool free_board_size;
  bool board_bow;
  Estimated line_delay;
  bool share_sensors;
  CameraIntrinsicsChoice camera_intrinsics;
  Estimated gyroscope_rotation;
  double delay_misfit;
  double unknown_delay_sigma_s;
  BiasModel bias_model;
  double bias_knot_spacing_s;
  int max_bias_knots;
  double gyroscope_random_walk;
  double accelerometer_random_walk;
  double slow_edge_speed_px_s;
  double min_centre_sigma_px;
  double displacement_px, displacement_px2_s, displacement_px_s;
  double displacement_length_spacings, displacement_constant_share, displacement_persistence;
  double displacement_size_sigma, displacement_remainder;
  int displacement_views;
  double huber_sigma;
  double outlier_sigma;
  double outlier_window_fraction;

  ModelOptions();  // the defaults
  constexpr explicit ModelOptions(NoDefaults) {}
  bool estimatesLineDelays() const { return line_delay == Estimated::Yes; }
  bool estimatesGyroscopeRotations() const { return gyroscope_rotation == Estimated::Yes; }
  bool hasLinearBiases() const { return bias_model == BiasModel::Linear; }
  bool freesIntrinsics() const { return camera_intrinsics == CameraIntrinsicsChoice::Free; }
  bool operator==(const ModelOptions&) const = default;
  static const OptionTable<ModelOptions>& table();
};

// Widths of the weak priors on parameters that the recording may not determine.
struct PriorOptions {
  double camera_focal_length_sigma;
  double camera_principal_point_sigma_px;
  double camera_distortion_sigma;
  double edge_localisation_bias_sigma_px;
  double slow_edge_localisation_bias_sigma_px;
  double max_readout_ms;
  double time_offset_drift_sigma_ppm;
  double exposure_share_sigma;
  double mapping_sigma;
  double gyroscope_rotation_sigma_deg;
  double accelerometer_delay_sigma_s;
  double gyroscope_bias_sigma_rad_s;
  double accelerometer_bias_sigma_m_s2;
  double translation_sigma_m;
  double gravity_norm_sigma_m_s2;
  double board_spacing_sigma;
  double board_bow_sigma_mm;
  double smooth_rotation_rad_s2;
  double smooth_position_m_s2;
  double smooth_unevenness;

  PriorOptions();  // the defaults
  constexpr explicit PriorOptions(NoDefaults) {}
  bool operator==(const PriorOptions&) const = default;
  static const OptionTable<PriorOptions>& table();
};

// Sigma of the ratio of a board's two directions, each of which was measured.
double boardStretchSigma(double spacing_sigma);

// Options of the batch optimisation's solver.
struct SolverOptions {
  double last_step_sigmas;
  double stage_tolerance;
  int max_iterations;
  int max_rounds;
  double segment_drift;
  int threads;

  SolverOptions();  // the defaults
  constexpr explicit SolverOptions(NoDefaults) {}
  bool operator==(const SolverOptions&) const = default;
  static const OptionTable<SolverOptions>& table();
};

// Options of the reported sigmas, and limits beyond which a result is doubtful.
struct VerdictOptions {
  double correlation_time_s;
  double pixel_error_px;
  double pixel_delay_ms;
  double slow_pixels_ms;
  double missed_motion_us;
  double contradiction_sigmas;
  double doubtful_contradiction_sigmas;
  double turned_gyroscope_sigmas;
  double wrong_lens_sigmas;
  double wrong_lens_px;
  double moved_lens_deg;
  double other_sensor_sigmas;
  double rolling_shutter_sigmas;
  double rolling_shutter_ms;
  double bent_board_sigmas;
  double bent_board_mm;
  double doubtful_scale_sigmas;
  double max_scale_share;
  double tag_corner_px;
  double tag_corner_sigmas;
  double doubtful_circle_misfit;
  double failed_circle_misfit;
  double doubtful_imu_misfit;
  double failed_imu_misfit;
  double scattering_stamps_misfit;
  double doubtful_outliers;
  double failed_outliers;
  double saturated_share;
  double doubtful_halves_sigmas;
  double changed_sigmas;
  bool judge_sigmas;
  double needed_rotation_deg;
  double needed_translation_mm;
  double needed_scale_mm;
  double needed_time_offset_ms;

  VerdictOptions();  // the defaults
  constexpr explicit VerdictOptions(NoDefaults) {}
  bool operator==(const VerdictOptions&) const = default;
  static const OptionTable<VerdictOptions>& table();
};

// Stages of the release of parameters.
enum class ParameterStages { Extrinsics, FurtherImus, Mappings };

struct OptimisationOptions : ModelOptions, PriorOptions, SolverOptions, VerdictOptions {
  bool operator==(const OptimisationOptions&) const = default;
};

inline ParameterStages lastStage(const ModelOptions& options) {
  return options.free_imu_intrinsics ? ParameterStages::Mappings : ParameterStages::FurtherImus;
}

}  // namespace evical
