// Where files may be put, and what is said where they may not: for those who write them.
#pragma once

#include "core/base/error.h"

#include <filesystem>

namespace evical {

// That nothing can be written there, `error` as errno has it.
CalibrationError writeError(const std::filesystem::path& path, int error);

// Why nothing may be put there, as errno has it; 0 if it may. A rename would replace a device or a pipe.
int whyNoPlace(const std::filesystem::path& path);

// True if the path exists, false if it does not or cannot be examined.
inline bool isThere(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

}  // namespace evical
