// Options of the maintenance with logs of IMUs, and thresholds of a change.
#pragma once

#include "core/base/option_row.h"

namespace evical {

struct MaintenanceOptions {
  double gravity_m_s2;
  double min_stop_s;
  double still_rate_deg_s;
  double still_force_m_s2;
  double stop_above_quietest;
  double stop_rate_rad_s;
  double stop_force_m_s2;
  double gap_s;
  double far_stop_sigmas;
  double left_out_stops;
  double smoothing_s;
  double window_s;
  double lag_s;
  double pose_interval_s;
  double trajectory_gap;
  double trajectory_scale;
  double trajectory_lever_mm;
  double time_offset_search_s;
  double time_offset_drift_ppm;
  double min_rate_rad_s;
  double same_motion;
  double restless_window;
  double mostly_noise;
  double settled_s;
  double start_s;
  double naming_s;
  double false_alarms;
  double stability_rotation_deg;
  double stability_translation_mm;
  double stability_time_offset_ms;
  double stability_accelerometer_bias_m_s2;
  double stability_gyroscope_bias_rad_s;
  double stability_imu_scale;
  double accelerometer_walk;
  double gyroscope_walk;
  double matters_rotation_deg;
  double matters_translation_mm;
  double matters_time_offset_ms;
  double matters_accelerometer_bias_m_s2;
  double matters_gyroscope_bias_rad_s;
  double matters_imu_scale;

  MaintenanceOptions();  // the defaults
  constexpr explicit MaintenanceOptions(NoDefaults) {}
  bool operator==(const MaintenanceOptions&) const = default;
  static const OptionTable<MaintenanceOptions>& table();
};

}  // namespace evical
