#include "app/bash_completion.h"

#include "app/option_value.h"
#include "core/pipeline/session/calibration_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <string_view>

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

}  // namespace evical
