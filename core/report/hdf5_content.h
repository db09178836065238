// A small HDF5 file: all of its datasets at once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace evical {

struct Hdf5Dataset {
  std::string path;                     // "/prophesee/left/calib/intrinsics"; groups above it are made
  std::vector<std::size_t> shape = {};  // of numbers, row by row; empty: one
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::string> data;  // text as h5py writes str

  bool operator==(const Hdf5Dataset&) const = default;
};

// The file's bytes, with an attribute `comment` of the root. The same datasets are the same bytes: it bears no time.
// Throws CalibrationError (CalibrationFailed) where the library cannot.
std::string hdf5Content(std::span<const Hdf5Dataset> datasets, const std::string& comment);

}  // namespace evical
