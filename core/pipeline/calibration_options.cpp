#include "core/pipeline/calibration_options.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
namespace {

// The one list of groups: visit(name, help, options of the group, its table).
template <class Options, class Visitor>
void forEachGroup(Options& all, Visitor&& visit) {
  visit("detection", "The front end as a whole", all.front_end.detection, kDetectionFields);
  visit("bursts", "Edge timing: events of one edge at one pixel", all.front_end.bursts, kBurstFields);
  visit("ring_vote", "Circle candidates", all.front_end.ring_vote, kRingVoteFields);
  visit("normal_flow", "Circle candidates the published way", all.front_end.normal_flow, kNormalFlowFields);
  visit("moving_circle", "Moving circles, one by one", all.front_end.moving_circle, kMovingCircleFields);
  visit("grid", "Circles to board", all.front_end.grid, kGridFields);
  visit("tracking", "All circles of a window together, and from window to window", all.front_end.tracking,
        kTrackingFields);
  visit("extent", "Does the board have the rows and columns that the session says?", all.front_end.extent,
        kExtentFields);
  visit("intrinsics", "Camera intrinsics, where the session gives none", all.intrinsics, kIntrinsicsFields);
  visit("initialisation", "From single views to a first trajectory", all.initialisation,
        kInitialisationFields);
  visit("optimisation", "Batch optimisation and uncertainty", all.optimisation, kOptimisationFields);
  visit("report", "What is worked out for the report only", all.report, kReportFields);
}

std::vector<std::string> fullNames() {
  std::vector<std::string> names;
  for (const OptionRow& row : optionRows()) names.push_back(row.name);
  return names;
}

std::string rangeText(const OptionRow& row) {
  if (!row.choices.empty()) return joined(row.choices);
  return fmt::format("{} to {}{}{}", row.minimum, row.maximum, row.unit.empty() ? "" : " ", row.unit);
}

}  // namespace

std::vector<std::string> optionGroups() {
  std::vector<std::string> groups;
  CalibrationOptions options;
  forEachGroup(options, [&](const char* group, auto&&...) { groups.emplace_back(group); });
  return groups;
}

void setOption(CalibrationOptions& options, std::string_view full_name, std::string_view value) {
  const std::size_t dot = full_name.find('.');
  const std::string group(full_name.substr(0, dot));
  if (dot == std::string_view::npos)
    throw badInput(group, "is not the name of an option",
                   "Options are named group.option; " + nameAdvice(full_name, fullNames()));
  const std::string_view name = full_name.substr(dot + 1);
  bool found = false;
  forEachGroup(options, [&](const char* known, const char*, auto& group_options, const auto& fields) {
    if (group != known) return;
    found = true;
    setOption(group_options, fields, group, name, value);
  });
  if (!found) throw badInput(std::string(full_name), "no such option", nameAdvice(full_name, fullNames()));
}

std::vector<OptionRow> optionRows(const CalibrationOptions& options) {
  std::vector<OptionRow> rows;
  forEachGroup(options, [&](const char* group, const char*, const auto& group_options, const auto& fields) {
    for (OptionRow& row : optionRows(group_options, fields, group)) rows.push_back(std::move(row));
  });
  return rows;
}

std::vector<OptionRow> differingOptions(const CalibrationOptions& options) {
  std::vector<OptionRow> rows = optionRows(options);
  std::erase_if(rows, [](const OptionRow& row) { return row.value == row.default_value; });
  return rows;
}

std::string optionText(const CalibrationOptions& options) {
  std::string text;
  for (const OptionRow& row : optionRows(options))
    text += fmt::format("{:<44} {:<12} {}\n    {}\n", row.name, row.value, rangeText(row), row.help);
  return text;
}

std::string optionMarkdown() {
  std::string text =
      "# Options\n\nSet them in a session file under `options`, or with `--set group.option=value`. This "
      "page is the "
      "output of `evical options --markdown`.\n";
  const CalibrationOptions defaults;
  forEachGroup(defaults, [&](const char* group, const char* help, const auto& options, const auto& fields) {
    text += fmt::format("\n## {}\n\n{}.\n\n| option | default | range | what it does |\n|---|---|---|---|\n",
                        group, help);
    for (const OptionRow& row : optionRows(options, fields, group))
      text += fmt::format("| `{}` | {} | {} | {} |\n", row.name, row.default_value, rangeText(row), row.help);
  });
  return text;
}

std::string optionYaml() {
  std::string text =
      "# Every option with its default: the output of `evical options --yaml`. A session file needs only "
      "those "
      "that\n# differ, under `options`, in this form or as `group.option: value`.\noptions:\n";
  const CalibrationOptions defaults;
  forEachGroup(defaults, [&](const char* group, const char* help, const auto& options, const auto& fields) {
    text += fmt::format("  {}:  # {}\n", group, help);
    for (const OptionRow& row : optionRows(options, fields, ""))
      text += fmt::format("    {}: {}  # {}; {}\n", row.name, row.value, rangeText(row), row.help);
  });
  return text;
}

}  // namespace evical
