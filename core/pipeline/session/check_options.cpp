#include "core/pipeline/session/check_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kCheckFields{
    Field{"stability_rotation_deg", &CheckOptions::stability_rotation_deg, 0.02, within(0.0, 90.0), "deg",
          "Rotation changes up to this size are not reported as a change.", Level::Public},
    Field{"stability_translation_mm", &CheckOptions::stability_translation_mm, 0.3, within(0.0, 1e4), "mm",
          "Translation changes up to this size are not reported as a change.", Level::Public},
    Field{"stability_time_offset_ms", &CheckOptions::stability_time_offset_ms, 0.05, within(0.0, 1e4), "ms",
          "Changes of time offsets and accelerometer delays up to this size are not reported; includes the "
          "effect of light on pixel delays.",
          Level::Public},
    Field{"stability_lens_px", &CheckOptions::stability_lens_px, 0.1, within(0.0, 1000.0), "px",
          "Lens changes up to this size, RMS over the image, are not reported as a change.", Level::Public},
    Field{"stability_imu_scale", &CheckOptions::stability_imu_scale, 0.001, within(0.0, 1.0), "",
          "Changes of IMU scale factors and misalignments up to this size are not reported; they change with "
          "temperature.",
          Level::Public},
    Field{"matters_rotation_deg", &CheckOptions::matters_rotation_deg, 0.25, within(1e-4, 90.0), "deg",
          "Required detectability: the verdict is unchanged only if a rotation change of this size would "
          "have been detected.",
          Level::Expert},
    Field{"matters_translation_mm", &CheckOptions::matters_translation_mm, 6.0, within(1e-3, 1e4), "mm",
          "Required detectability of translation changes.", Level::Expert},
    Field{"matters_time_offset_ms", &CheckOptions::matters_time_offset_ms, 0.5, within(1e-4, 1e4), "ms",
          "Required detectability of time offset changes.", Level::Expert},
    Field{"matters_lens_px", &CheckOptions::matters_lens_px, 1.0, within(1e-3, 1000.0), "px",
          "Required detectability of lens changes, RMS over the image.", Level::Expert},
    Field{"false_alarms", &CheckOptions::false_alarms, 0.01, within(1e-9, 0.5), "",
          "Probability that an unchanged calibration is reported as changed, over all quantities together.",
          Level::Expert},
    Switch{"no_board", &CheckOptions::no_board, false,
           "Check without a board: only rotations and time offsets of event cameras are checked.",
           Level::Public},
    Field{"without_board_rotation_deg", &CheckOptions::without_board_rotation_deg, 1.5, within(1e-4, 90.0),
          "deg", "Required detectability of rotation changes in a check without a board.", Level::Expert,
          Applies::InCheckWithoutBoard},
    Field{"without_board_time_offset_ms", &CheckOptions::without_board_time_offset_ms, 3.0, within(1e-4, 1e4),
          "ms", "Required detectability of time offset changes in a check without a board.", Level::Expert,
          Applies::InCheckWithoutBoard},
    Field{"without_board_least_rotation_deg", &CheckOptions::without_board_least_rotation_deg, 0.2,
          within(0.0, 90.0), "deg",
          "Smallest rotation change that a check without a board reports: scenes and motion cause such "
          "errors."},
    Field{"without_board_least_time_offset_ms", &CheckOptions::without_board_least_time_offset_ms, 0.5,
          within(0.0, 1e4), "ms", "Smallest time offset change that a check without a board reports."},
    Field{"without_board_misfit", &CheckOptions::without_board_misfit, 0.5, within(0.01, 10.0), "",
          "Largest residual share of the angular rates without a board; above it, camera and IMU are not on "
          "one rig."},
    Field{"without_board_scale", &CheckOptions::without_board_scale, 0.1, within(0.001, 10.0), "",
          "Largest relative error of rotations without a board; above it, the lens is another one."},
    Field{"least_board_share", &CheckOptions::least_board_share, 0.02, within(0.0, 1.0), "",
          "Smallest share of event windows with the board; below it, the check does not use the board."},
    Field{"copy_sigmas", &CheckOptions::copy_sigmas, 0.2, within(0.0, 1.0), "sigma",
          "Largest change in a copy of the old recording; one of 6 s gave 0.07."}};
constexpr auto kCheckDefaults = defaultsOf<CheckOptions, kCheckFields>();

}  // namespace

CheckOptions::CheckOptions() : CheckOptions(kCheckDefaults) {}

const OptionTable<CheckOptions>& CheckOptions::table() {
  static const OptionTable<CheckOptions> table(kCheckFields);
  return table;
}

}  // namespace evical
