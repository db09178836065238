// The manual: pages for the program and each command, and bash completion, generated from the definitions of
// --help. For the build only, so help does not list it.
#include "app/manual_command.h"

#include "app/command_line.h"
#include "app/commands.h"
#include "app/manual_page.h"
#include "app/version.h"

#include "core/base/atomic_file.h"
#include "core/base/file_places.h"
#include "core/pipeline/session/calibration_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace evical {
namespace {

// Without a match, bash completes file names, which most options and arguments take.
constexpr std::string_view kBegin = R"(# Completion of evical in bash, made from its help.
_evical() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command= word options= words=
  for word in "${COMP_WORDS[@]:1:COMP_CWORD - 1}"; do
    [[ $word == -* ]] || { command=$word; break; }
  done
  # bash splits "--option=value" into three words.
  [[ $current != = ]] || current=
  if [[ $before == = && $COMP_CWORD -gt 1 ]]; then before=${COMP_WORDS[COMP_CWORD - 2]}; fi
  case $command in
)";

constexpr std::string_view kEnd = R"(  esac
  COMPREPLY=()
  if [[ -n $words ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  elif [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  fi
  if [[ ${COMPREPLY[*]} == *= ]]; then compopt -o nospace 2>/dev/null; fi
}
complete -o bashdefault -o default -F _evical evical
)";

std::vector<std::string> namesOf(const CLI::Option& option) {
  std::vector<std::string> names;
  if (option.get_group().empty()) return names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<std::string> namesOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : namesOf(*option)) names.push_back(name);
  return names;
}

std::string caseOf(const CLI::App& command) {
  std::string text =
      fmt::format("    {})\n      options=\"{}\"\n", command.get_name(), fmt::join(namesOf(command), " "));
  text += "      case $before in\n";
  for (const CLI::Option* option : command.get_options()) {
    if (option->check_lname("set"))
      text += "        --set) words=$settings ;;\n";
    else if (const OptionValue value = valueOf(*option); !value.choices.empty())
      text += fmt::format("        {}) words=\"{}\" ;;\n", fmt::join(namesOf(*option), "|"),
                          fmt::join(value.choices, " "));
  }
  return text + "      esac\n      ;;\n";
}

std::string settings() {
  std::string text = "  local settings=\"";
  for (const OptionRow& row : documentedOptions()) text += fmt::format("\n    {}=", row.name);
  return text + "\"\n";
}

}  // namespace

std::string bashCompletion(const CLI::App& program, const std::vector<const CLI::App*>& commands) {
  std::vector<std::string> first = namesOf(program);
  std::string text(kBegin);
  text.insert(text.find("  case $command"), settings());
  for (const CLI::App* command : commands) {
    first.push_back(command->get_name());
    text += caseOf(*command);
  }
  text += fmt::format("    \"\") words=\"{}\" ;;\n", fmt::join(first, " "));
  return text + std::string(kEnd);
}

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

// CLI11 combines type and checks: "TEXT:{dark,bright}", "INT:INT in [1 - 256]".
OptionValue valueOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  OptionValue value{type.substr(0, type.find(':')), "", {}};
  const std::size_t open = type.find('{'), close = type.rfind('}');
  if (open != std::string::npos && close != std::string::npos) {
    std::istringstream words(type.substr(open + 1, close - open - 1));
    for (std::string word; std::getline(words, word, ',');) value.choices.push_back(word);
    value.word = fmt::format("{}", fmt::join(value.choices, "|"));
  }
  const std::size_t begin = type.find(" in ["), middle = type.find(" - ", begin), end = type.find(']', begin);
  if (begin != std::string::npos && middle != std::string::npos && end != std::string::npos)
    value.range = fmt::format("{} to {}", type.substr(begin + 5, middle - begin - 5),
                              type.substr(middle + 3, end - middle - 3));
  return value;
}

}  // namespace evical
