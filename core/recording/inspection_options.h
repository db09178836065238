// When `inspect` and the pipeline call something a fault of a recording.
#pragma once

#include "core/base/option_field.h"

#include <tuple>

namespace evical {

struct InspectionOptions {
  double event_gap_s = 0.1;
  double imu_gap_periods = 1.8;
  double imu_jitter_periods = 0.2;
  double stuck_axis_s = 1.0;
  int saturated_run_samples = 4;
  double saturated_from_rad_s = 2.0;
  double saturated_from_m_s2 = 15.0;
  double gravity_tolerance_m_s2 = 0.8;
  double largest_rate_rad_s = 36.0;
  double hot_pixel_factor = 8.0;
  double hot_pixel_hz = 10.0;
  int hot_pixel_events = 100;
  bool operator==(const InspectionOptions&) const = default;
};
inline constexpr auto kInspectionFields = std::tuple{
    Field{"event_gap_s", &InspectionOptions::event_gap_s, 1e-3, 10.0, "s", "Longest time without any event."},
    Field{"imu_gap_periods", &InspectionOptions::imu_gap_periods, 1.1, 100.0, "",
          "Longest time between IMU samples, in their median interval."},
    Field{"imu_jitter_periods", &InspectionOptions::imu_jitter_periods, 0.01, 1.0, "",
          "Largest RMS of IMU intervals about their median, in medians; gaps do not count."},
    Field{"stuck_axis_s", &InspectionOptions::stuck_axis_s, 0.05, 100.0, "s",
          "An IMU axis that does not change for so long is stuck."},
    Field{"saturated_run_samples", &InspectionOptions::saturated_run_samples, 2, 1000, "",
          "So many equal samples in a row at an axis's extreme are a saturation."},
    Field{"saturated_from_rad_s", &InspectionOptions::saturated_from_rad_s, 0.0, 100.0, "rad/s",
          "Smallest full scale of gyroscopes."},
    Field{"saturated_from_m_s2", &InspectionOptions::saturated_from_m_s2, 0.0, 1000.0, "m/s^2",
          "Smallest full scale of accelerometers."},
    Field{"gravity_tolerance_m_s2", &InspectionOptions::gravity_tolerance_m_s2, 0.1, 5.0, "m/s^2",
          "How far the median norm of the specific force may lie from 9.81 m/s^2."},
    Field{"largest_rate_rad_s", &InspectionOptions::largest_rate_rad_s, 1.0, 1000.0, "rad/s",
          "Beyond this (2000 deg/s are 34.9 rad/s) the angular rate cannot be in rad/s."},
    Field{"hot_pixel_factor", &InspectionOptions::hot_pixel_factor, 2.0, 1000.0, "",
          "A hot pixel has so many times the events of its neighbours, and of the mean pixel."},
    Field{"hot_pixel_hz", &InspectionOptions::hot_pixel_hz, 0.1, 1e5, "Hz", "Lowest rate of a hot pixel."},
    Field{"hot_pixel_events", &InspectionOptions::hot_pixel_events, 1, 1000000, "",
          "Fewest events that tell a hot pixel from chance."}};
static_assert(fieldCount<InspectionOptions>() == std::tuple_size_v<decltype(kInspectionFields)>);

}  // namespace evical
