#include "core/pipeline/session/check_options.h"

#include "core/base/option_table.h"

namespace evical {
namespace {

constexpr std::tuple kCheckFields{
    Field{"stability_rotation_deg", &CheckOptions::stability_rotation_deg, 0.02, within(0.0, 90.0), "deg",
          "Rotations may change by this without anything having changed.", Level::Public},
    Field{"stability_translation_mm", &CheckOptions::stability_translation_mm, 0.3, within(0.0, 1e4), "mm",
          "The same of translations.", Level::Public},
    Field{"stability_time_offset_ms", &CheckOptions::stability_time_offset_ms, 0.05, within(0.0, 1e4), "ms",
          "The same of time offsets, and of accelerometers' delays; what other light does to pixels' delays "
          "is part of it.",
          Level::Public},
    Field{"stability_lens_px", &CheckOptions::stability_lens_px, 0.1, within(0.0, 1000.0), "px",
          "The same of lenses: RMS over the image.", Level::Public},
    Field{"stability_imu_scale", &CheckOptions::stability_imu_scale, 0.001, within(0.0, 1.0), "",
          "The same of IMUs' scale factors and misalignments, which change with temperature.", Level::Public},
    Field{"matters_rotation_deg", &CheckOptions::matters_rotation_deg, 0.25, within(1e-4, 90.0), "deg",
          "A calibration is called unchanged only by a recording that would have shown a change of this "
          "size.",
          Level::Expert},
    Field{"matters_translation_mm", &CheckOptions::matters_translation_mm, 6.0, within(1e-3, 1e4), "mm",
          "The same of translations.", Level::Expert},
    Field{"matters_time_offset_ms", &CheckOptions::matters_time_offset_ms, 0.5, within(1e-4, 1e4), "ms",
          "The same of time offsets.", Level::Expert},
    Field{"matters_lens_px", &CheckOptions::matters_lens_px, 1.0, within(1e-3, 1000.0), "px",
          "The same of lenses: RMS over the image.", Level::Expert},
    Field{"false_alarms", &CheckOptions::false_alarms, 0.01, within(1e-9, 0.5), "",
          "How often a calibration that has not changed may be called changed, over all quantities together.",
          Level::Expert},
    Switch{"no_board", &CheckOptions::no_board, false,
           "The recording shows no board: it is not looked for, and rotations and time offsets alone are "
           "checked.",
           Level::Public},
    Field{"without_board_rotation_deg", &CheckOptions::without_board_rotation_deg, 1.5, within(1e-4, 90.0),
          "deg", "Without a board: as matters_rotation_deg.", Level::Expert, Applies::InCheckWithoutBoard},
    Field{"without_board_time_offset_ms", &CheckOptions::without_board_time_offset_ms, 3.0, within(1e-4, 1e4),
          "ms", "Without a board: as matters_time_offset_ms.", Level::Expert, Applies::InCheckWithoutBoard},
    Field{"without_board_least_rotation_deg", &CheckOptions::without_board_least_rotation_deg, 0.2,
          within(0.0, 90.0), "deg",
          "Without a board: a smaller change is none; scenes and walks move rotations by so much, rarely and "
          "whatever their sigmas."},
    Field{"without_board_least_time_offset_ms", &CheckOptions::without_board_least_time_offset_ms, 0.5,
          within(0.0, 1e4), "ms", "The same of time offsets."},
    Field{"without_board_misfit", &CheckOptions::without_board_misfit, 0.5, within(0.01, 10.0), "",
          "Without a board: where more of the rates is left unexplained, camera and IMU are not on one rig."},
    Field{"without_board_scale", &CheckOptions::without_board_scale, 0.1, within(0.001, 10.0), "",
          "Without a board: where the camera turns by more than this too fast or too slowly, the lens is "
          "another one."},
    Field{"least_board_share", &CheckOptions::least_board_share, 0.02, within(0.0, 1.0), "",
          "A recording in which fewer of the windows show the board is taken as one without a board."}};
constexpr auto kCheckDefaults = defaultsOf<CheckOptions, kCheckFields>();

}  // namespace

CheckOptions::CheckOptions() : CheckOptions(kCheckDefaults) {}

const OptionTable<CheckOptions>& CheckOptions::table() {
  static const OptionTable<CheckOptions> table(kCheckFields);
  return table;
}

}  // namespace evical
