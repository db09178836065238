// The manual: pages for the program and each command, and bash completion, generated from the definitions of
// --help. For the build only, so help does not list it.
#include "app/bash_completion.h"
#include "app/command_line.h"
#include "app/commands.h"
#include "app/manual_page.h"
#include "app/option_value.h"
#include "app/version.h"
#include "core/base/atomic_file.h"
#include "core/base/file_places.h"
#include "core/pipeline/session/calibration_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace evical {
namespace {

ManualEntry entryOf(const CLI::Option& option) {
  ManualEntry entry{option.get_name(true, true), "", sentence(option.get_description())};
  if (option.get_type_size() == 0) return entry;
  const OptionValue value = valueOf(option);
  entry.value = option.get_positional() ? "" : value.word;
  if (!value.range.empty()) entry.text += " " + value.range + ".";
  if (!option.get_default_str().empty()) entry.text += " Default: " + option.get_default_str() + ".";
  if (!option.get_positional() && option.get_required()) entry.text += " Required.";
  return entry;
}

std::vector<ManualEntry> entriesOf(const CLI::App& app, bool positional) {
  std::vector<ManualEntry> entries;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty() && option->get_positional() == positional)
      entries.push_back(entryOf(*option));
  return entries;
}

std::string synopsisOf(const std::string& program, const CLI::App& app) {
  std::string text = program, arguments;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    if (option->get_positional()) {
      const bool many = option->get_expected_max() >= CLI::detail::expected_max_vector_size;
      const std::string name = option->get_name(true) + (many ? "..." : "");
      arguments += option->get_required() ? " " + name : " [" + name + "]";
    } else if (option->get_required()) {
      text += fmt::format(" {} {}", option->get_name(), valueOf(*option).word);
    }
  }
  return text + " [OPTIONS]" + arguments;
}

// Options of a calibration, in the order of `evical options --all`.
ManualSection calibrationOptions() {
  ManualSection section{"Options of a calibration", "For --set and for the part options of a session.", {}};
  for (const OptionRow& row : documentedOptions()) {
    const std::string range =
        row.choices.empty() ? "" : fmt::format(" One of {}.", fmt::join(row.choices, ", "));
    section.entries.push_back({row.name, row.default_value, sentence(row.help) + range});
  }
  return section;
}

ManualPage commandPage(const CLI::App& command) {
  ManualPage page{"evical-" + command.get_name(),
                  command.get_description(),
                  synopsisOf("evical " + command.get_name(), command),
                  {},
                  {"evical"}};
  const std::vector<ManualEntry> arguments = entriesOf(command, true);
  if (!arguments.empty()) page.sections.push_back({"Arguments", "", arguments});
  page.sections.push_back({"Options", "", entriesOf(command, false)});
  if (command.get_name() == "options") page.sections.push_back(calibrationOptions());
  if (!command.get_footer().empty()) page.sections.push_back({"Notes", command.get_footer(), {}});
  return page;
}

ManualPage programPage(const CLI::App& program, const std::vector<const CLI::App*>& commands) {
  ManualPage page{"evical",
                  program.get_description(),
                  "evical COMMAND [OPTIONS]",
                  {{"Options", "", entriesOf(program, false)}, {"Commands", "", {}}},
                  {}};
  for (const CLI::App* command : commands) {
    page.sections.back().entries.push_back({command->get_name(), "", sentence(command->get_description())});
    page.see_also.push_back("evical-" + command->get_name());
  }
  page.sections.push_back({"Exit status", program.get_footer(), {}});
  return page;
}

std::vector<const CLI::App*> visibleCommands(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::vector<FileContent> manual(const CLI::App& program) {
  const std::vector<const CLI::App*> commands = visibleCommands(program);
  std::vector<FileContent> files{{"man1/evical.1", manualPage(programPage(program, commands), kVersion)}};
  for (const CLI::App* command : commands)
    files.push_back(
        {fmt::format("man1/evical-{}.1", command->get_name()), manualPage(commandPage(*command), kVersion)});
  files.push_back({"completions/evical", bashCompletion(program, commands)});
  return files;
}

}  // namespace

void addManualCommand(Command& app, int& exit_code) {
  const auto folder = std::make_shared<std::filesystem::path>();
  Command command = app.command("manual", "Manual pages and bash completion");
  command.hide();
  command.option("-o,--output", *folder, "Folder to write").required();
  command.action([app, folder, &exit_code] {
    std::vector<FileContent> files = manual(app.app());
    for (FileContent& file : files) {
      file.path = *folder / file.path;
      makeOutputFolder(file.path.parent_path());
    }
    writeFilesWhole(files);
    exit_code = kDone;
  });
}

}  // namespace evical
