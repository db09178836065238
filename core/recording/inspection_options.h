// Limits beyond which `inspect` and the pipeline report a fault of a recording.
#pragma once

namespace evical {

struct InspectionOptions {
  double event_gap_s = 0.1;             // longest time without any event
  double imu_gap_periods = 1.8;         // longest time between IMU samples, in their median interval
  double imu_jitter_periods = 0.2;      // largest RMS of IMU intervals about their median, in medians
  double stuck_axis_s = 1.0;            // an IMU axis that is constant for longer is stuck
  double gravity_tolerance_m_s2 = 0.8;  // of the median norm of the specific force about 9.81 m/s^2
  double largest_rate_rad_s = 36.0;     // larger rates cannot be in rad/s (2000 deg/s are 34.9 rad/s)
  double hot_pixel_factor = 8.0;        // times the events of its neighbours, and of the mean pixel
  double hot_pixel_hz = 10.0;           // lowest rate of a hot pixel
  int hot_pixel_events = 100;           // fewest events that distinguish a hot pixel from chance
  double hot_pixel_share = 0.01;        // of the events, of all hot pixels; less is a note instead of a fault
  bool operator==(const InspectionOptions&) const = default;
};

}  // namespace evical
