// Widths of the weak priors on parameters that the recording may not determine.
#pragma once

#include "core/base/option_struct.h"

namespace evical {

struct PriorOptions {
  double camera_focal_length_sigma;
  double camera_principal_point_sigma_px;
  double camera_distortion_sigma;
  double edge_localisation_bias_sigma_px;
  double slow_edge_localisation_bias_sigma_px;
  double longest_readout_ms;
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

}  // namespace evical
