#include "core/optimisation/verdict_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kVerdictFields{
    Field{"correlation_time_s", &VerdictOptions::correlation_time_s, 0.2, within(0.001, 10.0), "s",
          "Residuals nearer in time than this may be correlated; the reported sigmas allow for it."},
    Field{"pixel_error_px", &VerdictOptions::pixel_error_px, 0.1, within(0.0, 10.0), "px",
          "Error of edges that repeats at the same pixel, so that motion over few pixels shows a wrong "
          "amplitude: part of the sigmas.",
          Level::Expert, Applies::WithImu},
    Field{"pixel_delay_ms", &VerdictOptions::pixel_delay_ms, 0.03, within(0.0, 100.0), "ms",
          "How well it is known by how much pixels delay events, which light and speed change: part of the "
          "sigmas "
          "of event cameras' time offsets against frames and IMUs.",
          Level::Expert, Applies::WithEvents},
    Field{"slow_pixels_ms", &VerdictOptions::slow_pixels_ms, 0.6, within(0.0, 100.0), "ms",
          "Brightening and darkening edges may be told of with so different delays; beyond, pixels are "
          "called slow, "
          "and a quarter of what is more is part of the sigmas of time offsets."},
    Field{"contradiction_sigmas", &VerdictOptions::contradiction_sigmas, 4.0, within(1.0, 1000.0), "sigma",
          "Known values that lie further than this from what the recording alone says are told of."},
    Field{"doubtful_contradiction_sigmas", &VerdictOptions::doubtful_contradiction_sigmas, 8.0,
          within(1.0, 1000.0), "sigma",
          "Weighed priors that lie further than this from what the recording alone says make the result "
          "doubtful.",
          Level::Expert},
    Field{"turned_gyroscope_sigmas", &VerdictOptions::turned_gyroscope_sigmas, 4.5, within(1.0, 1000.0),
          "sigma",
          "A gyroscope's turn that is not estimated is told of beyond this and needed_rotation_deg."},
    Field{"wrong_lens_px", &VerdictOptions::wrong_lens_px, 0.2, within(0.0, 1000.0), "px",
          "A lens that is not estimated, but certainly projects elsewhere by more (RMS over the image), "
          "makes the result doubtful.",
          Level::Expert},
    Field{"wrong_lens_sigmas", &VerdictOptions::wrong_lens_sigmas, 6.0, within(1.0, 1000.0), "sigma",
          "How certain that must be."},
    Field{"other_sensor_sigmas", &VerdictOptions::other_sensor_sigmas, 4.5, within(1.0, 1000.0), "sigma",
          "Cameras with same_sensor_as whose poses or lenses differ by more than this and what is needed, or "
          "wrong_lens_px, make the result doubtful."},
    Field{"rolling_shutter_ms", &VerdictOptions::rolling_shutter_ms, 1.5, within(0.0, 1000.0), "ms",
          "A shutter that the session calls global, but that certainly takes longer from the first row's "
          "exposure to the last one's, makes the result doubtful: no sensor that rolls reads a frame faster.",
          Level::Expert, Applies::WithFrames},
    Field{"rolling_shutter_sigmas", &VerdictOptions::rolling_shutter_sigmas, 6.0, within(1.0, 1000.0),
          "sigma", "How certain that must be."},
    Field{"bent_board_mm", &VerdictOptions::bent_board_mm, 0.3, within(0.0, 1000.0), "mm",
          "A board that is taken for flat, but whose middle certainly stands out by more over its length, "
          "makes the result doubtful.",
          Level::Expert},
    Field{"bent_board_sigmas", &VerdictOptions::bent_board_sigmas, 6.0, within(1.0, 1000.0), "sigma",
          "How certain that must be."},
    Field{"doubtful_scale_sigmas", &VerdictOptions::doubtful_scale_sigmas, 3.0, within(1.0, 1000.0), "sigma",
          "A board, or a gravity, that lies further from what was given than this makes the result doubtful.",
          Level::Expert},
    Field{"doubtful_circle_misfit", &VerdictOptions::doubtful_circle_misfit, 2.5, within(1.0, 1000.0), "",
          "Circles that lie more times as far off as the front end says, by their median, make the result "
          "doubtful.",
          Level::Expert},
    Field{"failed_circle_misfit", &VerdictOptions::failed_circle_misfit, 25.0, within(1.0, 10000.0), "",
          "Beyond this there is no result.", Level::Expert},
    Field{"doubtful_imu_misfit", &VerdictOptions::doubtful_imu_misfit, 5.0, within(1.0, 1000.0), "",
          "Rates or accelerations that are more times as far off as their noise density says make the result "
          "doubtful.",
          Level::Expert, Applies::WithImu},
    Field{"failed_imu_misfit", &VerdictOptions::failed_imu_misfit, 200.0, within(1.0, 10000.0), "",
          "Beyond this there is no result.", Level::Expert, Applies::WithImu},
    Field{"doubtful_outliers", &VerdictOptions::doubtful_outliers, 0.25, within(0.0, 1.0), "",
          "Share of circles that are left out as contradicting beyond which the result is doubtful.",
          Level::Expert},
    Field{"failed_outliers", &VerdictOptions::failed_outliers, 0.6, within(0.0, 1.0), "",
          "Beyond this there is no result.", Level::Expert},
    Field{"saturated_share", &VerdictOptions::saturated_share, 0.01, within(0.0, 1.0), "",
          "An IMU that was at a limit for more of its samples is the first reason of a doubtful result.",
          Level::Expert, Applies::WithImu},
    Field{"doubtful_halves_sigmas", &VerdictOptions::doubtful_halves_sigmas, 3.0, within(0.5, 1000.0),
          "sigma", "Halves of the recording that differ by more (RMS) make the result doubtful.",
          Level::Expert},
    Field{"changed_sigmas", &VerdictOptions::changed_sigmas, 8.0, within(1.0, 1000.0), "sigma",
          "A camera that seems to have moved on its mount, or a clock or biases that seem to step, by more "
          "than this and "
          "what is needed make the result doubtful.",
          Level::Expert},
    Switch{"judge_sigmas", &VerdictOptions::judge_sigmas, true,
           "A result that is less certain than what is needed is doubtful for that; false: only for what is "
           "wrong with "
           "the data.",
           Level::Public},
    Field{"needed_rotation_deg", &VerdictOptions::needed_rotation_deg, 0.1, within(1e-4, 90.0), "deg",
          "Rotations less certain than this make the result doubtful.", Level::Public},
    Field{"needed_translation_mm", &VerdictOptions::needed_translation_mm, 1.0, within(1e-3, 1e4), "mm",
          "Translations less certain than this, were the board known exactly, make the result doubtful.",
          Level::Public},
    Field{"needed_scale_mm", &VerdictOptions::needed_scale_mm, 3.0, within(1e-3, 1e4), "mm",
          "Translations that the board's measure leaves less certain than this make the result doubtful.",
          Level::Public},
    Field{"needed_time_offset_ms", &VerdictOptions::needed_time_offset_ms, 0.1, within(1e-4, 1e4), "ms",
          "Time offsets less certain than this make the result doubtful.", Level::Public}};
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
