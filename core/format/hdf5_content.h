// HDF5 files in memory, as datasets with paths.
#pragma once

#include "core/base/atomic_file.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace evical {

struct Hdf5Dataset {
  std::string path;                     // "/prophesee/left/calib/intrinsics"; parent groups are created
  std::vector<std::size_t> shape = {};  // of numbers or texts, row by row; empty: one
  // Text as h5py's str; a single text has no shape.
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::string, std::vector<std::string>> data;
  bool narrow = false;  // integers are written in the fewest possible bytes

  bool operator==(const Hdf5Dataset&) const = default;
};

using Hdf5Sink = std::function<void(const Hdf5Dataset& dataset)>;
// nullopt without a dataset of this path.
using Hdf5Source = std::function<std::optional<Hdf5Dataset>(const std::string& path)>;

// Calls its argument with the bytes of a file with the datasets of `fill`, and an attribute `comment` of the
// root. Equal datasets give equal bytes: the file has no time. Throws CalibrationError (CalibrationFailed) if
// the library fails.
void writeHdf5(const std::function<void(const Hdf5Sink& add)>& fill, const std::string& comment,
               const TextSink& sink);

// The datasets of a file's bytes. Throws CalibrationError (BadInput), which names `file`, if these are not an
// HDF5 file; the source throws it if a dataset is neither float64 nor integers nor text. Verify a checksum
// first if the bytes may be damaged: the library writes beyond its memory on some of them.
Hdf5Source hdf5Source(std::string_view content, const std::string& file);

}  // namespace evical
