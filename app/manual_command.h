// Bash completion of commands, options and choices, generated from the command definitions.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace evical {

std::string bashCompletion(const CLI::App& program, const std::vector<const CLI::App*>& commands);

}  // namespace evical

// Value of a command line option in readable form.

namespace CLI {
class Option;
}

namespace evical {

struct OptionValue {
  std::string word;   // "INT", "TEXT", "dark|bright"
  std::string range;  // "1 to 256"; empty without a range
  std::vector<std::string> choices;
};
OptionValue valueOf(const CLI::Option& option);

}  // namespace evical
