// Checks of output paths, and their error messages.
#pragma once

#include "core/base/error.h"

#include <filesystem>

namespace evical {

// The error that this path cannot be written; `error` is an errno.
CalibrationError writeError(const std::filesystem::path& path, int error);

// Why this path cannot be replaced, as an errno; 0 if it can. A rename would replace a device or a pipe.
int whyNoPlace(const std::filesystem::path& path);

// True if the path exists, false if it does not or cannot be examined.
inline bool isThere(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

}  // namespace evical
