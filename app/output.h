// Output to the terminal or a pipe. A closed or full stream does not end the program.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace evical {

// Standard output; write errors are recorded (lostOutput).
void printText(std::string_view text);
template <class... Arguments>
void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  printText(fmt::format(format, std::forward<Arguments>(arguments)...));
}

// Standard error; write errors are ignored.
void printError(std::string_view text);

// Opens closed standard descriptors: the next opened files would get them and receive printed text.
// Call first.
void holdStandardStreams();

// Flushes everything; returns the reason if output was lost, else nothing.
std::string lostOutput();

}  // namespace evical
