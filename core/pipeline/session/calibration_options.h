// All options of a calibration, by group: what session files, --set, `evical options` and forms reach.
#pragma once

#include "core/base/option_row.h"
#include "core/base/shared_options.h"

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

// Groups by pointer: only sources that read a group include its header, and are rebuilt if it changes.
struct CalibrationOptions {
  SharedOptions<FrontEndOptions> front_end;
  SharedOptions<FrameOptions> frames;
  SharedOptions<BlinkOptions> blink;
  SharedOptions<IntrinsicsOptions> intrinsics;
  SharedOptions<InitialisationOptions> initialisation;
  SharedOptions<OptimisationOptions> optimisation;
  SharedOptions<ReportOptions> report;
  // Of other commands:
  SharedOptions<CheckOptions> check;
  SharedOptions<EdgeSlopeOptions> edge_slopes;
  SharedOptions<EgomotionOptions> egomotion;
  SharedOptions<MaintenanceOptions> maintain;

  CalibrationOptions();  // the defaults
  bool operator==(const CalibrationOptions&) const;
};

// One group: its name, what it is about, and its options with their full names.
struct OptionSection {
  std::string name, help;
  std::vector<OptionRow> rows;
};
std::vector<OptionSection> optionSections(const CalibrationOptions& options = {});

// By full name, "group.option" or "tuning.group.option". Where a group is part of a larger one, its own name may be left
// out: "optimisation.threads" is "optimisation.solver.threads". Throws CalibrationError (BadInput) that names the
// option, the value, and the bound or the nearest known name.
void setOption(CalibrationOptions& options, std::string_view full_name, std::string_view value);

// Once all are set: throws OptionConflict that names two options of which one excludes the other's value.
void validate(const CalibrationOptions& options);

// With full names, in the order of the groups: all options, those that people are told of (not those of tuning), and
// those that aren't at their default.
std::vector<OptionRow> optionRows(const CalibrationOptions& options = {});
std::vector<OptionRow> documentedOptions(const CalibrationOptions& options = {});
std::vector<OptionRow> differingOptions(const CalibrationOptions& options);

}  // namespace evical
