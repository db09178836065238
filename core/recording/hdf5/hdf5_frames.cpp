#include "core/recording/hdf5/hdf5_frames.h"

#include "core/base/error.h"
#include "core/data/recording.h"
#include "core/recording/hdf5/hdf5_filters.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace evical::hdf5 {
namespace {

constexpr std::size_t kLargestFrameChunk_bytes = std::size_t{1} << 28;
constexpr std::uint64_t kLargestFrame_bytes = std::uint64_t{1} << 28;
constexpr std::size_t kMinFrameCache_bytes = std::size_t{1} << 20,
                      kLargestFrameCache_bytes = std::size_t{1} << 28;

}  // namespace

FrameTable::FrameTable(hid_t file, const DatasetInfo& pictures, const DatasetInfo& times,
                       const std::string& place)
    : path_(pictures.path), times_(file, times, time_, place) {
  const std::vector<std::uint64_t>& extent = pictures.extent;
  rank_ = static_cast<int>(extent.size());
  channels_ = rank_ == 4 ? extent[3] : 1;
  const bool good = rank_ >= 3 && rank_ <= 4 && extent[1] > 0 && extent[1] <= kLargestSide_px &&
                    extent[2] > 0 && extent[2] <= kLargestSide_px && (channels_ == 1 || channels_ == 3) &&
                    extent[1] * extent[2] * channels_ <= kLargestFrame_bytes;
  if (!good) throw badInput(place, path_ + " does not have the extent of pictures in grey or RGB");
  size_px_ = {static_cast<int>(extent[2]), static_cast<int>(extent[1])};
  rows_ = std::min(extent[0], times_.rows().rows());
  if (extent[0] != times_.rows().rows())
    problem_ = fmt::format("there are {} pictures and {} times", extent[0], times_.rows().rows());
  dataset_ = Handle(H5Dopen2(file, path_.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset_.valid()) throw badInput(place, fmt::format("{} cannot be opened: {}", path_, lastProblem()));
  checkLayout(place);
  requirePlausibleRows(file, rows_, extent[1] * extent[2] * channels_, place + ": " + path_);
  // With room for the chunks of one picture, so that none is unpacked twice.
  const std::uint64_t picture_bytes = extent[1] * extent[2] * channels_;
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access, 521,
                     std::clamp<std::size_t>(2 * (chunk_bytes_ + picture_bytes), kMinFrameCache_bytes,
                                             kLargestFrameCache_bytes),
                     1.0);
  dataset_ = Handle(H5Dopen2(file, path_.c_str(), access), H5Dclose);
}

void FrameTable::checkLayout(const std::string& place) {
  const Handle type(H5Dget_type(dataset_), H5Tclose), creation(H5Dget_create_plist(dataset_), H5Pclose);
  if (H5Tget_class(type) != H5T_INTEGER || H5Tget_size(type) != 1)
    throw badInput(place, path_ + " does not contain pictures of 8 bit");
  requireFilters(creation, place, path_);
  if (H5Pget_layout(creation) != H5D_CHUNKED) {
    const std::uint64_t picture_bytes = static_cast<std::uint64_t>(size_px_.width_px) *
                                        static_cast<std::uint64_t>(size_px_.height_px) * channels_;
    if (rows_ > H5Dget_storage_size(dataset_) / picture_bytes)  // the library would read beyond its buffers
      throw badInput(place, fmt::format("{} states {} pictures, but stores fewer", path_, rows_));
    return;
  }
  H5Pget_chunk(creation, rank_, chunk_.data());
  std::uint64_t bytes = 1;
  for (const hsize_t side : chunk_) {
    if (side == 0 || side > kLargestFrameChunk_bytes / bytes)
      throw badInput(place, fmt::format("the chunks of {} are too large", path_));
    bytes *= side;
  }
  chunk_bytes_ = static_cast<std::size_t>(bytes);
}

// The library accepts any chunk that is marked as unpacked, at any length.
bool FrameTable::chunksAreWhole(std::uint64_t row) const {
  const std::array<hsize_t, 4> extent{1, static_cast<hsize_t>(size_px_.height_px),
                                      static_cast<hsize_t>(size_px_.width_px), channels_};
  std::array<hsize_t, 4> at{row / chunk_[0] * chunk_[0], 0, 0, 0};
  for (at[1] = 0; at[1] < extent[1]; at[1] += chunk_[1]) {
    for (at[2] = 0; at[2] < extent[2]; at[2] += chunk_[2]) {
      for (at[3] = 0; at[3] < extent[3]; at[3] += chunk_[3]) {
        unsigned mask = 0;
        haddr_t address = HADDR_UNDEF;
        hsize_t bytes = 0;
        if (H5Dget_chunk_info_by_coord(dataset_, at.data(), &mask, &address, &bytes) < 0) return false;
        if (address != HADDR_UNDEF && mask != 0 && bytes < chunk_bytes_) return false;
      }
    }
  }
  return true;
}

bool FrameTable::load(std::uint64_t row, Frame& frame) {
  frame = {};
  DatasetRows& times = times_.rows();
  if (times.from(row).empty()) {
    problem_ = times.problem();
    return false;
  }
  if (!times_.convert(row, time_, frame.time_ns)) {
    problem_ = fmt::format("the time of row {} is invalid", row);
    return false;
  }
  if (chunk_bytes_ > 0 && !chunksAreWhole(row)) {
    problem_ = fmt::format("{}, row {} (a chunk is incomplete)", path_, row);
    return false;
  }
  const auto width = static_cast<hsize_t>(size_px_.width_px),
             height = static_cast<hsize_t>(size_px_.height_px);
  const std::array<hsize_t, 4> start{row, 0, 0, 0}, extent{1, height, width, channels_};
  const Handle file_space(H5Dget_space(dataset_), H5Sclose);
  const Handle memory_space(H5Screate_simple(rank_, extent.data(), nullptr), H5Sclose);
  frame.bytes.resize(static_cast<std::size_t>(height * width * channels_));
  const ExpectedChunk expected(chunk_bytes_);
  const MemoryLimit limit(memoryForChunks(std::max<std::uint64_t>(chunk_bytes_, frame.bytes.size())));
  const bool read =
      H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr) >= 0 &&
      H5Dread(dataset_, H5T_NATIVE_UINT8, memory_space, file_space, H5P_DEFAULT, frame.bytes.data()) >= 0;
  if (!read) {
    problem_ = fmt::format("{}, row {} ({})", path_, row, lastProblem());
    return false;
  }
  frame.format = channels_ == 3 ? FrameFormat::Rgb8 : FrameFormat::Gray8;
  frame.size_px = size_px_;
  frame.row_bytes = static_cast<std::size_t>(width * channels_);
  return true;
}

}  // namespace evical::hdf5
