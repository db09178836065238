#include "core/optimisation/optimisation_options.h"

#include "core/base/option_table.h"

#include <array>
#include <numbers>

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
    Field{"unknown_delay_sigma_s", &ModelOptions::unknown_delay_sigma_s, 0.05, within(1e-6, 1.0), "s",
          "Sigma of the delays' prior from which they are estimated in spite of delay_misfit."},
    Choice{"bias_model", &ModelOptions::bias_model, BiasModel::Auto, std::array{"auto", "constant", "linear"},
           "Biases: constant, or linear between knots with a random-walk prior. Auto: linear if a test shows "
           "that they change.",
           Level::Public, Applies::WithImu},
    Field{"bias_knot_spacing_s", &ModelOptions::bias_knot_spacing_s, 5.0, within(0.1, 1e4), "s",
          "Linear biases: largest knot spacing; a strong random walk makes it smaller.", Level::Expert,
          Applies::WithLinearBiases},
    Field{"max_bias_knots", &ModelOptions::max_bias_knots, 48, within(2, 1000), "",
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
    Field{"min_centre_sigma_px", &ModelOptions::min_centre_sigma_px, 0.01, within(0.0, 10.0), "px",
          "Sigma added in quadrature to the covariance of each measured centre."},
    Field{"displacement_px", &ModelOptions::displacement_px, 0.013, within(0.0, 10.0), "px",
          "Event cameras: expected sigma of the displacement that neighbouring circles of an event window "
          "share, fast "
          "motion."},
    Field{"displacement_px2_s", &ModelOptions::displacement_px2_s, 0.5, within(0.0, 1000.0), "px^2/s",
          "Event cameras: product of the same sigma and the image speed, slow motion."},
    Field{"displacement_px_s", &ModelOptions::displacement_px_s, 20.0, within(0.1, 1000.0), "px/s",
          "Event cameras: image speed below which the same sigma does not grow any more."},
    Field{"displacement_length_spacings", &ModelOptions::displacement_length_spacings, 2.0,
          within(0.5, 100.0), "spacings", "Length of the displacement's Gaussian covariance over the board."},
    Field{"displacement_constant_share", &ModelOptions::displacement_constant_share, 0.2, within(0.0, 1.0),
          "", "Share of the displacement's variance that all circles of a window have in common."},
    Field{"displacement_persistence", &ModelOptions::displacement_persistence, 1.5, within(1.0, 10.0), "",
          "Factor of the displacement's sigma, since it hardly changes from one window to the next."},
    Field{"displacement_size_sigma", &ModelOptions::displacement_size_sigma, 0.7, within(0.01, 10.0), "",
          "Prior sigma of the logarithm of the displacement's size, which each recording shows."},
    Field{
        "displacement_remainder", &ModelOptions::displacement_remainder, 0.1, within(1e-4, 1.0), "",
        "Share of the displacement's variance that the modes of a board may leave: fewer modes are faster."},
    Field{"displacement_views", &ModelOptions::displacement_views, 60, within(1, 100000), "",
          "Views that determine the displacement's size; more decide hardly better."},
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

constexpr std::tuple kPriorFields{
    Field{"camera_focal_length_sigma", &PriorOptions::camera_focal_length_sigma, 0.02, within(1e-6, 10.0), "",
          "Relative sigma of the weak prior on free focal lengths, around given or initial ones.",
          Level::Expert},
    Field{"camera_principal_point_sigma_px", &PriorOptions::camera_principal_point_sigma_px, 10.0,
          within(1e-4, 1e4), "px", "Sigma of the weak prior on free principal points.", Level::Expert},
    Field{"camera_distortion_sigma", &PriorOptions::camera_distortion_sigma, 0.5, within(1e-6, 100.0), "",
          "Sigma of the weak prior on each free distortion coefficient.", Level::Expert},
    Field{"edge_localisation_bias_sigma_px", &PriorOptions::edge_localisation_bias_sigma_px, 0.5,
          within(1e-6, 10.0), "px",
          "Sigma of the prior, around 0, on the lead of measured centres along their image motion."},
    Field{"slow_edge_localisation_bias_sigma_px", &PriorOptions::slow_edge_localisation_bias_sigma_px, 0.02,
          within(1e-6, 10.0), "px",
          "Sigma of the prior, around 0, on the additional lead of edges that hardly move."},
    Field{"max_readout_ms", &PriorOptions::max_readout_ms, 40.0, within(0.1, 1e4), "ms",
          "Sigma of the prior, around 0, on a rolling shutter's readout time from the first row to the last.",
          Level::Expert, Applies::WithFrames},
    Field{"time_offset_drift_sigma_ppm", &PriorOptions::time_offset_drift_sigma_ppm, 50.0, within(1e-4, 1e5),
          "ppm", "Sigma of the prior, around 0, on the drift of time offsets.", Level::Expert},
    Field{
        "exposure_share_sigma", &PriorOptions::exposure_share_sigma, 0.5, within(1e-4, 100.0), "",
        "Sigma of the prior, around 0, on the exposure's share between stamp and middle (0.5: stamped at the "
        "beginning), estimated if exposures vary.",
        Level::Expert, Applies::WithFrames},
    Field{"mapping_sigma", &PriorOptions::mapping_sigma, 0.01, within(1e-6, 10.0), "",
          "Sigma of the prior on scales (relative) and misalignments (rad) of gyroscopes and accelerometers, "
          "the entries of M_g and M_a. Default: typical of MEMS IMUs.",
          Level::Expert, Applies::WithImu},
    Field{"gyroscope_rotation_sigma_deg", &PriorOptions::gyroscope_rotation_sigma_deg, 5.0,
          within(1e-3, 180.0), "deg",
          "Sigma of the weak prior, around 0, on gyroscope rotations relative to the accelerometer.",
          Level::Expert, Applies::WithFreeGyroscopeTurns},
    Field{"accelerometer_delay_sigma_s", &PriorOptions::accelerometer_delay_sigma_s, 0.005, within(1e-6, 1.0),
          "s", "Sigma of the prior, around 0, on accelerometer delays relative to the gyroscope.",
          Level::Expert, Applies::WithImu},
    Field{"gyroscope_bias_sigma_rad_s", &PriorOptions::gyroscope_bias_sigma_rad_s, 1.0, within(1e-6, 100.0),
          "rad/s", "Sigma of the weak prior, around 0, on gyroscope biases.", Level::Expert,
          Applies::WithImu},
    Field{"accelerometer_bias_sigma_m_s2", &PriorOptions::accelerometer_bias_sigma_m_s2, 1.0,
          within(1e-6, 100.0), "m/s^2", "Sigma of the weak prior, around 0, on accelerometer biases.",
          Level::Expert, Applies::WithImu},
    Field{"translation_sigma_m", &PriorOptions::translation_sigma_m, 0.5, within(1e-3, 1e3), "m",
          "Sigma of the weak prior, around 0, on translations between sensors that the motion does not "
          "determine.",
          Level::Expert},
    Field{"gravity_norm_sigma_m_s2", &PriorOptions::gravity_norm_sigma_m_s2, 0.02, within(1e-6, 10.0),
          "m/s^2", "Sigma of the prior on a free gravity norm, around initialisation.gravity_m_s2.",
          Level::Public, Applies::WithFreeGravityNorm},
    Field{
        "board_spacing_sigma", &PriorOptions::board_spacing_sigma, 0.002, within(1e-7, 1.0), "",
        "Relative sigma of the board's size without board.spacing_std in the session. A ruler over the whole "
        "board reaches 0.1 to 0.2 %.",
        Level::Public},
    Field{"board_bow_sigma_mm", &PriorOptions::board_bow_sigma_mm, 2.0, within(1e-4, 1e4), "mm",
          "Sigma of the prior, around 0, on the board's bow at its middle, along each of its lengths.",
          Level::Expert},
    Field{"smooth_rotation_rad_s2", &PriorOptions::smooth_rotation_rad_s2, 200.0, within(0.1, 1e6), "rad/s^2",
          "Without an IMU: largest sigma of angular accelerations at knots, whose prior of 0 +- "
          "smooth_unevenness "
          "times their RMS bridges gaps between views.",
          Level::Expert, Applies::WithoutImu},
    Field{"smooth_position_m_s2", &PriorOptions::smooth_position_m_s2, 30.0, within(0.01, 1e6), "m/s^2",
          "Without an IMU: largest sigma of accelerations at knots, as smooth_rotation_rad_s2.",
          Level::Expert, Applies::WithoutImu},
    Field{"smooth_unevenness", &PriorOptions::smooth_unevenness, 3.0, within(0.1, 1000.0), "",
          "Without an IMU: sigma of accelerations at knots in units of their RMS, since hand motion is "
          "uneven."}};
constexpr auto kPriorDefaults = defaultsOf<PriorOptions, kPriorFields>();

constexpr std::tuple kSolverFields{
    Field{"last_step_sigmas", &SolverOptions::last_step_sigmas, 0.5, within(1e-6, 10.0), "sigmas",
          "Length of the last stage's last step, over all unknowns. The optimum is more than ten times "
          "nearer."},
    Field{"stage_tolerance", &SolverOptions::stage_tolerance, 1e-4, within(1e-14, 1e-1), "",
          "Relative cost change at which a stage before the last ends."},
    Field{"max_iterations", &SolverOptions::max_iterations, 30, within(1, 1000), "", "Iterations per solve.",
          Level::Expert},
    Field{"max_rounds", &SolverOptions::max_rounds, 5, within(1, 100), "",
          "Solves per stage; measurements are assigned to spline segments again before each."},
    Field{"segment_drift", &SolverOptions::segment_drift, 0.05, within(0.001, 0.5), "knots",
          "Time offset change after which measurements are assigned to spline segments again."},
    Field{"threads", &SolverOptions::threads, 2, within(1, 256), "",
          "Threads of the batch, including its linear algebra.", Level::Public}};
constexpr auto kSolverDefaults = defaultsOf<SolverOptions, kSolverFields>();

constexpr std::tuple kVerdictFields{
    Field{"correlation_time_s", &VerdictOptions::correlation_time_s, 0.2, within(0.001, 10.0), "s",
          "Residuals closer in time than this may be correlated; the reported sigmas allow for it."},
    Field{"pixel_error_px", &VerdictOptions::pixel_error_px, 0.1, within(0.0, 10.0), "px",
          "Error of edges that repeats at the same pixel and biases the amplitude of motion over few pixels; "
          "included in the sigmas.",
          Level::Expert, Applies::WithImu},
    Field{
        "pixel_delay_ms", &VerdictOptions::pixel_delay_ms, 0.03, within(0.0, 100.0), "ms",
        "Uncertainty of the pixels' event delay, which depends on light and speed; included in the sigmas of "
        "event cameras' time offsets.",
        Level::Expert, Applies::WithEvents},
    Field{"slow_pixels_ms", &VerdictOptions::slow_pixels_ms, 0.6, within(0.0, 100.0), "ms",
          "Tolerated delay between brightening and darkening edges; beyond it pixels are called slow, and a "
          "quarter of the excess is added to time offset sigmas."},
    Field{"missed_motion_us", &VerdictOptions::missed_motion_us, 5.0, within(0.0, 1e4), "us",
          "Error of an accelerometer's delay caused by motion between knots; included in its sigma."},
    Field{"contradiction_sigmas", &VerdictOptions::contradiction_sigmas, 4.0, within(1.0, 1000.0), "sigma",
          "A warning is issued if a given or prior value differs from the data by more than this."},
    Field{"doubtful_contradiction_sigmas", &VerdictOptions::doubtful_contradiction_sigmas, 8.0,
          within(1.0, 1000.0), "sigma",
          "The result is doubtful if a prior with a sigma differs from the data by more than this.",
          Level::Expert},
    Field{
        "turned_gyroscope_sigmas", &VerdictOptions::turned_gyroscope_sigmas, 4.5, within(1.0, 1000.0),
        "sigma",
        "A misaligned gyroscope is reported beyond this and needed_rotation_deg, if its rotation is fixed."},
    Field{
        "wrong_lens_px", &VerdictOptions::wrong_lens_px, 0.2, within(0.0, 1000.0), "px",
        "The result is doubtful if a fixed lens has a larger projection error than this, RMS over the image.",
        Level::Expert},
    Field{"wrong_lens_sigmas", &VerdictOptions::wrong_lens_sigmas, 6.0, within(1.0, 1000.0), "sigma",
          "Significance required for a wrong_lens_px warning."},
    Field{"other_sensor_sigmas", &VerdictOptions::other_sensor_sigmas, 4.5, within(1.0, 1000.0), "sigma",
          "Cameras with same_sensor_as: the result is doubtful if their poses or lenses differ by more "
          "than this and needed_..., or wrong_lens_px."},
    Field{
        "rolling_shutter_ms", &VerdictOptions::rolling_shutter_ms, 1.5, within(0.0, 1000.0), "ms",
        "The result is doubtful if a camera declared global-shutter has a longer readout than this; rolling "
        "shutters are slower.",
        Level::Expert, Applies::WithFrames},
    Field{"rolling_shutter_sigmas", &VerdictOptions::rolling_shutter_sigmas, 6.0, within(1.0, 1000.0),
          "sigma", "Significance required for a rolling_shutter_ms warning."},
    Field{"bent_board_mm", &VerdictOptions::bent_board_mm, 0.3, within(0.0, 1000.0), "mm",
          "The result is doubtful if a board assumed flat has a larger bow than this over its length.",
          Level::Expert},
    Field{"bent_board_sigmas", &VerdictOptions::bent_board_sigmas, 6.0, within(1.0, 1000.0), "sigma",
          "Significance required for a bent_board_mm warning."},
    Field{"doubtful_scale_sigmas", &VerdictOptions::doubtful_scale_sigmas, 3.0, within(1.0, 1000.0), "sigma",
          "The result is doubtful if the board's size or gravity differs from its given value by more than "
          "this.",
          Level::Expert},
    Field{
        "max_scale_share", &VerdictOptions::max_scale_share, 0.8, within(0.0, 1.0), "",
        "The board's size is tested only if its sigma, divided by the sigma of its prior, is at most this."},
    Field{"moved_lens_deg", &VerdictOptions::moved_lens_deg, 0.3, within(0.0, 180.0), "deg",
          "Smallest camera rotation caused by a moved principal point that a note reports."},
    Field{"tag_corner_px", &VerdictOptions::tag_corner_px, 0.02, within(0.0, 100.0), "px",
          "Smallest mean displacement of tag corners that is corrected."},
    Field{"tag_corner_sigmas", &VerdictOptions::tag_corner_sigmas, 5.0, within(1.0, 1000.0), "sigma",
          "Significance from which the mean displacement of tag corners is corrected."},
    Field{"doubtful_circle_misfit", &VerdictOptions::doubtful_circle_misfit, 2.5, within(1.0, 1000.0), "",
          "The result is doubtful if the median circle error exceeds the front end's sigma by this factor.",
          Level::Expert},
    Field{"failed_circle_misfit", &VerdictOptions::failed_circle_misfit, 25.0, within(1.0, 10000.0), "",
          "The calibration fails if the median circle error exceeds the front end's sigma by this factor.",
          Level::Expert},
    Field{"doubtful_imu_misfit", &VerdictOptions::doubtful_imu_misfit, 5.0, within(1.0, 1000.0), "",
          "The result is doubtful if rate or acceleration errors exceed the given noise by this factor.",
          Level::Expert, Applies::WithImu},
    Field{"failed_imu_misfit", &VerdictOptions::failed_imu_misfit, 200.0, within(1.0, 10000.0), "",
          "The calibration fails if rate or acceleration errors exceed the given noise by this factor.",
          Level::Expert, Applies::WithImu},
    Field{"scattering_stamps_misfit", &VerdictOptions::scattering_stamps_misfit, 1.5, within(1.0, 10000.0),
          "",
          "Scattering stamps are the first reason of a doubtful result if errors of that IMU exceed the "
          "noise by "
          "this factor."},
    Field{"doubtful_outliers", &VerdictOptions::doubtful_outliers, 0.25, within(0.0, 1.0), "",
          "The result is doubtful if a larger share of circles than this is rejected as outliers.",
          Level::Expert},
    Field{"failed_outliers", &VerdictOptions::failed_outliers, 0.6, within(0.0, 1.0), "",
          "The calibration fails if a larger share of circles than this is rejected as outliers.",
          Level::Expert},
    Field{"saturated_share", &VerdictOptions::saturated_share, 0.01, within(0.0, 1.0), "",
          "Saturation is named first as reason of a doubtful result if a larger share of an IMU's samples is "
          "at a "
          "limit.",
          Level::Expert, Applies::WithImu},
    Field{"doubtful_halves_sigmas", &VerdictOptions::doubtful_halves_sigmas, 3.0, within(0.5, 1000.0),
          "sigma", "The result is doubtful if two halves of the recording differ by more than this (RMS).",
          Level::Expert},
    Field{
        "changed_sigmas", &VerdictOptions::changed_sigmas, 8.0, within(1.0, 1000.0), "sigma",
        "The result is doubtful if a camera's pose, a clock or the biases step within the recording by more "
        "than this and needed_...",
        Level::Expert},
    Switch{"judge_sigmas", &VerdictOptions::judge_sigmas, true,
           "Results less certain than needed_... are doubtful; false: only faults in the data make a result "
           "doubtful.",
           Level::Public},
    Field{"needed_rotation_deg", &VerdictOptions::needed_rotation_deg, 0.1, within(1e-4, 90.0), "deg",
          "The result is doubtful if the sigma of a rotation exceeds this.", Level::Public},
    Field{"needed_translation_mm", &VerdictOptions::needed_translation_mm, 1.0, within(1e-3, 1e4), "mm",
          "The result is doubtful if the sigma of a translation exceeds this, excluding the board's size.",
          Level::Public},
    Field{"needed_scale_mm", &VerdictOptions::needed_scale_mm, 3.0, within(1e-3, 1e4), "mm",
          "The result is doubtful if the board's size uncertainty raises a translation's sigma above this.",
          Level::Public},
    Field{"needed_time_offset_ms", &VerdictOptions::needed_time_offset_ms, 0.1, within(1e-4, 1e4), "ms",
          "The result is doubtful if the sigma of a time offset exceeds this.", Level::Public}};
constexpr auto kVerdictDefaults = defaultsOf<VerdictOptions, kVerdictFields>();

}  // namespace

ModelOptions::ModelOptions() : ModelOptions(kModelDefaults) {}

const OptionTable<ModelOptions>& ModelOptions::table() {
  static const OptionTable<ModelOptions> table(kModelFields);
  return table;
}

double boardStretchSigma(double spacing_sigma) {
  return std::numbers::sqrt2 * spacing_sigma;
}

PriorOptions::PriorOptions() : PriorOptions(kPriorDefaults) {}

const OptionTable<PriorOptions>& PriorOptions::table() {
  static const OptionTable<PriorOptions> table(kPriorFields);
  return table;
}

SolverOptions::SolverOptions() : SolverOptions(kSolverDefaults) {}

const OptionTable<SolverOptions>& SolverOptions::table() {
  static const OptionTable<SolverOptions> table(kSolverFields);
  return table;
}

VerdictOptions::VerdictOptions() : VerdictOptions(kVerdictDefaults) {}

const OptionTable<VerdictOptions>& VerdictOptions::table() {
  static const OptionTable<VerdictOptions> table(
      kVerdictFields,
      Ordered{&VerdictOptions::contradiction_sigmas, &VerdictOptions::doubtful_contradiction_sigmas},
      Ordered{&VerdictOptions::doubtful_circle_misfit, &VerdictOptions::failed_circle_misfit},
      Ordered{&VerdictOptions::doubtful_imu_misfit, &VerdictOptions::failed_imu_misfit},
      Ordered{&VerdictOptions::doubtful_outliers, &VerdictOptions::failed_outliers});
  return table;
}

}  // namespace evical
