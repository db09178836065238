// Checks of paths and their error messages, and the content of files.
#pragma once

#include "core/base/error.h"

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>

namespace evical {

// The error that this path cannot be written; `error` is an errno.
CalibrationError writeError(const std::filesystem::path& path, int error);

// Why this path cannot be replaced, as an errno; 0 if it can. A rename would replace a device or a pipe.
int whyNoPlace(const std::filesystem::path& path);

// True if the path exists, false if it does not or cannot be examined.
inline bool pathExists(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

// Content of a file, or its first bytes; empty if it cannot be read. A pipe or device has none: opening it could wait forever.
std::string contentOfFile(const std::filesystem::path& file,
                          std::uintmax_t most_bytes = std::numeric_limits<std::uintmax_t>::max());

}  // namespace evical
