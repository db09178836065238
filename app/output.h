// What goes to the terminal, or where people send it. Neither a closed nor a full stream ends the program.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace evical {

// Standard output; what cannot be written is remembered (lostOutput).
void printText(std::string_view text);
template <class... Arguments>
void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  printText(fmt::format(format, std::forward<Arguments>(arguments)...));
}

// Standard error; what cannot be written there has no other place.
void printError(std::string_view text);

// Descriptors that are closed would be given to the next files that are opened, and those be written to by
// whoever prints. Call first.
void holdStandardStreams();

// Brings everything out, and says why not all of it could be; empty if it was.
std::string lostOutput();

}  // namespace evical
