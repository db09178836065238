#include "core/maintenance/maintenance_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

using Options = MaintenanceOptions;

constexpr std::tuple kFields{
    Field{"gravity_m_s2", &Options::gravity_m_s2, 0.0, within(0.0, 100.0), "m/s^2",
          "Norm of gravity at the place of the log; 0: as in the old result. Its error is absorbed by "
          "the accelerometers' scales.",
          Level::Public},
    Field{"min_stop_s", &Options::min_stop_s, 1.5, within(0.5, 1000.0), "s", "Shortest stop that is used.",
          Level::Expert},
    Field{"still_rate_deg_s", &Options::still_rate_deg_s, 0.5, within(0.01, 20.0), "deg/s",
          "Tolerance of a stop's mean angular rates: four times this within a stop, "
          "twice this between stops."},
    Field{"still_force_m_s2", &Options::still_force_m_s2, 0.15, within(1e-4, 5.0), "m/s^2",
          "Tolerance of the accelerometer's means within a stop, in addition to five of their sigmas."},
    Field{"stop_above_quietest", &Options::stop_above_quietest, 4.0, within(1.0, 1e4), "",
          "Largest variance of the accelerometer in a stop, relative to the log's quietest tenth. Larger "
          "values "
          "are also tested; the smallest with the most stops is used."},
    Field{"stop_rate_rad_s", &Options::stop_rate_rad_s, 0.05, within(1e-4, 10.0), "rad/s",
          "Largest standard deviation of the angular rate in a stop, within a quarter of a second."},
    Field{"stop_force_m_s2", &Options::stop_force_m_s2, 0.5, within(1e-3, 50.0), "m/s^2",
          "Largest standard deviation of the specific force in a stop, within a quarter of a second."},
    Field{"gap_s", &Options::gap_s, 0.1, within(0.001, 10.0), "s",
          "Longest interval between samples within a stop."},
    Field{"far_stop_sigmas", &Options::far_stop_sigmas, 6.0, within(2.0, 100.0), "",
          "Largest deviation of a stop from the others; others are excluded, such as constant acceleration "
          "in a ride."},
    Field{"left_out_stops", &Options::left_out_stops, 0.2, within(0.0, 0.9), "",
          "Largest share of excluded stops."},
    Field{"smoothing_s", &Options::smoothing_s, 0.02, within(0.001, 1.0), "s",
          "Sigma of the Gaussian that smooths IMU samples before a comparison; at least two "
          "samples."},
    Field{"window_s", &Options::window_s, 1.0, within(0.2, 60.0), "s",
          "Time resolution of the search for changes between IMUs."},
    Field{"lag_s", &Options::lag_s, 40.0, within(10.0, 600.0), "s",
          "Length of the segments in which an accelerometer is compared with a trajectory."},
    Field{"pose_interval_s", &Options::pose_interval_s, 0.2, within(0.02, 5.0), "s",
          "Interval between the used poses of a trajectory."},
    Field{"trajectory_gap", &Options::trajectory_gap, 3.0, within(1.1, 100.0), "",
          "Longest interval between poses, in units of pose_interval_s; a longer one is a gap."},
    Field{"trajectory_scale", &Options::trajectory_scale, 0.03, within(0.001, 1.0), "",
          "Largest scale error of a trajectory; one with a larger error is rejected, since it is not in "
          "metres."},
    Field{
        "trajectory_lever_mm", &Options::trajectory_lever_mm, 20.0, within(0.1, 1e4), "mm",
        "Largest distance between the trajectory's point and the IMU; above it the trajectory is rejected."},
    Field{"time_offset_search_s", &Options::time_offset_search_s, 1.0, within(0.01, 60.0), "s",
          "Largest change of time offsets from those of the old result.", Level::Expert},
    Field{"time_offset_drift_ppm", &Options::time_offset_drift_ppm, 100.0, within(0.001, 1e5), "ppm",
          "Prior sigma of the drift of time offsets since the log's start."},
    Field{"min_rate_rad_s", &Options::min_rate_rad_s, 0.02, within(1e-4, 10.0), "rad/s",
          "Smallest variation of the norm of rates that determines a clock offset."},
    Field{"same_motion", &Options::same_motion, 0.7, within(0.1, 1.0), "",
          "Smallest correlation of the rates of IMUs on one body with consistent clocks."},
    Field{
        "restless_window", &Options::restless_window, 1.6, within(1.0, 100.0), "",
        "Ratio of a window's noise variance to the typical one above which its weight is reduced (shocks)."},
    Field{"mostly_noise", &Options::mostly_noise, 20.0, within(1.0, 1e4), "",
          "Smallest ratio of rotation to its noise variance that determines lever arm and time offset."},
    Field{"settled_s", &Options::settled_s, 6.0, within(1.0, 600.0), "s",
          "Time after the log's start or the last change before changes are detected."},
    Field{"start_s", &Options::start_s, 120.0, within(5.0, 1e5), "s",
          "Time from the log's start that is compared with the old result, at most until the first change."},
    Field{"naming_s", &Options::naming_s, 8.0, within(1.0, 600.0), "s",
          "Duration of the data after a change that determine what has changed."},
    Field{"false_alarms", &Options::false_alarms, 0.01, within(1e-9, 0.5), "",
          "Probability of a false alarm in an unchanged log, over all tests together.", Level::Expert},
    Field{"stability_rotation_deg", &Options::stability_rotation_deg, 0.02, within(0.0, 90.0), "deg",
          "Standard deviation of the tolerated change of rotations between IMUs.", Level::Public},
    Field{"stability_translation_mm", &Options::stability_translation_mm, 0.3, within(0.0, 1e4), "mm",
          "Standard deviation of the tolerated change of lever arms.", Level::Public},
    Field{"stability_time_offset_ms", &Options::stability_time_offset_ms, 0.05, within(0.0, 1e4), "ms",
          "Standard deviation of the tolerated change of time offsets.", Level::Public},
    Field{"stability_accelerometer_bias_m_s2", &Options::stability_accelerometer_bias_m_s2, 0.02,
          within(0.0, 100.0), "m/s^2",
          "Standard deviation of the tolerated change of accelerometer biases since the calibration.",
          Level::Public},
    Field{"stability_gyroscope_bias_rad_s", &Options::stability_gyroscope_bias_rad_s, 0.002,
          within(0.0, 100.0), "rad/s",
          "Standard deviation of the tolerated change of gyroscope biases since the calibration.",
          Level::Public},
    Field{
        "stability_imu_scale", &Options::stability_imu_scale, 2e-4, within(0.0, 1.0), "",
        "Standard deviation of the tolerated change of the accelerometers' scale factors and misalignments.",
        Level::Public},
    Field{"accelerometer_walk", &Options::accelerometer_walk, 1e-4, within(0.0, 1.0), "m/s^3/sqrt(Hz)",
          "Random walk of accelerometer biases during the log, if the old result does not have one.",
          Level::Expert},
    Field{"gyroscope_walk", &Options::gyroscope_walk, 1e-5, within(0.0, 1.0), "rad/s^2/sqrt(Hz)",
          "Random walk of gyroscope biases during the log, if the old result does not have one.",
          Level::Expert},
    Field{"matters_rotation_deg", &Options::matters_rotation_deg, 0.25, within(1e-4, 90.0), "deg",
          "Rotation change that must be detectable for the verdict \"unchanged\".", Level::Expert},
    Field{"matters_translation_mm", &Options::matters_translation_mm, 10.0, within(1e-3, 1e4), "mm",
          "Lever arm change that must be detectable for the verdict \"unchanged\".", Level::Expert},
    Field{"matters_time_offset_ms", &Options::matters_time_offset_ms, 1.0, within(1e-4, 1e4), "ms",
          "Time offset change that must be detectable for the verdict \"unchanged\".", Level::Expert},
    Field{"matters_accelerometer_bias_m_s2", &Options::matters_accelerometer_bias_m_s2, 0.15,
          within(1e-6, 100.0), "m/s^2",
          "Accelerometer bias change that must be detectable for the verdict \"unchanged\".", Level::Expert},
    Field{"matters_gyroscope_bias_rad_s", &Options::matters_gyroscope_bias_rad_s, 0.02, within(1e-7, 100.0),
          "rad/s", "Gyroscope bias change that must be detectable for the verdict \"unchanged\".",
          Level::Expert},
    Field{"matters_imu_scale", &Options::matters_imu_scale, 0.005, within(1e-6, 1.0), "",
          "Change of accelerometer scale factors and misalignments that must be detectable for the verdict "
          "\"unchanged\".",
          Level::Expert}};
constexpr auto kDefaults = defaultsOf<Options, kFields>();

}  // namespace

MaintenanceOptions::MaintenanceOptions() : MaintenanceOptions(kDefaults) {}

const OptionTable<MaintenanceOptions>& MaintenanceOptions::table() {
  static const OptionTable<MaintenanceOptions> table(kFields);
  return table;
}

}  // namespace evical
