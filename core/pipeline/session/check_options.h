// Criteria for a changed calibration.
#pragma once

#include "core/base/option_struct.h"

namespace evical {

struct CheckOptions {
  double stability_rotation_deg;
  double stability_translation_mm;
  double stability_time_offset_ms;
  double stability_lens_px;
  double stability_imu_scale;
  double matters_rotation_deg;
  double matters_translation_mm;
  double matters_time_offset_ms;
  double matters_lens_px;
  double false_alarms;
  bool no_board;
  double without_board_rotation_deg;
  double without_board_time_offset_ms;
  double without_board_least_rotation_deg;
  double without_board_least_time_offset_ms;
  double without_board_misfit;
  double without_board_scale;
  double least_board_share;
  double copy_sigmas;

  CheckOptions();  // the defaults
  constexpr explicit CheckOptions(NoDefaults) {}
  bool operator==(const CheckOptions&) const = default;
  static const OptionTable<CheckOptions>& table();
};

}  // namespace evical
