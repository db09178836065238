// Options of initialisation.
#pragma once

#include "core/base/option_row.h"

namespace evical {

struct InitialisationOptions {
  double knot_spacing_s;
  double time_offset_search_s;
  double widest_time_offset_search_s;
  double max_reprojection_px;
  double max_rotation_disagreement_rad;
  double clear_peak_correlation;
  double clear_peak_lead;
  double max_unexplained_motion;
  double suspicious_motion;
  double far_better;
  double much_better;
  double pair_gap_s;
  double max_pair_s;
  int min_views;
  double min_overlap_s;
  double min_rotation_rate_rad_s;
  double gravity_m_s2;
  double margin_s;
  double max_imu_gap_s;
  double min_axis_ratio;
  double position_sigma_m;
  double acceleration_sigma_m_s2;
  double translation_sigma_m;
  double accelerometer_bias_sigma_m_s2;
  double accelerometer_scale_misalignment_sigma;
  double max_scale_error;
  double scale_error_sigmas;
  double camera_knot_spacing_s;
  double max_shared_gap_s;
  double max_bridge_s;
  int min_bridges;
  double min_bridge_agreement;
  double min_board_agreement;
  int min_imu_samples;
  double min_acceleration_m_s2;
  double max_acceleration_m_s2;
  double max_rotation_rate_rad_s;
  double wrong_rate_ratio;
  double rate_unit_tolerance;
  double wrong_force_ratio;
  double force_unit_tolerance;
  double wrong_size_ratio;
  double settled_size;
  double wrong_radius_ratio;
  double wrong_lens_share;
  double wrong_lens_sigmas;
  double wrong_noise_ratio;
  double noise_agreement_ratio;
  double noise_unit_ratio;
  double wrong_clock_prior_sigmas;
  double wrong_clock_sigmas;
  double wrong_clock_share;
  double gravity_rate_tolerance;
  double exchanged_force_share;
  double min_imu_coverage;
  double turning_camera_ratio;
  double heavy_saturation_share;
  double same_motion_correlation;
  double ambiguous_pose_ratio;
  double ambiguous_pose_px;
  double fastest_view_ratio;
  int max_time_offsets;
  double time_offset_reach_s;
  double better_alignment;
  double agreement_window_s;
  double min_agreement;
  double outlier_sigma;

  InitialisationOptions();  // the defaults
  constexpr explicit InitialisationOptions(NoDefaults) {}
  bool operator==(const InitialisationOptions&) const = default;
  static const OptionTable<InitialisationOptions>& table();
};

}  // namespace evical
