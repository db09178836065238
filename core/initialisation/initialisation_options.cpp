#include "core/initialisation/initialisation_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kInitialisationFields{
    Field{"knot_spacing_s", &InitialisationOptions::knot_spacing_s, 0.0, within(0.0, 0.1), "s",
          "Knot spacing of both splines; 0: adapted to the motion, 2.5 to 100 ms.", Level::Expert,
          Applies::WithImu},
    Field{"time_offset_search_s", &InitialisationOptions::time_offset_search_s, 1.0, within(0.0, 60.0), "s",
          "Largest magnitude of the camera's time offset in its search.", Level::Public},
    Field{"widest_time_offset_search_s", &InitialisationOptions::widest_time_offset_search_s, 60.0,
          within(0.0, 600.0), "s",
          "Widest search range, used if rotation rates agree at no offset in time_offset_search_s and none "
          "is given.",
          Level::Expert, Applies::WithImu},
    Field{"max_reprojection_px", &InitialisationOptions::max_reprojection_px, 2.0, within(0.05, 20.0), "px",
          "Largest reprojection error of a used view.", Level::Expert},
    Field{"max_rotation_disagreement_rad", &InitialisationOptions::max_rotation_disagreement_rad, 0.06,
          within(1e-3, 1.0), "rad",
          "Largest difference between the rotations of a used view and of the gyroscope."},
    Field{"clear_peak_correlation", &InitialisationOptions::clear_peak_correlation, 0.7, within(0.0, 1.0), "",
          "Correlation of rotation rates below which the time offset gets a warning."},
    Field{"clear_peak_lead", &InitialisationOptions::clear_peak_lead, 0.02, within(0.0, 1.0), "",
          "Smallest lead in correlation over the next best time offset; below it a warning is given."},
    Field{"max_unexplained_motion", &InitialisationOptions::max_unexplained_motion, 0.4, within(0.01, 10.0),
          "",
          "Largest share of the gyroscope's rotation, or of the accelerations' variation, that no mounting "
          "explains; above it the calibration fails."},
    Field{"suspicious_motion", &InitialisationOptions::suspicious_motion, 0.25, within(0.0, 1.0), "",
          "Share of max_unexplained_motion from which other axes and signs of the IMU are tested."},
    Field{"far_better", &InitialisationOptions::far_better, 0.5, within(0.0, 1.0), "",
          "Largest ratio of misfits at which other axes or signs, or a mirrored image, are the cause."},
    Field{"much_better", &InitialisationOptions::much_better, 0.2, within(0.0, 1.0), "",
          "The same for a gyroscope's reflection, if the rotations agree up to max_unexplained_motion."},
    Field{"pair_gap_s", &InitialisationOptions::pair_gap_s, 0.1, within(0.01, 2.0), "s",
          "Smallest interval between the two views of a relative rotation."},
    Field{"max_pair_s", &InitialisationOptions::max_pair_s, 0.3, within(0.02, 5.0), "s",
          "Largest interval between the two views of a relative rotation."},
    Field{"min_views", &InitialisationOptions::min_views, 15, within(4, 100000), "",
          "Smallest number of views of the board.", Level::Expert},
    Field{"min_overlap_s", &InitialisationOptions::min_overlap_s, 3.0, within(0.5, 60.0), "s",
          "Smallest overlap in time of camera and IMU.", Level::Expert, Applies::WithImu},
    Field{"min_rotation_rate_rad_s", &InitialisationOptions::min_rotation_rate_rad_s, 0.01, within(0.0, 10.0),
          "rad/s", "Smallest RMS rotation rate about its mean in a usable recording."},
    Field{"gravity_m_s2", &InitialisationOptions::gravity_m_s2, 9.81, within(0.1, 100.0), "m/s^2",
          "Norm of gravity.", Level::Public, Applies::WithImu},
    Field{"margin_s", &InitialisationOptions::margin_s, 0.15, within(0.0, 5.0), "s",
          "Time by which the splines extend beyond the first and the last view."},
    Field{"max_imu_gap_s", &InitialisationOptions::max_imu_gap_s, 0.05, within(1e-3, 10.0), "s",
          "Longest gap between IMU samples without a warning."},
    Field{"min_axis_ratio", &InitialisationOptions::min_axis_ratio, 0.05, within(0.0, 1.0), "",
          "Smallest rotation about a second axis, relative to the first, without a warning."},
    Field{"position_sigma_m", &InitialisationOptions::position_sigma_m, 2e-3, within(1e-6, 1.0), "m",
          "Sigma of camera positions from single views."},
    Field{"acceleration_sigma_m_s2", &InitialisationOptions::acceleration_sigma_m_s2, 0.1,
          within(1e-6, 100.0), "m/s^2", "Sigma of accelerations averaged over a quarter of a knot spacing."},
    Field{"translation_sigma_m", &InitialisationOptions::translation_sigma_m, 0.2, within(1e-3, 100.0), "m",
          "Sigma of the weak prior of the camera's position, around the IMU."},
    Field{"accelerometer_bias_sigma_m_s2", &InitialisationOptions::accelerometer_bias_sigma_m_s2, 0.5,
          within(1e-3, 100.0), "m/s^2", "Sigma of the weak prior of the accelerometer's bias, around 0."},
    Field{
        "accelerometer_scale_misalignment_sigma",
        &InitialisationOptions::accelerometer_scale_misalignment_sigma, 0.05, within(1e-6, 1.0), "",
        "Sigma of the weak prior of the accelerometer's scales and axes in the check of the board's scale."},
    Field{"max_scale_error", &InitialisationOptions::max_scale_error, 0.03, within(0.0, 10.0), "",
          "Largest relative difference between the board's scale from accelerations and spacing_m; above it "
          "the result is "
          "doubtful.",
          Level::Expert, Applies::WithImu},
    Field{"scale_error_sigmas", &InitialisationOptions::scale_error_sigmas, 5.0, within(1.0, 100.0), "sigma",
          "Smallest significance of a reported scale error."},
    Field{"camera_knot_spacing_s", &InitialisationOptions::camera_knot_spacing_s, 0.03, within(0.005, 0.1),
          "s", "Knot spacing of the reference camera's trajectory, without an IMU.", Level::Expert,
          Applies::WithoutImu},
    Field{"max_shared_gap_s", &InitialisationOptions::max_shared_gap_s, 0.1, within(0.005, 2.0), "s",
          "Longest gap between views of the reference camera in which its motion is known, without an "
          "IMU."},
    Field{"max_bridge_s", &InitialisationOptions::max_bridge_s, 0.12, within(0.01, 5.0), "s",
          "Longest gap between the last view of one camera and the first of the other, without an IMU and "
          "for cameras that see the board alternately."},
    Field{"min_bridges", &InitialisationOptions::min_bridges, 4, within(2, 1000), "",
          "Smallest number of gaps between cameras that see the board alternately, half of them in either "
          "direction."},
    Field{"min_bridge_agreement", &InitialisationOptions::min_bridge_agreement, 0.8, within(0.0, 1.0), "",
          "Smallest share of consistent gaps; at wrong time offsets some agree by chance."},
    Field{"min_board_agreement", &InitialisationOptions::min_board_agreement, 0.75, within(0.0, 1.0), "",
          "Smallest share of a further board's views that agree on its pose; the gyroscope has removed most "
          "misidentified ones."},
    Field{"min_imu_samples", &InitialisationOptions::min_imu_samples, 50, within(10, 1000000), "",
          "Smallest number of samples of an IMU."},
    Field{"min_acceleration_m_s2", &InitialisationOptions::min_acceleration_m_s2, 4.0, within(0.0, 1000.0),
          "m/s^2", "Smallest plausible median acceleration; below it the unit is assumed to be wrong."},
    Field{"max_acceleration_m_s2", &InitialisationOptions::max_acceleration_m_s2, 40.0, within(0.0, 10000.0),
          "m/s^2", "Largest plausible median acceleration; above it the unit is assumed to be wrong."},
    Field{"max_rotation_rate_rad_s", &InitialisationOptions::max_rotation_rate_rad_s, 25.0,
          within(0.1, 1000.0), "rad/s",
          "Largest plausible RMS rate; above it the unit is assumed to be deg/s."},
    Field{"wrong_rate_ratio", &InitialisationOptions::wrong_rate_ratio, 1.2, within(1.01, 100.0), "",
          "Smallest ratio of the gyroscope's rates to the camera's that is named as the cause of a failure."},
    Field{
        "rate_unit_tolerance", &InitialisationOptions::rate_unit_tolerance, 0.1, within(0.001, 1.0), "",
        "Largest difference of such a ratio from that of a unit; a slightly wrong lens changes rates, too."},
    Field{"wrong_force_ratio", &InitialisationOptions::wrong_force_ratio, 1.5, within(1.01, 100.0), "",
          "Smallest ratio of the median acceleration to gravity that is named as the cause of a failure; "
          "motion shifts it by a tenth."},
    Field{"force_unit_tolerance", &InitialisationOptions::force_unit_tolerance, 0.15, within(0.001, 1.0), "",
          "Largest difference of such a ratio from that of a unit."},
    Field{"wrong_size_ratio", &InitialisationOptions::wrong_size_ratio, 1.3, within(1.01, 100.0), "",
          "Smallest ratio of the board's spacing to that from accelerations that is named as the cause of "
          "doubt."},
    Field{"settled_size", &InitialisationOptions::settled_size, 0.02, within(1e-4, 1.0), "",
          "Largest relative change of the board's size from accelerations when it has settled."},
    Field{"wrong_radius_ratio", &InitialisationOptions::wrong_radius_ratio, 1.35, within(1.01, 100.0), "",
          "Smallest ratio of the circles' radius to that of their edges that makes the result doubtful."},
    Field{"wrong_lens_share", &InitialisationOptions::wrong_lens_share, 0.02, within(1e-4, 10.0), "",
          "Smallest projection error of a given lens that makes the result doubtful, RMS, relative to the "
          "image's diagonal."},
    Field{"wrong_lens_sigmas", &InitialisationOptions::wrong_lens_sigmas, 6.0, within(1.0, 100.0), "sigma",
          "Smallest significance of a wrong lens."},
    Field{"wrong_noise_ratio", &InitialisationOptions::wrong_noise_ratio, 12.0, within(1.1, 1e6), "",
          "Smallest ratio of a noise density to that of the samples with a warning."},
    Field{"noise_agreement_ratio", &InitialisationOptions::noise_agreement_ratio, 3.0, within(1.0, 100.0), "",
          "Largest ratio of the samples' noise to the residuals at which the noise explains the residuals."},
    Field{"noise_unit_ratio", &InitialisationOptions::noise_unit_ratio, 1.5, within(1.0, 100.0), "",
          "Largest ratio of a noise density, read in another unit, to that of the samples if the unit is "
          "wrong."},
    Field{"wrong_clock_prior_sigmas", &InitialisationOptions::wrong_clock_prior_sigmas, 50.0,
          within(1.0, 1e6), "",
          "Smallest drift of a time offset, in sigmas of its prior, that is a clock's wrong rate."},
    Field{"wrong_clock_sigmas", &InitialisationOptions::wrong_clock_sigmas, 5.0, within(1.0, 1e6), "",
          "Smallest significance of such a drift."},
    Field{"wrong_clock_share", &InitialisationOptions::wrong_clock_share, 0.3, within(0.01, 1.0), "",
          "Smallest share of a drift's information by which it is divided, to remove the pull of its prior."},
    Field{"gravity_rate_tolerance", &InitialisationOptions::gravity_rate_tolerance, 0.1, within(0.001, 1.0),
          "", "Largest relative difference of the rates' norm from gravity's if both sensors are exchanged."},
    Field{"exchanged_force_share", &InitialisationOptions::exchanged_force_share, 0.5, within(0.01, 1.0), "",
          "Largest median acceleration, in units of gravity, if both sensors are exchanged."},
    Field{"min_imu_coverage", &InitialisationOptions::min_imu_coverage, 0.8, within(0.0, 1.0), "",
          "Smallest duration of an IMU's samples, in units of a camera's, without a note."},
    Field{"turning_camera_ratio", &InitialisationOptions::turning_camera_ratio, 5.0, within(1.0, 1000.0), "",
          "Smallest ratio of a camera's angular rate to that of an IMU that is at rest meanwhile."},
    Field{"heavy_saturation_share", &InitialisationOptions::heavy_saturation_share, 0.2, within(0.0, 1.0), "",
          "Share of samples at a limit from which saturation explains all symptoms."},
    Field{
        "same_motion_correlation", &InitialisationOptions::same_motion_correlation, 0.4, within(0.0, 1.0), "",
        "Correlation of rates from which a saturated gyroscope is of the same recording; others are near 0."},
    Field{"ambiguous_pose_ratio", &InitialisationOptions::ambiguous_pose_ratio, 2.0, within(1.0, 100.0), "",
          "Largest ratio of errors up to which a plane's other pose is considered."},
    Field{"ambiguous_pose_px", &InitialisationOptions::ambiguous_pose_px, 0.02, within(0.0, 10.0), "px",
          "Error added to the bound of ambiguous_pose_ratio."},
    Field{"fastest_view_ratio", &InitialisationOptions::fastest_view_ratio, 1.3, within(1.0, 100.0), "",
          "Largest ratio of a view's rotation rate to the gyroscope's maximum in the search of the time "
          "offset."},
    Field{"max_time_offsets", &InitialisationOptions::max_time_offsets, 6, within(1, 100), "",
          "Largest number of tested correlation peaks."},
    Field{"time_offset_reach_s", &InitialisationOptions::time_offset_reach_s, 0.1, within(0.001, 10.0), "s",
          "Largest distance of the time offset from a correlation peak."},
    Field{"better_alignment", &InitialisationOptions::better_alignment, 0.8, within(0.01, 1.0), "",
          "Largest ratio of misfits at which a less significant peak is preferred."},
    Field{"agreement_window_s", &InitialisationOptions::agreement_window_s, 3.0, within(0.1, 60.0), "s",
          "Time before and after a view in which other views vote on its rotation."},
    Field{"min_agreement", &InitialisationOptions::min_agreement, 0.3, within(0.0, 1.0), "",
          "Smallest share of the views nearby in time that must agree with a used view on its rotation."},
    Field{"outlier_sigma", &InitialisationOptions::outlier_sigma, 5.0, within(0.5, 1000.0), "sigma",
          "Error at which positions and accelerations have half their weight."}};
constexpr auto kInitialisationDefaults = defaultsOf<InitialisationOptions, kInitialisationFields>();

}  // namespace

InitialisationOptions::InitialisationOptions() : InitialisationOptions(kInitialisationDefaults) {}

const OptionTable<InitialisationOptions>& InitialisationOptions::table() {
  static const OptionTable<InitialisationOptions> table(
      kInitialisationFields, Ordered{&InitialisationOptions::pair_gap_s, &InitialisationOptions::max_pair_s},
      Ordered{&InitialisationOptions::min_acceleration_m_s2, &InitialisationOptions::max_acceleration_m_s2},
      Ordered{&InitialisationOptions::min_rotation_rate_rad_s,
              &InitialisationOptions::max_rotation_rate_rad_s});
  return table;
}

}  // namespace evical
