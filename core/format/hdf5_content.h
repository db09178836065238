// HDF5 files in memory: datasets one by one, by their paths.
#pragma once

#include "core/base/text_sink.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace evical {

struct Hdf5Dataset {
  std::string path;                     // "/prophesee/left/calib/intrinsics"; groups above it are made
  std::vector<std::size_t> shape = {};  // of numbers or texts, row by row; empty: one
  // Text as h5py writes str; one text has no shape.
  std::variant<std::vector<double>, std::vector<std::int64_t>, std::string, std::vector<std::string>> data;
  bool narrow = false;  // integers are written in as few bytes as hold all of them

  bool operator==(const Hdf5Dataset&) const = default;
};

using Hdf5Sink = std::function<void(const Hdf5Dataset& dataset)>;
// Nothing where there is no dataset of this path.
using Hdf5Source = std::function<std::optional<Hdf5Dataset>(const std::string& path)>;

// Hands on, in one piece, a file with what `fill` adds, and with an attribute `comment` of the root. The same datasets are the
// same bytes: it bears no time. Throws CalibrationError (CalibrationFailed) where the library cannot.
void writeHdf5(const std::function<void(const Hdf5Sink& add)>& fill, const std::string& comment,
               const TextSink& sink);

// The datasets of a file's bytes. Throws CalibrationError (BadInput), which names `file`, where these are no HDF5 file; the
// source throws it where a dataset is neither float64 nor integers nor text. Bytes that may be damaged need a check sum
// before they come here: the library writes past its memory on some of them.
Hdf5Source hdf5Source(std::string_view content, const std::string& file);

}  // namespace evical
