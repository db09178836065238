#include "core/initialisation/initialisation_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kInitialisationFields{
    Field{"knot_spacing_s", &InitialisationOptions::knot_spacing_s, 0.0, within(0.0, 0.1), "s",
          "Of both splines; 0: as close as the motion asks for, 2.5 to 100 ms.", Level::Expert,
          Applies::WithImu},
    Field{"time_offset_search_s", &InitialisationOptions::time_offset_search_s, 1.0, within(0.0, 60.0), "s",
          "The camera's time offset is looked for within plus or minus this.", Level::Public},
    Field{"widest_time_offset_search_s", &InitialisationOptions::widest_time_offset_search_s, 60.0,
          within(0.0, 600.0), "s",
          "Where rotation rates agree at no time offset there, and none is known, the search widens to this.",
          Level::Expert, Applies::WithImu},
    Field{"largest_reprojection_px", &InitialisationOptions::largest_reprojection_px, 2.0, within(0.05, 20.0),
          "px", "Views whose circles fit a pose worse than this are left out.", Level::Expert},
    Field{"largest_rotation_disagreement_rad", &InitialisationOptions::largest_rotation_disagreement_rad,
          0.06, within(1e-3, 1.0), "rad",
          "Views whose rotation the gyroscope contradicts by more are left out."},
    Field{"clear_peak_correlation", &InitialisationOptions::clear_peak_correlation, 0.7, within(0.0, 1.0), "",
          "Correlation of rotation rates below which the time offset gets a warning."},
    Field{"clear_peak_lead", &InitialisationOptions::clear_peak_lead, 0.02, within(0.0, 1.0), "",
          "Lead in correlation over the next best time offset below which a warning says so."},
    Field{
        "largest_unexplained_motion", &InitialisationOptions::largest_unexplained_motion, 0.4,
        within(0.01, 10.0), "",
        "Share of what the gyroscope turns, or of what accelerations vary by, that no mounting of the camera "
        "explains: beyond this the calibration fails."},
    Field{"pair_gap_s", &InitialisationOptions::pair_gap_s, 0.1, within(0.01, 2.0), "s",
          "Views at least this far apart give a relative rotation."},
    Field{"longest_pair_s", &InitialisationOptions::longest_pair_s, 0.3, within(0.02, 5.0), "s",
          "But no further than this."},
    Field{"least_views", &InitialisationOptions::least_views, 15, within(4, 100000), "",
          "Views of the board that are needed.", Level::Expert},
    Field{"least_overlap_s", &InitialisationOptions::least_overlap_s, 3.0, within(0.5, 60.0), "s",
          "Camera and IMU must both have recorded for this long.", Level::Expert, Applies::WithImu},
    Field{"least_rotation_rate_rad_s", &InitialisationOptions::least_rotation_rate_rad_s, 0.01,
          within(0.0, 10.0), "rad/s",
          "RMS rate about its mean below which a recording holds no usable rotation."},
    Field{"gravity_m_s2", &InitialisationOptions::gravity_m_s2, 9.81, within(0.1, 100.0), "m/s^2",
          "Norm of gravity.", Level::Public, Applies::WithImu},
    Field{"margin_s", &InitialisationOptions::margin_s, 0.15, within(0.0, 5.0), "s",
          "The splines reach this far beyond the first and the last view."},
    Field{"longest_imu_gap_s", &InitialisationOptions::longest_imu_gap_s, 0.05, within(1e-3, 10.0), "s",
          "Longer gaps between IMU samples get a warning."},
    Field{"least_axis_ratio", &InitialisationOptions::least_axis_ratio, 0.05, within(0.0, 1.0), "",
          "Rotation about a second axis, relative to the first, below which a warning is given."},
    Field{"position_sigma_m", &InitialisationOptions::position_sigma_m, 2e-3, within(1e-6, 1.0), "m",
          "Of camera positions from single views."},
    Field{"acceleration_sigma_m_s2", &InitialisationOptions::acceleration_sigma_m_s2, 0.1,
          within(1e-6, 100.0), "m/s^2", "Of accelerations averaged over a quarter of a knot."},
    Field{"translation_sigma_m", &InitialisationOptions::translation_sigma_m, 0.2, within(1e-3, 100.0), "m",
          "Weak prior on the camera's place around the IMU."},
    Field{"accelerometer_bias_sigma_m_s2", &InitialisationOptions::accelerometer_bias_sigma_m_s2, 0.5,
          within(1e-3, 100.0), "m/s^2", "Weak prior on the accelerometer's bias around 0."},
    Field{"accelerometer_mapping_sigma", &InitialisationOptions::accelerometer_mapping_sigma, 0.05,
          within(1e-6, 1.0), "",
          "Weak prior on the accelerometer's scales and axes where the board's scale is checked."},
    Field{"largest_scale_error", &InitialisationOptions::largest_scale_error, 0.03, within(0.0, 10.0), "",
          "A board that accelerations say is larger or smaller than spacing_m by more makes the result "
          "doubtful.",
          Level::Expert, Applies::WithImu},
    Field{"scale_error_sigmas", &InitialisationOptions::scale_error_sigmas, 5.0, within(1.0, 100.0), "sigma",
          "A scale error counts only if it is as certain as this."},
    Field{"camera_knot_spacing_s", &InitialisationOptions::camera_knot_spacing_s, 0.03, within(0.005, 0.1),
          "s", "Without an IMU: knot spacing of the reference camera's trajectory.", Level::Expert,
          Applies::WithoutImu},
    Field{"longest_shared_gap_s", &InitialisationOptions::longest_shared_gap_s, 0.1, within(0.005, 2.0), "s",
          "Without an IMU: views of the reference camera that are further apart say nothing of the time "
          "between."},
    Field{
        "longest_bridge_s", &InitialisationOptions::longest_bridge_s, 0.12, within(0.01, 5.0), "s",
        "Without an IMU, cameras that see the board in turns: from the last view of one to the first of the "
        "other at most. With longer gaps time offsets go astray."},
    Field{"least_bridges", &InitialisationOptions::least_bridges, 4, within(2, 1000), "",
          "How often the board must pass from one of them to the other, half of it either way."},
    Field{"least_bridge_agreement", &InitialisationOptions::least_bridge_agreement, 0.8, within(0.0, 1.0), "",
          "Share of these gaps that must agree: at wrong time offsets some do by chance."},
    Field{"least_imu_samples", &InitialisationOptions::least_imu_samples, 50, within(10, 1000000), "",
          "Samples that an IMU must have."},
    Field{"least_acceleration_m_s2", &InitialisationOptions::least_acceleration_m_s2, 4.0,
          within(0.0, 1000.0), "m/s^2", "A median acceleration below this is taken for a wrong unit."},
    Field{"largest_acceleration_m_s2", &InitialisationOptions::largest_acceleration_m_s2, 40.0,
          within(0.0, 10000.0), "m/s^2", "The same above this."},
    Field{"largest_rotation_rate_rad_s", &InitialisationOptions::largest_rotation_rate_rad_s, 25.0,
          within(0.1, 1000.0), "rad/s", "RMS rates above this are taken for deg/s."},
    Field{"ambiguous_pose_ratio", &InitialisationOptions::ambiguous_pose_ratio, 2.0, within(1.0, 100.0), "",
          "A plane's other pose stays possible while its error is at most this many times the better one's."},
    Field{"ambiguous_pose_px", &InitialisationOptions::ambiguous_pose_px, 0.02, within(0.0, 10.0), "px",
          "Added to that bound."},
    Field{"fastest_view_ratio", &InitialisationOptions::fastest_view_ratio, 1.3, within(1.0, 100.0), "",
          "Views that turn this many times faster than the gyroscope ever does don't tell the time offset."},
    Field{"most_time_offsets", &InitialisationOptions::most_time_offsets, 6, within(1, 100), "",
          "Peaks of the correlation that are tried."},
    Field{"time_offset_reach_s", &InitialisationOptions::time_offset_reach_s, 0.1, within(0.001, 10.0), "s",
          "How far from such a peak the time offset may be."},
    Field{"better_alignment", &InitialisationOptions::better_alignment, 0.8, within(0.01, 1.0), "",
          "A less significant peak is taken where its misfit is below this share of the best one's."},
    Field{"agreement_window_s", &InitialisationOptions::agreement_window_s, 3.0, within(0.1, 60.0), "s",
          "Views within this of each other, either way, vote on their rotations."},
    Field{"least_agreement", &InitialisationOptions::least_agreement, 0.3, within(0.0, 1.0), "",
          "Share of these with which a view must agree to be kept."},
    Field{"outlier_sigma", &InitialisationOptions::outlier_sigma, 5.0, within(0.5, 1000.0), "sigma",
          "Positions and accelerations this far off count half."}};
constexpr auto kInitialisationDefaults = defaultsOf<InitialisationOptions, kInitialisationFields>();

}  // namespace

InitialisationOptions::InitialisationOptions() : InitialisationOptions(kInitialisationDefaults) {}

const OptionTable<InitialisationOptions>& InitialisationOptions::table() {
  static const OptionTable<InitialisationOptions> table(
      kInitialisationFields,
      Ordered{&InitialisationOptions::pair_gap_s, &InitialisationOptions::longest_pair_s},
      Ordered{&InitialisationOptions::least_acceleration_m_s2,
              &InitialisationOptions::largest_acceleration_m_s2},
      Ordered{&InitialisationOptions::least_rotation_rate_rad_s,
              &InitialisationOptions::largest_rotation_rate_rad_s});
  return table;
}

}  // namespace evical
