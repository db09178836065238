// Output to the terminal or a pipe. A closed or full stream does not end the program.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace evical {

// Standard output; write errors are recorded (lostOutput). Control characters except line breaks and tabs are
// printed as escapes: names in files may have them, and would operate the terminal.
void printText(std::string_view text);
template <class... Arguments>
void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  printText(fmt::format(format, std::forward<Arguments>(arguments)...));
}

// Standard error; write errors are ignored. Control characters as above.
void printError(std::string_view text);

// A sequence of our own that clears lines of the terminal on standard error.
void clearTerminal(std::string_view sequence);

// Opens closed standard descriptors: the next opened files would get them and receive printed text.
// Call first.
void holdStandardStreams();

// Flushes everything; returns the reason if output was lost, else nothing.
std::string lostOutput();

}  // namespace evical
