// All options of a calibration by group, for session files, --set, `evical options` and forms.
#pragma once

#include "core/base/option_row.h"
#include "core/base/option_table.h"

#include <string>
#include <string_view>
#include <vector>

namespace evical {

struct BlinkOptions;
struct CheckOptions;
struct EdgeSlopeOptions;
struct EgomotionOptions;
struct FrameOptions;
struct FrontEndOptions;
struct InitialisationOptions;
struct IntrinsicsOptions;
struct MaintenanceOptions;
struct OptimisationOptions;
struct ReportOptions;
struct StampOptions;

// Groups are shared pointers: only sources that use a group include its header and are rebuilt if it changes.
struct CalibrationOptions {
  SharedOptions<StampOptions> stamps;
  SharedOptions<FrontEndOptions> front_end;
  SharedOptions<FrameOptions> frames;
  SharedOptions<BlinkOptions> blink;
  SharedOptions<IntrinsicsOptions> intrinsics;
  SharedOptions<InitialisationOptions> initialisation;
  SharedOptions<OptimisationOptions> optimisation;
  SharedOptions<ReportOptions> report;
  // For other commands:
  SharedOptions<CheckOptions> check;
  SharedOptions<EdgeSlopeOptions> edge_slopes;
  SharedOptions<EgomotionOptions> egomotion;
  SharedOptions<MaintenanceOptions> maintain;

  CalibrationOptions();  // the defaults
  bool operator==(const CalibrationOptions&) const;
};

// One group: name, description, and options with full names.
struct OptionSection {
  std::string name, help;
  std::vector<OptionRow> rows;
};
std::vector<OptionSection> optionSections(const CalibrationOptions& options = {});

// Sets an option by its full name, "group.option" or "tuning.group.option". The name of a subgroup can be
// omitted: "optimisation.threads" is "optimisation.solver.threads". Throws CalibrationError (BadInput) with
// the option, the value, and the bound or the nearest known name.
void setOption(CalibrationOptions& options, std::string_view full_name, std::string_view value);

// Final check of all options: throws OptionConflict with the names of two incompatible options.
void validate(const CalibrationOptions& options);

// Options with full names, in the order of the groups: all, the documented ones (without tuning), and those
// that differ from the default.
std::vector<OptionRow> optionRows(const CalibrationOptions& options = {});
std::vector<OptionRow> documentedOptions(const CalibrationOptions& options = {});
std::vector<OptionRow> differingOptions(const CalibrationOptions& options);

// Criteria for a changed calibration.
struct CheckOptions {
  double stability_rotation_deg;
  double stability_translation_mm;
  double stability_time_offset_ms;
  double stability_lens_px;
  double stability_imu_scale;
  double matters_rotation_deg;
  double matters_translation_mm;
  double matters_time_offset_ms;
  double matters_lens_px;
  double false_alarms;
  bool no_board;
  double without_board_rotation_deg;
  double without_board_time_offset_ms;
  double without_board_min_rotation_deg;
  double without_board_min_time_offset_ms;
  double without_board_misfit;
  double without_board_scale;
  double min_board_share;
  double copy_sigmas;

  CheckOptions();  // the defaults
  constexpr explicit CheckOptions(NoDefaults) {}
  bool operator==(const CheckOptions&) const = default;
  static const OptionTable<CheckOptions>& table();
};

}  // namespace evical
