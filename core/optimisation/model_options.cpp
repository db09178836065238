#include "core/optimisation/model_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kModelFields{
    Switch{"free_time_offsets", &ModelOptions::free_time_offsets, true,
           "Estimate time offsets; else each stays at the session's prior value, or 0 without one.",
           Level::Public},
    Switch{
        "time_offset_drift", &ModelOptions::time_offset_drift, true,
        "Estimate how each time offset drifts, as clocks of their own do; false where one clock stamps all "
        "sensors. A given time offset does not drift; with a weighed prior the drift is estimated in any "
        "case.",
        Level::Public},
    Switch{
        "free_imu_intrinsics", &ModelOptions::free_imu_intrinsics, true,
        "Estimate scales and misalignments M_g and M_a and the accelerometer's delay; else each stays at the "
        "session's prior value, or the identity and 0 without one. Biases stay free.",
        Level::Public, Applies::WithImu},
    Switch{"free_gravity_norm", &ModelOptions::free_gravity_norm, true,
           "Estimate gravity's norm, too, not its direction only.", Level::Public, Applies::WithImu},
    Switch{"free_board_size", &ModelOptions::free_board_size, true,
           "Estimate the board's size and its stretch about what the session says, so that translations' "
           "sigmas say what its measurement leaves open.",
           Level::Public},
    Switch{"board_bow", &ModelOptions::board_bow, true,
           "Estimate how the board is bent along its rows and its columns, and twisted, as a sheet is that "
           "comes off; a board that is taken for flat is tested all the same.",
           Level::Public},
    Switch{
        "line_delay", &ModelOptions::line_delay, false,
        "Estimate every frame camera's line delay, as if all shutters rolled; those that the session calls "
        "rolling have theirs estimated in any case, and the others are tested.",
        Level::Expert, Applies::WithFrames},
    Switch{
        "share_sensors", &ModelOptions::share_sensors, true,
        "Cameras with same_sensor_as have one pose, one lens and one clock with the other; false: each has "
        "its own, and whether they agree is only told. Shared ones are tested all the same.",
        Level::Expert},
    Choice{
        "camera_intrinsics", &ModelOptions::camera_intrinsics, CameraIntrinsicsChoice::Free,
        std::array{"fixed", "free"},
        "Whether cameras' intrinsics are solved for with everything else, in the last stage: those that were "
        "given, too, as no lens is exactly what its file says. Fixed ones are tested all the same.",
        Level::Public},
    Switch{
        "gyroscope_rotation", &ModelOptions::gyroscope_rotation, false,
        "Estimate how each gyroscope is turned against its accelerometer, whose frame is the IMU's. With a "
        "weighed prior it is estimated in any case.",
        Level::Public, Applies::WithImu},
    Field{"delay_misfit", &ModelOptions::delay_misfit, 1.3, within(1.0, 1000.0), "",
          "Accelerometers' delays are held where accelerations are further off than this many times their "
          "noise: where splines cannot follow the motion they would choose a delay at which they miss less."},
    Choice{"bias_model", &ModelOptions::bias_model, BiasModel::Constant, std::array{"constant", "linear"},
           "Biases over a recording: constant, or straight lines between knots that walk at random.",
           Level::Public, Applies::WithImu},
    Field{"bias_knot_spacing_s", &ModelOptions::bias_knot_spacing_s, 5.0, within(0.1, 1e4), "s",
          "Linear biases: knots are at most this far apart, closer where the random walk asks for it.",
          Level::Expert, Applies::WithLinearBiases},
    Field{"most_bias_knots", &ModelOptions::most_bias_knots, 48, within(2, 1000), "",
          "Linear biases: no more knots an IMU than this, as uncertainty takes time and memory with them."},
    Field{"gyroscope_random_walk", &ModelOptions::gyroscope_random_walk, 2.66e-5, within(1e-9, 1.0),
          "rad/s^2/sqrt(Hz)",
          "Linear biases: how fast gyroscope biases drift where the session does not say it. The default is "
          "Kalibr's example for an ADIS16448, as the noise densities are.",
          Level::Public, Applies::WithLinearBiases},
    Field{"accelerometer_random_walk", &ModelOptions::accelerometer_random_walk, 4.33e-4, within(1e-9, 10.0),
          "m/s^3/sqrt(Hz)", "The same of accelerometer biases.", Level::Public, Applies::WithLinearBiases},
    Field{"slow_edge_speed_px_s", &ModelOptions::slow_edge_speed_px_s, 20.0, within(0.1, 1000.0), "px/s",
          "At this image speed what slow edges add to the edge lead is down to 1/e."},
    Field{"least_centre_sigma_px", &ModelOptions::least_centre_sigma_px, 0.01, within(0.0, 10.0), "px",
          "Added in squares to the covariance of each measured centre."},
    Field{"huber_sigma", &ModelOptions::huber_sigma, 2.5, within(0.5, 100.0), "sigma",
          "Circle residuals beyond this pull with constant force."},
    Field{"outlier_sigma", &ModelOptions::outlier_sigma, 6.0, within(2.0, 1000.0), "sigma",
          "Circles further from their place, in units of the spread of all, are dropped between stages; so "
          "are single IMU samples, in units also of the spread beside them."},
    Field{"outlier_window_fraction", &ModelOptions::outlier_window_fraction, 0.5, within(0.1, 1.0), "",
          "A window loses all its circles if more than this share of them is dropped."}};
constexpr auto kModelDefaults = defaultsOf<ModelOptions, kModelFields>();

}  // namespace

ModelOptions::ModelOptions() : ModelOptions(kModelDefaults) {}

const OptionTable<ModelOptions>& ModelOptions::table() {
  static const OptionTable<ModelOptions> table(kModelFields);
  return table;
}

}  // namespace evical
