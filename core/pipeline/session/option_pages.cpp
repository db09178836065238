#include "core/pipeline/session/option_pages.h"

#include "core/base/nearest_name.h"
#include "core/pipeline/session/calibration_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace evical {
namespace {

std::string rangeText(const OptionRow& row) {
  if (!row.choices.empty()) return joined(row.choices);
  return fmt::format("{} to {}{}{}", row.minimum, row.maximum, row.unit.empty() ? "" : " ", row.unit);
}

std::vector<OptionRow> rowsOf(std::vector<OptionRow> rows, Level level) {
  std::erase_if(rows, [&](const OptionRow& row) { return row.level != level; });
  return rows;
}

std::string markdownTable(Level level) {
  std::string text = "\n| option | default | range | meaning |\n|---|---|---|---|\n";
  for (const OptionRow& row : rowsOf(optionRows(), level))
    text += fmt::format("| `{}` | {} | {} | {} |\n", row.name, row.default_value, rangeText(row), row.help);
  return text;
}

// "optimisation.solver" as headings of nested maps, without those that the previous group has already
// written.
std::string yamlHeading(const OptionSection& section, const std::string& before) {
  const std::size_t dot = section.name.find('.');
  if (dot == std::string::npos) return fmt::format("  {}:  # {}\n", section.name, section.help);
  const std::string whole = section.name.substr(0, dot);
  std::string text = before.starts_with(whole + ".") ? "" : fmt::format("  {}:\n", whole);
  return text + fmt::format("    {}:  # {}\n", section.name.substr(dot + 1), section.help);
}

}  // namespace

std::string optionText(Level least) {
  std::string text;
  for (const auto& [level, title] :
       {std::pair{Level::Public, ""}, std::pair{Level::Expert, "\nExpert options:\n\n"},
        std::pair{Level::Tuning, "\nTuning options:\n\n"}}) {
    if (level < least) break;
    text += title;
    for (const OptionRow& row : rowsOf(optionRows(), level))
      text += fmt::format("{:<50} {:<12} {}\n    {}\n", row.name, row.value, rangeText(row), row.help);
  }
  if (least == Level::Public)
    text += fmt::format("\n{} more for experts: evical options --all\n",
                        rowsOf(optionRows(), Level::Expert).size());
  return text;
}

std::string optionMarkdown() {
  return "# Options\n\nSet them in a session file under `options`, or with `--set group.option=value`. The "
         "middle part of a name with three parts can be omitted: `optimisation.threads` is "
         "`optimisation.solver.threads`. This page is the output of `evical options --markdown`.\n\n"
         "Most users change only these: the needed accuracy (`optimisation.verdict.needed_rotation_deg`, "
         "`optimisation.verdict.needed_translation_mm`, `optimisation.verdict.needed_time_offset_ms`), "
         "`optimisation.model.camera_intrinsics`, `frames.rate_hz` and "
         "`initialisation.time_offset_search_s`. "
         "The accuracy of the board is not an option: it is `measured` or `spacing_std` of the board.\n\n"
         "## Common options\n" +
         markdownTable(Level::Public) + "\n## Expert options\n" + markdownTable(Level::Expert);
}

std::string optionYaml() {
  std::string text =
      "# Options with their defaults: the output of `evical options --yaml`. A session file needs only those "
      "that\n# differ, under `options`, in this form or as `group.option: value`.\noptions:\n";
  std::string before;
  for (OptionSection& section : optionSections()) {
    std::erase_if(section.rows, [](const OptionRow& row) { return row.level == Level::Tuning; });
    if (section.rows.empty()) continue;
    text += yamlHeading(section, before);
    before = section.name;
    const std::size_t depth = static_cast<std::size_t>(std::ranges::count(section.name, '.'));
    const std::string indent(4 + 2 * depth, ' ');
    for (const OptionRow& row : section.rows)
      text += fmt::format("{}{}: {}  # {}; {}\n", indent, row.name.substr(section.name.size() + 1), row.value,
                          rangeText(row), row.help);
  }
  return text;
}

}  // namespace evical
