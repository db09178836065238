// Options of a camera's rotation without a board, aligned with an IMU's. docs/maths.md, 16.
#pragma once

#include "core/base/option_row.h"

namespace evical {

struct EgomotionOptions {
  double window_s;
  int min_slopes;
  int max_slopes;
  double time_noise_s;
  double place_noise_px;
  int depth_columns;
  int depth_rows;
  double depth_spread;
  double depth_error;
  double min_inliers;
  double min_speed_px_s;
  double max_sigma_rad_s;
  int kept_windows;
  int kept_slopes;
  double velocity_weight;
  double lever_sigma;
  double shared_slopes;
  double far_sigmas;
  double depths_left;
  double translation_left;
  double block_s;
  int min_blocks;
  double search_s;

  EgomotionOptions();  // the defaults
  constexpr explicit EgomotionOptions(NoDefaults) {}
  bool operator==(const EgomotionOptions&) const = default;
  static const OptionTable<EgomotionOptions>& table();
};

}  // namespace evical
