#include "core/maintenance/maintenance_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

using Options = MaintenanceOptions;

constexpr std::tuple kFields{
    Field{
        "gravity_m_s2", &Options::gravity_m_s2, 0.0, within(0.0, 100.0), "m/s^2",
        "Gravity's norm where the log was made; 0: as the old result has it. What it is wrong by is found in "
        "the accelerometers' scales.",
        Level::Public},
    Field{"shortest_stop_s", &Options::shortest_stop_s, 1.5, within(0.5, 1000.0), "s",
          "Stops that are shorter are not used.", Level::Expert},
    Field{"still_rate_deg_s", &Options::still_rate_deg_s, 0.5, within(0.01, 20.0), "deg/s",
          "The gyroscope's means in a stop stay within four times this of the stop's mean, and the means of "
          "stops within twice this of each other."},
    Field{"still_force_m_s2", &Options::still_force_m_s2, 0.15, within(1e-4, 5.0), "m/s^2",
          "The same for the accelerometer's means, in addition to five of their sigmas."},
    Field{"stop_above_quietest", &Options::stop_above_quietest, 4.0, within(1.0, 1e4), "",
          "A window is still if the accelerometer's variance is at most this multiple of the log's quietest "
          "tenth. Larger multiples are also tried: the smallest one that finds the most stops is used."},
    Field{"stop_rate_rad_s", &Options::stop_rate_rad_s, 0.05, within(1e-4, 10.0), "rad/s",
          "No stop is more restless than this (one sigma within a quarter of a second)."},
    Field{"stop_force_m_s2", &Options::stop_force_m_s2, 0.5, within(1e-3, 50.0), "m/s^2",
          "The same of accelerometers."},
    Field{"gap_s", &Options::gap_s, 0.1, within(0.001, 10.0), "s",
          "Samples that are further apart are a gap: a stop does not go on over it."},
    Field{"far_stop_sigmas", &Options::far_stop_sigmas, 6.0, within(2.0, 100.0), "",
          "A stop that is further from the others is left out: a ride at a steady pull looks like one."},
    Field{"left_out_stops", &Options::left_out_stops, 0.2, within(0.0, 0.9), "",
          "Part of the stops that may be left out."},
    Field{"smoothing_s", &Options::smoothing_s, 0.02, within(0.001, 1.0), "s",
          "Sigma of the Gaussian with which IMUs are smoothed before they are compared; never below two "
          "samples."},
    Field{"window_s", &Options::window_s, 1.0, within(0.2, 60.0), "s",
          "How finely changes between IMUs are looked for in time."},
    Field{"lag_s", &Options::lag_s, 40.0, within(10.0, 600.0), "s",
          "Length of the pieces over which an accelerometer is compared with a trajectory."},
    Field{"pose_interval_s", &Options::pose_interval_s, 0.2, within(0.02, 5.0), "s",
          "Poses of the trajectory are taken this far apart."},
    Field{"trajectory_gap", &Options::trajectory_gap, 3.0, within(1.1, 100.0), "",
          "Poses that are further apart than so many of their intervals are a gap."},
    Field{"trajectory_scale", &Options::trajectory_scale, 0.03, within(0.001, 1.0), "",
          "A trajectory whose positions are off by more is refused: it is not in metres."},
    Field{"trajectory_lever_mm", &Options::trajectory_lever_mm, 20.0, within(0.1, 1e4), "mm",
          "A trajectory of a point that is further from the IMU is refused."},
    Field{"time_offset_search_s", &Options::time_offset_search_s, 1.0, within(0.01, 60.0), "s",
          "How far time offsets may be from those of the old result.", Level::Expert},
    Field{"time_offset_drift_ppm", &Options::time_offset_drift_ppm, 100.0, within(0.001, 1e5), "ppm",
          "Time offsets may drift by this (one sigma) from the log's start on."},
    Field{"least_rate_rad_s", &Options::least_rate_rad_s, 0.02, within(1e-4, 10.0), "rad/s",
          "Norms of rates that vary less tell nothing of clocks."},
    Field{"same_motion", &Options::same_motion, 0.7, within(0.1, 1.0), "",
          "IMUs whose rates are correlated less are not on one body, or not on one clock."},
    Field{"restless_window", &Options::restless_window, 1.6, within(1.0, 100.0), "",
          "A window whose noise has a variance that is so many times the usual counts for less: a blow."},
    Field{"mostly_noise", &Options::mostly_noise, 20.0, within(1.0, 1e4), "",
          "Turning with less than so many times its noise's variance tells nothing of lever arm and offset."},
    Field{"settled_s", &Options::settled_s, 6.0, within(1.0, 600.0), "s",
          "Changes are looked for from so long after the log's start, or the last change, on."},
    Field{"start_s", &Options::start_s, 120.0, within(5.0, 1e5), "s",
          "So much of the log, and not beyond the first change, is compared with the old result."},
    Field{"naming_s", &Options::naming_s, 8.0, within(1.0, 600.0), "s",
          "For so long after a change data are gathered before it is said what has changed."},
    Field{"false_alarms", &Options::false_alarms, 0.01, within(1e-9, 0.5), "",
          "How often a log in which nothing has changed may have an alarm, over all tests together.",
          Level::Expert},
    Field{"stability_rotation_deg", &Options::stability_rotation_deg, 0.02, within(0.0, 90.0), "deg",
          "Rotations between IMUs may change by this (one sigma) without anything having changed.",
          Level::Public},
    Field{"stability_translation_mm", &Options::stability_translation_mm, 0.3, within(0.0, 1e4), "mm",
          "The same of lever arms.", Level::Public},
    Field{"stability_time_offset_ms", &Options::stability_time_offset_ms, 0.05, within(0.0, 1e4), "ms",
          "The same of time offsets.", Level::Public},
    Field{"stability_accelerometer_bias_m_s2", &Options::stability_accelerometer_bias_m_s2, 0.02,
          within(0.0, 100.0), "m/s^2", "The same of accelerometers' biases since the calibration.",
          Level::Public},
    Field{"stability_gyroscope_bias_rad_s", &Options::stability_gyroscope_bias_rad_s, 0.002,
          within(0.0, 100.0), "rad/s", "The same of gyroscopes' biases since the calibration.",
          Level::Public},
    Field{"stability_imu_scale", &Options::stability_imu_scale, 2e-4, within(0.0, 1.0), "",
          "The same of accelerometers' scale factors and misalignments.", Level::Public},
    Field{"accelerometer_walk", &Options::accelerometer_walk, 1e-4, within(0.0, 1.0), "m/s^3/sqrt(Hz)",
          "Random walk of accelerometers' biases on the way, where the old result has none.", Level::Expert},
    Field{"gyroscope_walk", &Options::gyroscope_walk, 1e-5, within(0.0, 1.0), "rad/s^2/sqrt(Hz)",
          "The same of gyroscopes' biases.", Level::Expert},
    Field{"matters_rotation_deg", &Options::matters_rotation_deg, 0.25, within(1e-4, 90.0), "deg",
          "Nothing has changed is said only where a change of this size would have shown.", Level::Expert},
    Field{"matters_translation_mm", &Options::matters_translation_mm, 10.0, within(1e-3, 1e4), "mm",
          "The same of lever arms.", Level::Expert},
    Field{"matters_time_offset_ms", &Options::matters_time_offset_ms, 1.0, within(1e-4, 1e4), "ms",
          "The same of time offsets.", Level::Expert},
    Field{"matters_accelerometer_bias_m_s2", &Options::matters_accelerometer_bias_m_s2, 0.15,
          within(1e-6, 100.0), "m/s^2", "The same of accelerometers' biases.", Level::Expert},
    Field{"matters_gyroscope_bias_rad_s", &Options::matters_gyroscope_bias_rad_s, 0.02, within(1e-7, 100.0),
          "rad/s", "The same of gyroscopes' biases.", Level::Expert},
    Field{"matters_imu_scale", &Options::matters_imu_scale, 0.005, within(1e-6, 1.0), "",
          "The same of accelerometers' scale factors and misalignments.", Level::Expert}};
constexpr auto kDefaults = defaultsOf<Options, kFields>();

}  // namespace

MaintenanceOptions::MaintenanceOptions() : MaintenanceOptions(kDefaults) {}

const OptionTable<MaintenanceOptions>& MaintenanceOptions::table() {
  static const OptionTable<MaintenanceOptions> table(kFields);
  return table;
}

}  // namespace evical
