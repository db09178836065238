// Suggestions for unknown names.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace evical {

// Edit distance: insertions, deletions, substitutions and swaps of neighbours.
int editDistance(std::string_view a, std::string_view b);

// The nearest known name; empty if more than half of its letters differ.
std::string nearestName(std::string_view name, std::span<const std::string> known);

// A sentence for messages: "Did you mean 'rows'?", or the list of known names.
std::string nameAdvice(std::string_view name, std::span<const std::string> known);

// "a, b, c". (fmt::join of strings causes a warning in GCC 12.)
std::string joined(std::span<const std::string> words);

}  // namespace evical
