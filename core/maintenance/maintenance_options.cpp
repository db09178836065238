#include "core/maintenance/maintenance_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

using Options = MaintenanceOptions;

constexpr std::tuple kFields{
    Field{
        "gravity_m_s2", &Options::gravity_m_s2, 0.0, within(0.0, 100.0), "m/s^2",
        "Gravity's norm where the log was made; 0: as the old result has it. What it is wrong by is found in "
        "the accelerometers' scales."},
    Field{"shortest_stop_s", &Options::shortest_stop_s, 1.5, within(0.5, 1000.0), "s",
          "Stops that are shorter are not used."},
    Field{"still_rate_deg_s", &Options::still_rate_deg_s, 0.5, within(0.01, 20.0), "deg/s",
          "In a stop the gyroscope's means stay within this of each other."},
    Field{"smoothing_s", &Options::smoothing_s, 0.02, within(0.001, 1.0), "s",
          "Sigma of the Gaussian with which IMUs are smoothed before they are compared; never below two "
          "samples."},
    Field{"window_s", &Options::window_s, 1.0, within(0.2, 60.0), "s",
          "How finely changes between IMUs are looked for in time."},
    Field{"lag_s", &Options::lag_s, 40.0, within(10.0, 600.0), "s",
          "Length of the pieces over which an accelerometer is compared with a trajectory."},
    Field{"pose_interval_s", &Options::pose_interval_s, 0.2, within(0.02, 5.0), "s",
          "Poses of the trajectory are taken this far apart."},
    Field{"time_offset_search_s", &Options::time_offset_search_s, 1.0, within(0.01, 60.0), "s",
          "How far time offsets may be from those of the old result."},
    Field{"naming_s", &Options::naming_s, 8.0, within(1.0, 600.0), "s",
          "For so long after a change data are gathered before it is said what has changed."},
    Field{"false_alarms", &Options::false_alarms, 0.01, within(1e-9, 0.5), "",
          "How often a log in which nothing has changed may have an alarm, over all tests together."},
    Field{"stability_rotation_deg", &Options::stability_rotation_deg, 0.02, within(0.0, 90.0), "deg",
          "Rotations between IMUs may change by this (one sigma) without anything having changed."},
    Field{"stability_translation_mm", &Options::stability_translation_mm, 0.3, within(0.0, 1e4), "mm",
          "The same of lever arms."},
    Field{"stability_time_offset_ms", &Options::stability_time_offset_ms, 0.05, within(0.0, 1e4), "ms",
          "The same of time offsets."},
    Field{"stability_accelerometer_bias_m_s2", &Options::stability_accelerometer_bias_m_s2, 0.02,
          within(0.0, 100.0), "m/s^2", "The same of accelerometers' biases since the calibration."},
    Field{"stability_gyroscope_bias_rad_s", &Options::stability_gyroscope_bias_rad_s, 0.002,
          within(0.0, 100.0), "rad/s", "The same of gyroscopes' biases since the calibration."},
    Field{"stability_imu_scale", &Options::stability_imu_scale, 2e-4, within(0.0, 1.0), "",
          "The same of accelerometers' scale factors and misalignments."},
    Field{"accelerometer_walk", &Options::accelerometer_walk, 1e-4, within(0.0, 1.0), "m/s^3/sqrt(Hz)",
          "Random walk of accelerometers' biases on the way, where the old result has none."},
    Field{"gyroscope_walk", &Options::gyroscope_walk, 1e-5, within(0.0, 1.0), "rad/s^2/sqrt(Hz)",
          "The same of gyroscopes' biases."},
    Field{"matters_rotation_deg", &Options::matters_rotation_deg, 0.25, within(1e-4, 90.0), "deg",
          "Nothing has changed is said only where a change of this size would have shown."},
    Field{"matters_translation_mm", &Options::matters_translation_mm, 10.0, within(1e-3, 1e4), "mm",
          "The same of lever arms."},
    Field{"matters_time_offset_ms", &Options::matters_time_offset_ms, 1.0, within(1e-4, 1e4), "ms",
          "The same of time offsets."},
    Field{"matters_accelerometer_bias_m_s2", &Options::matters_accelerometer_bias_m_s2, 0.15,
          within(1e-6, 100.0), "m/s^2", "The same of accelerometers' biases."},
    Field{"matters_gyroscope_bias_rad_s", &Options::matters_gyroscope_bias_rad_s, 0.02, within(1e-7, 100.0),
          "rad/s", "The same of gyroscopes' biases."},
    Field{"matters_imu_scale", &Options::matters_imu_scale, 0.005, within(1e-6, 1.0), "",
          "The same of accelerometers' scale factors and misalignments."}};
constexpr auto kDefaults = defaultsOf<Options, kFields>();

}  // namespace

MaintenanceOptions::MaintenanceOptions() : MaintenanceOptions(kDefaults) {}

const OptionTable<MaintenanceOptions>& MaintenanceOptions::table() {
  static const OptionTable<MaintenanceOptions> table(kFields);
  return table;
}

}  // namespace evical
