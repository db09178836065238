// What the batch optimisation lets people choose.
#pragma once

#include "core/base/option_field.h"

namespace evical {

// How far the staged release has gone.
enum class ReleaseStages { Extrinsics, FurtherImus, Mappings };

// Automatic: free where they were found from the same recording first, fixed where the session gives them.
enum class CameraIntrinsicsChoice { Automatic, Fixed, Free };
enum class BiasModel { Constant, Linear };

struct OptimisationOptions {
  bool free_time_offsets = true;
  bool time_offset_drift = false;
  double time_offset_drift_sigma_ppm = 50.0;
  bool free_imu_intrinsics = true;
  bool free_gravity_norm = false;
  CameraIntrinsicsChoice camera_intrinsics = CameraIntrinsicsChoice::Automatic;
  double camera_focal_length_sigma = 0.02;
  double camera_principal_point_sigma_px = 10.0;
  double camera_distortion_sigma = 0.5;
  double huber_sigma = 2.5;
  double outlier_sigma = 6.0;
  double outlier_window_fraction = 0.5;
  double edge_lead_sigma_px = 0.5;
  double edge_lead_growth_sigma_px = 0.01;
  double rest_speed_px_s = 5.0;
  double least_centre_sigma_px = 0.01;
  double mapping_sigma = 0.05;
  bool gyroscope_rotation = false;
  double gyroscope_rotation_sigma_deg = 5.0;
  BiasModel bias_model = BiasModel::Constant;
  double bias_knot_spacing_s = 5.0;
  int most_bias_knots = 48;
  double gyroscope_random_walk = 2.66e-5;
  double accelerometer_random_walk = 4.33e-4;
  double gyroscope_bias_sigma_rad_s = 1.0;
  double accelerometer_bias_sigma_m_s2 = 1.0;
  double translation_sigma_m = 0.5;
  double gravity_norm_sigma_m_s2 = 0.05;
  double segment_drift = 0.05;
  double function_tolerance = 1e-6;
  double stage_tolerance = 1e-4;
  int max_iterations = 30;
  int max_rounds = 5;
  int threads = 2;
  double smooth_rotation_rad_s2 = 200.0;
  double smooth_position_m_s2 = 30.0;
  double smooth_unevenness = 3.0;
  double correlation_time_s = 0.2;
  double pixel_error_px = 0.1;
  double contradiction_sigmas = 4.0;
  double turned_gyroscope_sigmas = 6.0;
  double needed_rotation_deg = 0.1;
  double needed_translation_mm = 1.0;
  double needed_time_offset_ms = 0.1;

  bool operator==(const OptimisationOptions&) const = default;
};

inline constexpr auto kOptimisationFields = std::tuple{
    Switch{"free_time_offsets", &OptimisationOptions::free_time_offsets,
           "Estimate time offsets; else each stays at the session's prior value, or 0 without one."},
    Switch{"time_offset_drift", &OptimisationOptions::time_offset_drift,
           "Estimate how each time offset drifts, as clocks of their own do. With a weighed prior it "
           "is estimated in any case."},
    Field{"time_offset_drift_sigma_ppm", &OptimisationOptions::time_offset_drift_sigma_ppm, 1e-4, 1e5, "ppm",
          "Prior on that drift around 0."},
    Switch{"free_imu_intrinsics", &OptimisationOptions::free_imu_intrinsics,
           "Estimate scales and misalignments M_g and M_a; else each stays at the session's prior value, or "
           "the identity without one. Biases stay free."},
    Switch{"free_gravity_norm", &OptimisationOptions::free_gravity_norm,
           "Estimate gravity's norm, too, not its direction only."},
    Choice{"camera_intrinsics", &OptimisationOptions::camera_intrinsics,
           std::array{"automatic", "fixed", "free"},
           "Whether cameras' intrinsics are solved for with everything else, in the last stage; automatic: "
           "where they were found from the same recording first."},
    Field{"camera_focal_length_sigma", &OptimisationOptions::camera_focal_length_sigma, 1e-6, 10.0, "",
          "Weak prior on free focal lengths around those given or found first, relative."},
    Field{"camera_principal_point_sigma_px", &OptimisationOptions::camera_principal_point_sigma_px, 1e-4, 1e4,
          "px", "The same of free principal points."},
    Field{"camera_distortion_sigma", &OptimisationOptions::camera_distortion_sigma, 1e-6, 100.0, "",
          "The same of each free distortion coefficient."},
    Field{"huber_sigma", &OptimisationOptions::huber_sigma, 0.5, 100.0, "sigma",
          "Circle residuals beyond this pull with constant force."},
    Field{"outlier_sigma", &OptimisationOptions::outlier_sigma, 2.0, 1000.0, "sigma",
          "Circles further from their place, in units of the spread of all, are dropped between stages."},
    Field{"outlier_window_fraction", &OptimisationOptions::outlier_window_fraction, 0.1, 1.0, "",
          "A window loses all its circles if more than this share of them is dropped."},
    Field{"edge_lead_sigma_px", &OptimisationOptions::edge_lead_sigma_px, 1e-6, 10.0, "px",
          "Prior on the lead of measured centres along their image motion, around 0."},
    Field{"edge_lead_growth_sigma_px", &OptimisationOptions::edge_lead_growth_sigma_px, 1e-6, 10.0, "px",
          "Prior on how much that lead grows with each factor e of image speed, around 0."},
    Field{"rest_speed_px_s", &OptimisationOptions::rest_speed_px_s, 0.1, 1000.0, "px/s",
          "Below this image speed the edge lead fades to 0."},
    Field{"least_centre_sigma_px", &OptimisationOptions::least_centre_sigma_px, 0.0, 10.0, "px",
          "Added in squares to the covariance of each measured centre."},
    Field{"mapping_sigma", &OptimisationOptions::mapping_sigma, 1e-6, 10.0, "",
          "Weak prior on each entry of M_g and M_a around the identity."},
    Switch{
        "gyroscope_rotation", &OptimisationOptions::gyroscope_rotation,
        "Estimate how each gyroscope is turned against its accelerometer, whose frame is the IMU's. With a "
        "weighed prior it is estimated in any case."},
    Field{"gyroscope_rotation_sigma_deg", &OptimisationOptions::gyroscope_rotation_sigma_deg, 1e-3, 180.0,
          "deg", "Weak prior on that turn around 0."},
    Choice{"bias_model", &OptimisationOptions::bias_model, std::array{"constant", "linear"},
           "Biases over a recording: constant, or straight lines between knots that walk at random."},
    Field{"bias_knot_spacing_s", &OptimisationOptions::bias_knot_spacing_s, 0.1, 1e4, "s",
          "Linear biases: knots are at most this far apart, closer where the random walk asks for it."},
    Field{"most_bias_knots", &OptimisationOptions::most_bias_knots, 2, 1000, "",
          "Linear biases: no more knots an IMU than this, as uncertainty takes time and memory with them."},
    Field{"gyroscope_random_walk", &OptimisationOptions::gyroscope_random_walk, 1e-9, 1.0, "rad/s^2/sqrt(Hz)",
          "Linear biases: how fast gyroscope biases drift where the session does not say it. The default is "
          "Kalibr's example for an ADIS16448, as the noise densities are."},
    Field{"accelerometer_random_walk", &OptimisationOptions::accelerometer_random_walk, 1e-9, 10.0,
          "m/s^3/sqrt(Hz)", "The same of accelerometer biases."},
    Field{"gyroscope_bias_sigma_rad_s", &OptimisationOptions::gyroscope_bias_sigma_rad_s, 1e-6, 100.0,
          "rad/s", "Weak prior on gyroscope biases around 0."},
    Field{"accelerometer_bias_sigma_m_s2", &OptimisationOptions::accelerometer_bias_sigma_m_s2, 1e-6, 100.0,
          "m/s^2", "Weak prior on accelerometer biases around 0."},
    Field{"translation_sigma_m", &OptimisationOptions::translation_sigma_m, 1e-3, 1e3, "m",
          "Weak prior on translations between sensors around 0, for motions that don't tell them."},
    Field{"gravity_norm_sigma_m_s2", &OptimisationOptions::gravity_norm_sigma_m_s2, 1e-6, 10.0, "m/s^2",
          "Prior on gravity's norm around initialisation.gravity_m_s2, where it is free."},
    Field{"segment_drift", &OptimisationOptions::segment_drift, 0.001, 0.5, "knots",
          "A time offset may move this far before measurements are assigned to spline segments anew."},
    Field{"function_tolerance", &OptimisationOptions::function_tolerance, 1e-14, 1e-2, "",
          "The last stage ends when the cost changes by less than this fraction."},
    Field{"stage_tolerance", &OptimisationOptions::stage_tolerance, 1e-14, 1e-1, "",
          "The same for the stages before the last."},
    Field{"max_iterations", &OptimisationOptions::max_iterations, 1, 1000, "", "Iterations of one solve."},
    Field{"max_rounds", &OptimisationOptions::max_rounds, 1, 100, "",
          "Solves of one stage, each with measurements assigned to spline segments anew."},
    Field{"threads", &OptimisationOptions::threads, 1, 256, "", "Threads that evaluate residuals."},
    Field{
        "smooth_rotation_rad_s2", &OptimisationOptions::smooth_rotation_rad_s2, 0.1, 1e6, "rad/s^2",
        "Without an IMU: angular accelerations at each knot are 0 +- smooth_unevenness times their RMS where "
        "views tell it, or this if it is less; bridges gaps between views."},
    Field{"smooth_position_m_s2", &OptimisationOptions::smooth_position_m_s2, 0.01, 1e6, "m/s^2",
          "The same of accelerations."},
    Field{
        "smooth_unevenness", &OptimisationOptions::smooth_unevenness, 0.1, 1000.0, "",
        "Hands don't move evenly, and accelerations last longer than a knot: their spread in units of their "
        "RMS."},
    Field{"correlation_time_s", &OptimisationOptions::correlation_time_s, 0.001, 10.0, "s",
          "Residuals nearer in time than this may be correlated; the reported sigmas allow for it."},
    Field{"pixel_error_px", &OptimisationOptions::pixel_error_px, 0.0, 10.0, "px",
          "Error of edges that repeats at the same pixel, so that motion over few pixels shows a wrong "
          "amplitude: part of the sigmas."},
    Field{"contradiction_sigmas", &OptimisationOptions::contradiction_sigmas, 1.0, 1000.0, "sigma",
          "Known values that lie further than this from what the recording alone says are told of."},
    Field{"turned_gyroscope_sigmas", &OptimisationOptions::turned_gyroscope_sigmas, 1.0, 1000.0, "sigma",
          "A gyroscope's turn that is not estimated is told of beyond this and needed_rotation_deg."},
    Field{"needed_rotation_deg", &OptimisationOptions::needed_rotation_deg, 1e-4, 90.0, "deg",
          "Rotations less certain than this make the result doubtful."},
    Field{"needed_translation_mm", &OptimisationOptions::needed_translation_mm, 1e-3, 1e4, "mm",
          "Translations less certain than this make the result doubtful."},
    Field{"needed_time_offset_ms", &OptimisationOptions::needed_time_offset_ms, 1e-4, 1e4, "ms",
          "Time offsets less certain than this make the result doubtful."}};
static_assert(fieldCount<OptimisationOptions>() == std::tuple_size_v<decltype(kOptimisationFields)>);

inline ReleaseStages lastStage(const OptimisationOptions& options) {
  return options.free_imu_intrinsics ? ReleaseStages::Mappings : ReleaseStages::FurtherImus;
}

}  // namespace evical
