// A small HDF5 file: all of its datasets at once.
#pragma once

#include <cstdint>
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

// Those of the paths that the content has, in their order. Throws CalibrationError (BadInput), which names `file`, where it
// is no HDF5 file, or one of them is neither float64 nor int64 nor text.
std::vector<Hdf5Dataset> hdf5Datasets(const std::string& content, const std::string& file,
                                      std::span<const std::string> paths);

}  // namespace evical
