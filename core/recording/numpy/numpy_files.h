// The arrays that files and folders hold.
#pragma once

#include "core/recording/numpy/numpy_columns.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace evical::numpy {

struct FoundFiles {
  std::vector<Array> arrays;
  std::vector<std::string> problems;  // sentences about arrays that cannot be read
  std::vector<std::string> unread;    // archives beside them
};

// Of a .npy or .npz file; throws CalibrationError (BadInput) where it is damaged as a whole.
FoundFiles arraysIn(const std::filesystem::path& file);

// Of all .npy files of a folder.
FoundFiles arraysOfFolder(const std::filesystem::path& folder);

// Names without ".npy" of the files that a folder has.
std::vector<std::string> arrayNames(const std::filesystem::path& folder);

// A folder's .npz and .npy files that are named by numbers alone, in their order; none where other arrays are among them.
std::vector<std::filesystem::path> numberedFiles(const std::filesystem::path& folder);

// Whether a file of this beginning is an array or an archive of arrays.
bool isArrayFile(const std::filesystem::path& path, std::string_view first_bytes);

}  // namespace evical::numpy
