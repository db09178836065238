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
