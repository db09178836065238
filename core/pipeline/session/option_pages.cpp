#include "core/pipeline/session/option_pages.h"

#include "core/base/nearest_name.h"
#include "core/pipeline/session/calibration_options.h"

#include <fmt/format.h>

#include <algorithm>

namespace evical {
namespace {

std::string rangeText(const OptionRow& row) {
  if (!row.choices.empty()) return joined(row.choices);
  return fmt::format("{} to {}{}{}", row.minimum, row.maximum, row.unit.empty() ? "" : " ", row.unit);
}

std::vector<OptionRow> rowsOf(const std::vector<OptionRow>& rows, bool expert) {
  std::vector<OptionRow> some = rows;
  std::erase_if(some, [&](const OptionRow& row) { return row.expert != expert; });
  return some;
}

std::string markdownTable(const std::vector<OptionRow>& rows) {
  std::string text = "\n| option | default | range | what it does |\n|---|---|---|---|\n";
  for (const OptionRow& row : rows)
    text += fmt::format("| `{}` | {} | {} | {} |\n", row.name, row.default_value, rangeText(row), row.help);
  return text;
}

// "optimisation.solver" as headings of nested maps, of which those of the group before are there already.
std::string yamlHeading(const OptionSection& section, const std::string& before) {
  const std::size_t dot = section.name.find('.');
  if (dot == std::string::npos) return fmt::format("  {}:  # {}\n", section.name, section.help);
  const std::string whole = section.name.substr(0, dot);
  std::string text = before.starts_with(whole + ".") ? "" : fmt::format("  {}:\n", whole);
  return text + fmt::format("    {}:  # {}\n", section.name.substr(dot + 1), section.help);
}

}  // namespace

std::string optionText(bool with_expert) {
  const std::vector<OptionRow> all = optionRows(), common = rowsOf(all, false), expert = rowsOf(all, true);
  std::string text;
  const auto add = [&](const std::vector<OptionRow>& rows) {
    for (const OptionRow& row : rows)
      text += fmt::format("{:<50} {:<12} {}\n    {}\n", row.name, row.value, rangeText(row), row.help);
  };
  add(common);
  if (with_expert) {
    text += "\nFor those who know the method:\n\n";
    add(expert);
  } else {
    text += fmt::format("\n{} more, for those who know the method: evical options --all\n", expert.size());
  }
  return text;
}

std::string optionMarkdown() {
  std::string text =
      "# Options\n\nSet them in a session file under `options`, or with `--set group.option=value`. The last "
      "but one part of a name may be left out where three are: `optimisation.threads` is "
      "`optimisation.solver.threads`. This page is the output of `evical options --markdown`.\n\n"
      "## What people turn\n";
  text += markdownTable(rowsOf(optionRows(), false));
  text += "\n## For those who know the method\n";
  for (const OptionSection& section : optionSections())
    if (const auto rows = rowsOf(section.rows, true); !rows.empty())
      text += fmt::format("\n### {}\n\n{}.\n", section.name, section.help) + markdownTable(rows);
  return text;
}

std::string optionYaml() {
  std::string text =
      "# Every option with its default: the output of `evical options --yaml`. A session file needs only "
      "those that\n# differ, under `options`, in this form or as `group.option: value`.\noptions:\n";
  std::string before;
  for (const OptionSection& section : optionSections()) {
    text += yamlHeading(section, before);
    before = section.name;
    const std::size_t depth = static_cast<std::size_t>(std::ranges::count(section.name, '.'));
    const std::string indent(4 + 2 * depth, ' ');
    for (const bool expert : {false, true})
      for (const OptionRow& row : rowsOf(section.rows, expert))
        text += fmt::format("{}{}: {}  # {}; {}\n", indent, row.name.substr(section.name.size() + 1),
                            row.value, rangeText(row), row.help);
  }
  return text;
}

}  // namespace evical
