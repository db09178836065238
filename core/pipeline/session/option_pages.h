// All options as pages for people, from their tables.
#pragma once

#include <string>

namespace evical {

// Terminal text: what people usually turn, or all.
std::string optionText(bool with_expert);

// docs/options.md.
std::string optionMarkdown();

// config/default.yaml: the part `options` of a session with every default.
std::string optionYaml();

}  // namespace evical
