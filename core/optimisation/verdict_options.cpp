#include "core/optimisation/verdict_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

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
        "largest_scale_share", &VerdictOptions::largest_scale_share, 0.8, within(0.0, 1.0), "",
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
