// Options of the reported sigmas, and limits beyond which a result is doubtful.
#pragma once

#include "core/base/option_struct.h"

namespace evical {

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
  double largest_scale_share;
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

}  // namespace evical
