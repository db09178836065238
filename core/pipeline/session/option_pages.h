// Documentation pages of the options, without those for tuning, generated from their tables.
#pragma once

#include "core/base/option_row.h"

#include <string>

namespace evical {

// Terminal text of the options of this level and of more public levels.
std::string optionText(Level least);

// Content of docs/options.md.
std::string optionMarkdown();

// Content of config/default.yaml: the part `options` of a session with all defaults.
std::string optionYaml();

}  // namespace evical
