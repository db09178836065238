// The arrays in files and folders.
#pragma once

#include "core/recording/numpy/byte_stream.h"
#include "core/recording/numpy/numpy_columns.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace evical::numpy {

struct FoundFiles {
  std::vector<Array> arrays;
  std::vector<std::string> problems;  // sentences on unreadable arrays
  std::vector<std::string> unread;    // archives next to them
};

// Arrays of a .npy or .npz file; throws CalibrationError (BadInput) if it is damaged as a whole.
FoundFiles arraysIn(const std::filesystem::path& file);

// Arrays of all .npy files of a folder.
FoundFiles arraysOfFolder(const std::filesystem::path& folder);

// File names in a folder, without ".npy".
std::vector<std::string> arrayNames(const std::filesystem::path& folder);

// A folder's .npz and .npy files with numbers as names, in their order; empty if there are other arrays, too.
std::vector<std::filesystem::path> numberedFiles(const std::filesystem::path& folder);

// True if a file with this beginning is an array or an archive of arrays.
bool isArrayFile(const std::filesystem::path& path, std::string_view first_bytes);

}  // namespace evical::numpy

// The directory of a ZIP archive, such as .npz files are: members stored or deflated, of any size (zip64).

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
