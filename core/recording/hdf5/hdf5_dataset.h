// One dataset of a file, read in blocks along its chunks.
#pragma once

#include "core/recording/hdf5/hdf5_library.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace evical::hdf5 {

// Properties that need no data to be read.
struct DatasetInfo {
  std::string path;  // in the file, without the leading '/'
  std::vector<std::uint64_t> extent;
  H5T_class_t type_class = H5T_NO_CLASS;
  std::vector<std::string> members;  // of a compound type
  std::string name() const { return path.substr(path.rfind('/') + 1); }
  std::string folder() const { return path.substr(0, path.size() - name().size()); }  // "" or "a/b/"
  bool isReal() const { return type_class == H5T_FLOAT; }
};

struct DatasetList {
  std::vector<DatasetInfo> datasets;
  std::vector<std::string> damaged;  // paths of objects whose kind or description cannot be read
  std::vector<std::string>
      elsewhere;  // paths of datasets and links whose content is in other files, which are not opened
};

// All datasets; throws CalibrationError (BadInput) if the file's tree is damaged or too deep.
DatasetList listDatasets(hid_t file, const std::string& place);

// Throws CalibrationError (BadInput) if a filter of a dataset's creation properties is not installed.
void requireFilters(hid_t creation, const std::string& place, const std::string& path);

// Missing and shared chunks make a table of any length out of a small file. Throws CalibrationError
// (BadInput) if a file cannot have these rows.
void requirePlausibleRows(hid_t file, std::uint64_t rows, std::uint64_t row_bytes, const std::string& place);

// For a filter's input and output, the cache, and the library's own needs.
std::uint64_t memoryForChunks(std::uint64_t chunk_bytes);

// Rows of one column (a list) or several (a table of rank 2), converted by HDF5 to `memory_type`.
class DatasetRows {
 public:
  // Throws CalibrationError (BadInput) if it cannot be read, e.g. because of an unknown filter.
  DatasetRows(hid_t file, const DatasetInfo& info, hid_t memory_type, const std::string& place);

  std::uint64_t rows() const { return rows_; }

  // Bytes of the rows from `row` to the end of its block; empty if the block cannot be read: then problem()
  // has the reason.
  std::span<const std::byte> from(std::uint64_t row);
  std::uint64_t blockEnd(std::uint64_t row) const;
  std::size_t rowBytes() const { return row_bytes_; }
  const std::string& problem() const { return problem_; }

 private:
  bool storesTooLittle() const;
  void readChunkLayout(const std::string& place, std::uint64_t file_bytes);
  void load(std::uint64_t row);
  std::string placeAndReason(std::uint64_t row) const;

  std::string path_;
  Handle dataset_, memory_type_;
  std::uint64_t rows_ = 0, columns_ = 1;
  bool is_table_ = false;
  std::size_t row_bytes_ = 0;
  std::uint64_t block_rows_ = 0;
  std::size_t chunk_bytes_ = 0;  // 0: in one piece
  std::vector<std::byte> block_;
  std::uint64_t block_begin_ = 0;
  bool is_loaded_ = false;
  std::string problem_;
};

// DatasetRows with numbers of one type.
template <class Number>
class Rows : public DatasetRows {
 public:
  using DatasetRows::DatasetRows;
  std::span<const Number> numbersFrom(std::uint64_t row) {
    const std::span<const std::byte> bytes = from(row);
    return {reinterpret_cast<const Number*>(bytes.data()), bytes.size() / sizeof(Number)};
  }
};

}  // namespace evical::hdf5
