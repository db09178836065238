#include "app/output.h"

#include "core/base/plain_text.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace evical {
namespace {

int& lostBecause() {
  static int error = 0;
  return error;
}

constexpr std::string_view kPrinted = "\n\t";

}  // namespace

void printText(std::string_view raw) {
  const std::string text = visible(raw, kPrinted);
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() && lostBecause() == 0)
    lostBecause() = errno;
}

void printError(std::string_view text) {
  clearTerminal(visible(text, kPrinted));
}

void clearTerminal(std::string_view sequence) {
  static_cast<void>(std::fwrite(sequence.data(), 1, sequence.size(), stderr));
}

void holdStandardStreams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // open() returns the lowest free descriptor, which is this one. Read-only, so that writing to it fails
    // visibly.
    static_cast<void>(::open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY));
  }
}

std::string lostOutput() {
  std::cout.flush();  // the parser's help
  if (std::fflush(stdout) != 0 && lostBecause() == 0) lostBecause() = errno;
  if (lostBecause() == 0 && std::cout.good() && std::ferror(stdout) == 0) return {};
  return std::string("standard output cannot be written: ") +
         (lostBecause() != 0 ? std::strerror(lostBecause()) : "some output was lost");
}

}  // namespace evical
