#include "core/recording/hdf5/hdf5_dataset.h"

#include "core/base/error.h"
#include "core/recording/hdf5/hdf5_filters.h"
#include "core/recording/unpacking_limit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>

namespace evical::hdf5 {
namespace {

constexpr std::size_t kMaxDatasets = 10'000;
constexpr std::uint64_t kMinBlock_rows = 65'536, kLargestBlock_rows = 1 << 20;
constexpr std::size_t kMinCache_bytes = std::size_t{1} << 20, kLargestCache_bytes = std::size_t{1} << 28;
constexpr std::size_t kLargestChunk_bytes = std::size_t{1} << 30;

std::uint64_t bytesOfFile(hid_t file) {
  hsize_t bytes = 0;
  H5Fget_filesize(file, &bytes);
  return bytes;
}

enum class Described { Good, Damaged, Elsewhere };

Described describe(hid_t file, const char* path, DatasetInfo& info) {
  const Handle dataset(H5Dopen2(file, path, H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) return Described::Damaged;
  const Handle space(H5Dget_space(dataset), H5Sclose), type(H5Dget_type(dataset), H5Tclose);
  const int rank = space.valid() ? H5Sget_simple_extent_ndims(space) : -1;
  if (rank < 0 || !type.valid()) return Described::Damaged;
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  if (H5Pget_layout(creation) == H5D_VIRTUAL || H5Pget_external_count(creation) > 0)
    return Described::Elsewhere;
  info.path = path;
  info.type_class = H5Tget_class(type);
  std::vector<hsize_t> extent(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  info.extent.assign(extent.begin(), extent.end());
  const int members = info.type_class == H5T_COMPOUND ? H5Tget_nmembers(type) : 0;
  for (int i = 0; i < members; ++i) {
    char* name = H5Tget_member_name(type, static_cast<unsigned>(i));
    if (name) info.members.emplace_back(name);
    H5free_memory(name);
  }
  return Described::Good;
}

// HDF5 1.12 gave the names of these functions to others.
#if H5_VERSION_GE(1, 12, 0)
using LinkInfo = H5L_info1_t;
const auto kIterateLinks = H5Literate1;
using ObjectInfo = H5O_info1_t;
#else
using LinkInfo = H5L_info_t;
const auto kIterateLinks = H5Literate;
using ObjectInfo = H5O_info_t;
#endif

// Visits all objects once. The library's own visits take a time that grows with the square of the depth, and
// name no links to other files.
class Walk {
 public:
  explicit Walk(hid_t file) : file_(file) {}

  bool run() { return below(file_, ""); }
  DatasetList found;
  bool too_deep = false;

 private:
  static constexpr int kDeepest = 32;

  bool below(hid_t group, const std::string& folder) {
    if (depth_ == kDeepest) {
      too_deep = true;
      return false;
    }
    ++depth_;
    const std::string above = std::exchange(folder_, folder);
    const bool good = kIterateLinks(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, this) >= 0;
    folder_ = above;
    --depth_;
    return good;
  }

  static herr_t visit(hid_t group, const char* name, const LinkInfo* link, void* walk) {
    return static_cast<Walk*>(walk)->link(group, name, *link);
  }

  herr_t link(hid_t group, const char* name, const LinkInfo& link) {
    const std::string path = folder_ + name;
    if (link.type == H5L_TYPE_EXTERNAL) found.elsewhere.push_back(path);
    if (link.type != H5L_TYPE_HARD) return 0;
    ObjectInfo object;
    if (H5Oget_info_by_name2(group, name, &object, H5O_INFO_BASIC, H5P_DEFAULT) < 0) {
      found.damaged.push_back(path);
      return 0;
    }
    if (!visited_.insert(object.addr).second) return 0;
    if (object.type == H5O_TYPE_GROUP) {
      const Handle inner(H5Gopen2(group, name, H5P_DEFAULT), H5Gclose);
      return inner.valid() && below(inner, path + "/") ? 0 : -1;
    }
    if (object.type == H5O_TYPE_DATASET || object.type == H5O_TYPE_UNKNOWN) addObject(path, object.type);
    return found.datasets.size() + found.damaged.size() >= kMaxDatasets ? 1 : 0;
  }

  void addObject(const std::string& path, H5O_type_t type) {
    DatasetInfo info;
    const Described how = type == H5O_TYPE_DATASET ? describe(file_, path.c_str(), info) : Described::Damaged;
    if (how == Described::Good)
      found.datasets.push_back(std::move(info));
    else
      (how == Described::Damaged ? found.damaged : found.elsewhere).push_back(path);
  }

  hid_t file_;
  int depth_ = 0;
  std::string folder_;
  std::set<haddr_t> visited_;
};

}  // namespace

DatasetList listDatasets(hid_t file, const std::string& place) {
  Walk walk(file);
  const bool good = walk.run();
  if (walk.too_deep) throw badInput(place, "the HDF5 file's groups are nested too deeply for a recording");
  if (!good) throw badInput(place, fmt::format("the HDF5 file's tree is damaged: {}", lastProblem()));
  return std::move(walk.found);
}

void requireFilters(hid_t creation, const std::string& place, const std::string& path) {
  const int count = H5Pget_nfilters(creation);
  for (int i = 0; i < count; ++i) {
    unsigned flags = 0;
    std::size_t parameters = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &parameters, nullptr, 0, nullptr, nullptr);
    if (filter >= 0 && H5Zfilter_avail(filter) > 0) continue;
    throw badInput(place,
                   fmt::format("the dataset {} is packed with the HDF5 filter {}, which is not installed",
                               path, filterName(filter)),
                   "Install HDF5's plugin for it, or pack the file again with gzip (h5repack -f GZIP=1)");
  }
}

void requirePlausibleRows(hid_t file, std::uint64_t rows, std::uint64_t row_bytes, const std::string& place) {
  std::uint64_t all_bytes = 0;
  if (__builtin_mul_overflow(rows, row_bytes, &all_bytes))
    all_bytes = std::numeric_limits<std::uint64_t>::max();
  UnpackingLimit(place, bytesOfFile(file)).add(all_bytes);
}

std::uint64_t memoryForChunks(std::uint64_t chunk_bytes) {
  constexpr std::uint64_t kOwn_bytes = std::uint64_t{1} << 27;
  return kOwn_bytes + 6 * chunk_bytes;
}

DatasetRows::DatasetRows(hid_t file, const DatasetInfo& info, hid_t memory_type, const std::string& place)
    : path_(info.path), is_table_(info.extent.size() == 2) {
  if (info.extent.empty() || info.extent.size() > 2)
    throw badInput(place, path_ + " is neither a list nor a table");
  rows_ = info.extent[0];
  if (is_table_) columns_ = info.extent[1];
  memory_type_ = Handle(H5Tcopy(memory_type), H5Tclose);
  row_bytes_ = H5Tget_size(memory_type_) * columns_;
  dataset_ = Handle(H5Dopen2(file, path_.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset_.valid()) throw badInput(place, fmt::format("{} cannot be opened: {}", path_, lastProblem()));
  readChunkLayout(place, bytesOfFile(file));
  const Handle type(H5Dget_type(dataset_), H5Tclose);
  H5T_cdata_t* conversion = nullptr;
  if (!H5Tfind(type, memory_type_, &conversion)) {
    throw badInput(place, fmt::format("{} does not contain numbers", path_));
  }
  if (rows_ > 0 && H5Dget_storage_size(dataset_) == 0) {
    throw badInput(place, fmt::format("{} states {} rows, but stores none", path_, rows_),
                   "Record again: the recording was not finished");
  }
  requirePlausibleRows(file, rows_, columns_ * H5Tget_size(type), place + ": " + path_);
  if (storesTooLittle()) {
    throw badInput(
        place,
        fmt::format("{} states {} rows, but stores {} bytes", path_, rows_, H5Dget_storage_size(dataset_)),
        "Copy the file again: it is damaged");
  }
  // Opened again with room for at least one unpacked chunk, so that none is unpacked twice.
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access, 521, std::clamp(2 * chunk_bytes_, kMinCache_bytes, kLargestCache_bytes), 1.0);
  dataset_ = Handle(H5Dopen2(file, path_.c_str(), access), H5Dclose);
}

// HDF5's library would read beyond its buffers.
bool DatasetRows::storesTooLittle() const {
  const Handle creation(H5Dget_create_plist(dataset_), H5Pclose);
  if (H5Pget_layout(creation) == H5D_CHUNKED) return false;
  const Handle type(H5Dget_type(dataset_), H5Tclose);
  const std::uint64_t element_bytes = H5Tget_size(type), stored_bytes = H5Dget_storage_size(dataset_);
  return element_bytes == 0 || (columns_ > 0 && rows_ > stored_bytes / element_bytes / columns_);
}

void DatasetRows::readChunkLayout(const std::string& place, std::uint64_t file_bytes) {
  const Handle creation(H5Dget_create_plist(dataset_), H5Pclose);
  const Handle type(H5Dget_type(dataset_), H5Tclose);
  requireFilters(creation, place, path_);
  block_rows_ = kMinBlock_rows;
  if (H5Pget_layout(creation) != H5D_CHUNKED) return;
  std::array<hsize_t, 2> chunk{1, 1};
  const int rank = H5Pget_chunk(creation, 2, chunk.data());
  chunk_bytes_ = H5Tget_size(type) * chunk[0] * (rank == 2 ? chunk[1] : 1);
  const std::uint64_t largest = std::min(kLargestChunk_bytes, UnpackingLimit::ofPart(file_bytes));
  if (chunk[0] == 0 || chunk_bytes_ > largest) {
    throw badInput(place, fmt::format("the chunks of {} are too large: {} bytes", path_, chunk_bytes_));
  }
  const std::uint64_t chunks = (kMinBlock_rows + chunk[0] - 1) / chunk[0];
  block_rows_ = std::min<std::uint64_t>(kLargestBlock_rows, chunks * chunk[0]);
}

std::uint64_t DatasetRows::blockEnd(std::uint64_t row) const {
  return std::min(rows_, (row / block_rows_ + 1) * block_rows_);
}

std::span<const std::byte> DatasetRows::from(std::uint64_t row) {
  const std::uint64_t begin = row / block_rows_ * block_rows_;
  if (row >= rows_) return {};
  if (!is_loaded_ || begin != block_begin_) load(begin);
  if (!is_loaded_) return {};
  return std::span(block_).subspan(static_cast<std::size_t>(row - begin) * row_bytes_);
}

void DatasetRows::load(std::uint64_t row) {
  const std::uint64_t count = blockEnd(row) - row;
  const std::array<hsize_t, 2> start{row, 0}, extent{count, columns_};
  const int rank = is_table_ ? 2 : 1;
  const Handle file_space(H5Dget_space(dataset_), H5Sclose);
  const Handle memory_space(H5Screate_simple(rank, extent.data(), nullptr), H5Sclose);
  block_begin_ = row;
  block_.resize(static_cast<std::size_t>(count) * row_bytes_);
  const ExpectedChunk expected(chunk_bytes_);
  const MemoryLimit limit(memoryForChunks(chunk_bytes_));
  is_loaded_ =
      H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start.data(), nullptr, extent.data(), nullptr) >= 0 &&
      H5Dread(dataset_, memory_type_, memory_space, file_space, H5P_DEFAULT, block_.data()) >= 0;
  if (is_loaded_) return;
  problem_ = placeAndReason(row);
}

std::string DatasetRows::placeAndReason(std::uint64_t row) const {
  const std::string reason = lastProblem();  // the query of the address clears it
  const std::array<hsize_t, 2> start{row, 0};
  unsigned mask = 0;
  haddr_t address = HADDR_UNDEF;
  hsize_t bytes = 0;
  const bool known = chunk_bytes_ > 0 &&
                     H5Dget_chunk_info_by_coord(dataset_, start.data(), &mask, &address, &bytes) >= 0 &&
                     address != HADDR_UNDEF;
  return known ? fmt::format("{} at byte {} ({})", path_, address, reason)
               : fmt::format("{} ({})", path_, reason);
}

}  // namespace evical::hdf5
