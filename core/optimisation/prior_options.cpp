#include "core/optimisation/prior_options.h"

#include "core/base/option_table.h"

#include <numbers>

namespace evical {
namespace {

constexpr std::tuple kPriorFields{
    Field{"camera_focal_length_sigma", &PriorOptions::camera_focal_length_sigma, 0.02, within(1e-6, 10.0), "",
          "Weak prior on free focal lengths around those given or found first, relative.", Level::Expert},
    Field{"camera_principal_point_sigma_px", &PriorOptions::camera_principal_point_sigma_px, 10.0,
          within(1e-4, 1e4), "px", "The same of free principal points.", Level::Expert},
    Field{"camera_distortion_sigma", &PriorOptions::camera_distortion_sigma, 0.5, within(1e-6, 100.0), "",
          "The same of each free distortion coefficient.", Level::Expert},
    Field{"edge_lead_sigma_px", &PriorOptions::edge_lead_sigma_px, 0.5, within(1e-6, 10.0), "px",
          "Prior on the lead of measured centres along their image motion, around 0."},
    Field{"slow_edge_lead_sigma_px", &PriorOptions::slow_edge_lead_sigma_px, 0.02, within(1e-6, 10.0), "px",
          "Prior on what edges that hardly move add to that lead, around 0."},
    Field{"longest_readout_ms", &PriorOptions::longest_readout_ms, 40.0, within(0.1, 1e4), "ms",
          "Prior on how long a rolling shutter takes from its first row to its last, around 0: no longer "
          "than a "
          "frame of 25 a second.",
          Level::Expert, Applies::WithFrames},
    Field{"time_offset_drift_sigma_ppm", &PriorOptions::time_offset_drift_sigma_ppm, 50.0, within(1e-4, 1e5),
          "ppm", "Prior on the drift of time offsets around 0.", Level::Expert},
    Field{"exposure_share_sigma", &PriorOptions::exposure_share_sigma, 0.5, within(1e-4, 100.0), "",
          "Prior, around 0, on how much of a frame's exposure passes from its stamp to its middle; estimated "
          "where "
          "exposures vary. Stamps are at the exposure's begin (0.5), middle (0) or end (-0.5).",
          Level::Expert, Applies::WithFrames},
    Field{"mapping_sigma", &PriorOptions::mapping_sigma, 0.05, within(1e-6, 10.0), "",
          "Weak prior on each entry of M_g and M_a around the identity.", Level::Expert, Applies::WithImu},
    Field{"gyroscope_rotation_sigma_deg", &PriorOptions::gyroscope_rotation_sigma_deg, 5.0,
          within(1e-3, 180.0), "deg", "Weak prior on gyroscopes' turns around 0.", Level::Expert,
          Applies::WithFreeGyroscopeTurns},
    Field{"accelerometer_delay_sigma_s", &PriorOptions::accelerometer_delay_sigma_s, 0.005, within(1e-6, 1.0),
          "s", "Prior on how late accelerometers are against their gyroscopes, around 0.", Level::Expert,
          Applies::WithImu},
    Field{"gyroscope_bias_sigma_rad_s", &PriorOptions::gyroscope_bias_sigma_rad_s, 1.0, within(1e-6, 100.0),
          "rad/s", "Weak prior on gyroscope biases around 0.", Level::Expert, Applies::WithImu},
    Field{"accelerometer_bias_sigma_m_s2", &PriorOptions::accelerometer_bias_sigma_m_s2, 1.0,
          within(1e-6, 100.0), "m/s^2", "Weak prior on accelerometer biases around 0.", Level::Expert,
          Applies::WithImu},
    Field{"translation_sigma_m", &PriorOptions::translation_sigma_m, 0.5, within(1e-3, 1e3), "m",
          "Weak prior on translations between sensors around 0, for motions that don't tell them.",
          Level::Expert},
    Field{"gravity_norm_sigma_m_s2", &PriorOptions::gravity_norm_sigma_m_s2, 0.02, within(1e-6, 10.0),
          "m/s^2", "Prior on gravity's norm around initialisation.gravity_m_s2, where it is free.",
          Level::Public, Applies::WithFreeGravityNorm},
    Field{"board_spacing_sigma", &PriorOptions::board_spacing_sigma, 0.002, within(1e-7, 1.0), "",
          "How well the board was measured, relative: prior on its size; the session's board.spacing_std. A "
          "ruler over the whole board tells 0.1 to 0.2 %.",
          Level::Public},
    Field{"board_bow_sigma_mm", &PriorOptions::board_bow_sigma_mm, 2.0, within(1e-4, 1e4), "mm",
          "Prior around 0 on how far the middle of the board stands out over each of its lengths.",
          Level::Expert},
    Field{
        "smooth_rotation_rad_s2", &PriorOptions::smooth_rotation_rad_s2, 200.0, within(0.1, 1e6), "rad/s^2",
        "Without an IMU: angular accelerations at each knot are 0 +- smooth_unevenness times their RMS where "
        "views tell it, or this if it is less; bridges gaps between views.",
        Level::Expert, Applies::WithoutImu},
    Field{"smooth_position_m_s2", &PriorOptions::smooth_position_m_s2, 30.0, within(0.01, 1e6), "m/s^2",
          "The same of accelerations.", Level::Expert, Applies::WithoutImu},
    Field{
        "smooth_unevenness", &PriorOptions::smooth_unevenness, 3.0, within(0.1, 1000.0), "",
        "Hands don't move evenly, and accelerations last longer than a knot: their spread in units of their "
        "RMS."}};
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
