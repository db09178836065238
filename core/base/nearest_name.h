// What somebody may have meant by a name that nobody knows.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace evical {

// Insertions, deletions, substitutions and swaps of neighbours that turn one into the other.
int editDistance(std::string_view a, std::string_view b);

// The nearest of the known names; empty when none is near (more than half of its letters differ).
std::string nearestName(std::string_view name, std::span<const std::string> known);

// A sentence for messages: "Did you mean 'rows'?", or the list of those there are.
std::string nameAdvice(std::string_view name, std::span<const std::string> known);

// "a, b, c". (fmt::join of strings warns in GCC 12.)
std::string joined(std::span<const std::string> words);

}  // namespace evical
