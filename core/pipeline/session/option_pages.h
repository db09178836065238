// Options as pages for people, those of tuning left out, from their tables.
#pragma once

#include "core/base/option_row.h"

#include <string>

namespace evical {

// Terminal text of the options of this level and of those above it.
std::string optionText(Level least);

// docs/options.md.
std::string optionMarkdown();

// config/default.yaml: the part `options` of a session with every default.
std::string optionYaml();

}  // namespace evical
