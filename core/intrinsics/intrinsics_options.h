// Options of the calibration of camera intrinsics.
#pragma once

#include "core/base/option_row.h"

namespace evical {

// Automatic, or the models in the order of CameraModel.
enum class IntrinsicsModel { Automatic, PinholeRadtan, PinholeEquidistant, DoubleSphere, Eucm, OmniRadtan };

struct IntrinsicsOptions {
  IntrinsicsModel model;
  double equidistant_gain;
  double double_sphere_gain;
  int radtan_coefficients;
  double first_look_period_s;
  double first_look_length_s;
  int first_look_slices;
  double first_look_projection_px;
  int min_views;
  int max_views;
  double min_view_spacing_s;
  double min_circles;
  double huber_sigma;
  double outlier_sigma;
  double outlier_view_fraction;
  double min_centre_sigma_px;
  double edge_localisation_bias_sigma_px;
  double correlation_time_s;
  double place_error_px;
  int max_iterations;
  int max_passes;
  double settled_px;
  double needed_focal_length;
  double needed_projection_px;
  double min_tilt_deg;

  IntrinsicsOptions();  // the defaults
  constexpr explicit IntrinsicsOptions(NoDefaults) {}
  bool operator==(const IntrinsicsOptions&) const = default;
  static const OptionTable<IntrinsicsOptions>& table();
};

}  // namespace evical
