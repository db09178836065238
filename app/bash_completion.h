// Completion of commands, options and their words in bash, made from the commands themselves.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace evical {

std::string bashCompletion(const CLI::App& program, const std::vector<const CLI::App*>& commands);

}  // namespace evical
