// Pictures as rows of a dataset of rank 3 or 4 (count, height, width, and perhaps channels) of bytes, with a
// list of their times: M3ED's and MVSEC's.
#pragma once

#include "core/data/frame.h"
#include "core/recording/hdf5/hdf5_tables.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>

namespace evical::hdf5 {

class FrameTable {
 public:
  // Throws CalibrationError (BadInput) if they cannot be read.
  FrameTable(hid_t file, const DatasetInfo& pictures, const DatasetInfo& times, const std::string& place);

  std::uint64_t rows() const { return rows_; }
  Resolution size_px() const { return size_px_; }
  const TimeScale& timeScale() const { return time_; }

  // False if the row cannot be read: then takeProblem() has the reason.
  bool load(std::uint64_t row, Frame& frame);
  std::string takeProblem() { return std::exchange(problem_, {}); }

 private:
  void checkLayout(const std::string& place);
  bool chunksAreWhole(std::uint64_t row) const;

  std::string path_;
  Handle dataset_;
  TimeScale time_;
  Times times_;
  int rank_ = 3;
  std::uint64_t rows_ = 0;
  Resolution size_px_;
  std::uint64_t channels_ = 1;
  std::size_t chunk_bytes_ = 0;  // 0: in one piece
  std::array<hsize_t, 4> chunk_ = {1, 1, 1, 1};
  std::string problem_;
};

}  // namespace evical::hdf5
