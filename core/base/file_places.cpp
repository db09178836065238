#include "core/base/file_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
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

std::string contentOfFile(const std::filesystem::path& file, std::uintmax_t max_bytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::string bytes(error ? 0 : std::min(size, max_bytes), '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

}  // namespace evical
