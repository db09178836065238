#include "core/optimisation/model_options.h"

#include "core/base/option_table.h"

#include <array>

namespace evical {
namespace {

constexpr std::array kEstimated{"auto", "false", "true"};

constexpr std::tuple kModelFields{
    Switch{"free_time_offsets", &ModelOptions::free_time_offsets, true,
           "Estimate time offsets; otherwise each is fixed at its prior value, or at 0 without a prior.",
           Level::Public},
    Switch{"time_offset_drift", &ModelOptions::time_offset_drift, true,
           "Estimate each time offset's drift. Set it to false if one clock stamps all sensors. Given time "
           "offsets do not drift.",
           Level::Public},
    Switch{
        "free_imu_intrinsics", &ModelOptions::free_imu_intrinsics, true,
        "Estimate scale and misalignment matrices M_g and M_a, and accelerometer delays; otherwise they are "
        "fixed at their prior values, or at identity and 0.",
        Level::Public, Applies::WithImu},
    Switch{"free_gravity_norm", &ModelOptions::free_gravity_norm, true,
           "Estimate gravity's norm in addition to its direction.", Level::Public, Applies::WithImu},
    Switch{
        "free_board_size", &ModelOptions::free_board_size, true,
        "Estimate the board's size and stretch around their given values, so that translation sigmas include "
        "the board's size uncertainty.",
        Level::Public},
    Switch{"board_bow", &ModelOptions::board_bow, true,
           "Estimate the board's bow along rows and columns, and its twist. A board assumed flat is still "
           "tested for a bow.",
           Level::Public},
    Choice{"line_delay", &ModelOptions::line_delay, Estimated::Auto, kEstimated,
           "Estimate line delays of frame cameras declared global-shutter. Auto: if a test shows a rolling "
           "shutter.",
           Level::Expert, Applies::WithFrames},
    Switch{"share_sensors", &ModelOptions::share_sensors, true,
           "Cameras with same_sensor_as share pose, lens and clock with the named camera; false: each has "
           "its own. Agreement is tested in both cases.",
           Level::Expert},
    Choice{"camera_intrinsics", &ModelOptions::camera_intrinsics, CameraIntrinsicsChoice::Free,
           std::array{"fixed", "free"},
           "Free: estimate camera intrinsics in the last stage, also given ones. Fixed: keep them, and test "
           "whether they agree with the data.",
           Level::Public},
    Choice{"gyroscope_rotation", &ModelOptions::gyroscope_rotation, Estimated::Auto, kEstimated,
           "Estimate each gyroscope's rotation relative to its accelerometer. Auto: if a test shows a "
           "misalignment. Always estimated with a prior that has a sigma.",
           Level::Public, Applies::WithImu},
    Field{"delay_misfit", &ModelOptions::delay_misfit, 1.3, within(1.0, 1000.0), "",
          "Accelerometer delays are fixed if acceleration errors exceed the noise by this factor, since "
          "splines that do not follow the motion bias them."},
    Choice{"bias_model", &ModelOptions::bias_model, BiasModel::Auto, std::array{"auto", "constant", "linear"},
           "Biases: constant, or linear between knots with a random-walk prior. Auto: linear if a test shows "
           "that they change.",
           Level::Public, Applies::WithImu},
    Field{"bias_knot_spacing_s", &ModelOptions::bias_knot_spacing_s, 5.0, within(0.1, 1e4), "s",
          "Linear biases: largest knot spacing; a strong random walk makes it smaller.", Level::Expert,
          Applies::WithLinearBiases},
    Field{"most_bias_knots", &ModelOptions::most_bias_knots, 48, within(2, 1000), "",
          "Linear biases: largest number of knots per IMU; time and memory grow with it."},
    Field{"gyroscope_random_walk", &ModelOptions::gyroscope_random_walk, 2.66e-5, within(1e-9, 1.0),
          "rad/s^2/sqrt(Hz)",
          "Linear biases: random walk of gyroscopes without one in the session. Default: Kalibr's example "
          "for an ADIS16448.",
          Level::Public, Applies::WithLinearBiases},
    Field{"accelerometer_random_walk", &ModelOptions::accelerometer_random_walk, 4.33e-4, within(1e-9, 10.0),
          "m/s^3/sqrt(Hz)", "Linear biases: random walk of accelerometers without one in the session.",
          Level::Public, Applies::WithLinearBiases},
    Field{"slow_edge_speed_px_s", &ModelOptions::slow_edge_speed_px_s, 20.0, within(0.1, 1000.0), "px/s",
          "Image speed at which the additional edge localisation bias at low speed has decayed to 1/e."},
    Field{"least_centre_sigma_px", &ModelOptions::least_centre_sigma_px, 0.01, within(0.0, 10.0), "px",
          "Sigma added in quadrature to the covariance of each measured centre."},
    Field{"common_displacement_px", &ModelOptions::common_displacement_px, 0.008, within(0.0, 10.0), "px",
          "Event cameras: sigma of a displacement that all circles of an event window have in common, fast "
          "motion."},
    Field{"common_displacement_px2_s", &ModelOptions::common_displacement_px2_s, 2.0, within(0.0, 1000.0),
          "px^2/s", "Event cameras: product of the same sigma and the image speed, slow motion."},
    Field{"common_displacement_px_s", &ModelOptions::common_displacement_px_s, 15.0, within(0.1, 1000.0),
          "px/s", "Event cameras: image speed below which the same sigma does not grow any more."},
    Field{"huber_sigma", &ModelOptions::huber_sigma, 2.5, within(0.5, 100.0), "sigma",
          "Threshold of Huber's loss for circle residuals."},
    Field{
        "outlier_sigma", &ModelOptions::outlier_sigma, 6.0, within(2.0, 1000.0), "sigma",
        "Circles with larger errors, in units of the spread, are rejected between stages; so are single IMU "
        "samples that also exceed their neighbours' spread."},
    Field{"outlier_window_fraction", &ModelOptions::outlier_window_fraction, 0.5, within(0.1, 1.0), "",
          "All circles of an event window or frame are rejected if more than this share of them are "
          "outliers."}};
constexpr auto kModelDefaults = defaultsOf<ModelOptions, kModelFields>();

}  // namespace

ModelOptions::ModelOptions() : ModelOptions(kModelDefaults) {}

const OptionTable<ModelOptions>& ModelOptions::table() {
  static const OptionTable<ModelOptions> table(kModelFields);
  return table;
}

}  // namespace evical
