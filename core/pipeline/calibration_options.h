// All options of a calibration, by group: what session files, --set, `evical options` and forms reach.
#pragma once

#include "core/base/option_yaml.h"
#include "core/frontend/front_end_options.h"
#include "core/initialisation/initialisation_options.h"
#include "core/intrinsics/intrinsics_options.h"
#include "core/optimisation/optimisation_options.h"
#include "core/report/report_options.h"

#include <string>
#include <string_view>
#include <vector>

namespace evical {

struct CalibrationOptions {
  FrontEndOptions front_end;
  IntrinsicsOptions intrinsics;
  InitialisationOptions initialisation;
  OptimisationOptions optimisation;
  ReportOptions report;
  bool operator==(const CalibrationOptions&) const = default;
};

std::vector<std::string> optionGroups();

// By full name, "group.option"; throws CalibrationError (BadInput) that names the option, the value, and the
// bound or the nearest known name.
void setOption(CalibrationOptions& options, std::string_view full_name, std::string_view value);

// With full names, in the order of the groups: all options, and those that aren't at their default.
std::vector<OptionRow> optionRows(const CalibrationOptions& options = {});
std::vector<OptionRow> differingOptions(const CalibrationOptions& options);

// Terminal text, docs/options.md, and config/default.yaml: the part `options` of a session with every
// default.
std::string optionText(const CalibrationOptions& options = {});
std::string optionMarkdown();
std::string optionYaml();

}  // namespace evical
