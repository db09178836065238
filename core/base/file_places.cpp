#include "core/base/file_places.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace evical {

CalibrationError writeError(const std::filesystem::path& path, int error) {
  return calibrationFailed(path.string(), fmt::format("cannot be written: {}", std::strerror(error)),
                           error == ENOSPC ? "Free disk space, or choose another folder"
                                           : "Check that the folder exists and has write permission");
}

int whyNoPlace(const std::filesystem::path& path) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) return EISDIR;
  return std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) ? EEXIST : 0;
}

}  // namespace evical
