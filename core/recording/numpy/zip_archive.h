// The directory of a ZIP archive, such as .npz files are: members stored or deflated, of any size (zip64).
#pragma once

#include "core/recording/numpy/byte_stream.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace evical::numpy {

struct ZipMember {
  std::string name;
  ByteRange range;
  bool cut = false;     // the file has fewer bytes than the directory states
  std::string problem;  // reason if it cannot be read; otherwise empty
};

// Throws CalibrationError (BadInput) if the directory, which is at the end, is missing or damaged.
std::vector<ZipMember> zipMembers(const std::filesystem::path& path);

// Name of the first member of a file with this beginning; empty for other files than ZIP archives.
std::string_view firstZipMember(std::string_view first_bytes);

}  // namespace evical::numpy
