#include "core/optimisation/prior_options.h"

#include "core/base/option_table.h"

#include <numbers>

namespace evical {
namespace {

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
    Field{"longest_readout_ms", &PriorOptions::longest_readout_ms, 40.0, within(0.1, 1e4), "ms",
          "Sigma of the prior, around 0, on a rolling shutter's readout time from the first row to the last.",
          Level::Expert, Applies::WithFrames},
    Field{"time_offset_drift_sigma_ppm", &PriorOptions::time_offset_drift_sigma_ppm, 50.0, within(1e-4, 1e5),
          "ppm", "Sigma of the prior, around 0, on the drift of time offsets.", Level::Expert},
    Field{
        "exposure_share_sigma", &PriorOptions::exposure_share_sigma, 0.5, within(1e-4, 100.0), "",
        "Sigma of the prior, around 0, on the exposure's share between stamp and middle (0.5: stamped at the "
        "beginning), estimated if exposures vary.",
        Level::Expert, Applies::WithFrames},
    Field{"mapping_sigma", &PriorOptions::mapping_sigma, 0.05, within(1e-6, 10.0), "",
          "Sigma of the weak prior on each entry of M_g and M_a, around the identity.", Level::Expert,
          Applies::WithImu},
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

}  // namespace

double boardStretchSigma(double spacing_sigma) {
  return std::numbers::sqrt2 * spacing_sigma;
}

PriorOptions::PriorOptions() : PriorOptions(kPriorDefaults) {}

const OptionTable<PriorOptions>& PriorOptions::table() {
  static const OptionTable<PriorOptions> table(kPriorFields);
  return table;
}

}  // namespace evical
