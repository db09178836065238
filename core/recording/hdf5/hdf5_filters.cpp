#include "core/recording/hdf5/hdf5_filters.h"

#include "core/recording/hdf5/ecf_decoder.h"

#include <blosc.h>
#include <fmt/format.h>
#include <liblzf/lzf.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <vector>

namespace evical::hdf5 {
namespace {

constexpr std::size_t kLargestFilteredChunk_bytes = std::size_t{1} << 30;
constexpr std::size_t kLzfLargestRatio = 100;  // 264 bytes out of 3
constexpr unsigned kBloscZstd = 5;
constexpr unsigned kBloscLevel = 1;

thread_local std::size_t expected_bytes = 0;

// Memory that libhdf5 may free.
class Memory {
 public:
  explicit Memory(std::size_t bytes) : data_(H5allocate_memory(bytes, true)), bytes_(data_ ? bytes : 0) {}
  ~Memory() {
    if (data_) H5free_memory(data_);
  }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  void* data() const { return data_; }

  // Becomes the filter's result.
  std::size_t handOver(std::size_t used, std::size_t* buffer_bytes, void** buffer) {
    H5free_memory(*buffer);
    *buffer = std::exchange(data_, nullptr);
    *buffer_bytes = bytes_;
    return used;
  }

 private:
  void* data_;
  std::size_t bytes_;
};

std::size_t packBlosc(std::size_t parameters, const unsigned* values, std::size_t bytes,
                      std::size_t* buffer_bytes, void** buffer) {
  const std::size_t element_bytes = parameters > 2 && values[2] > 0 ? values[2] : 1;
  Memory packed(bytes + BLOSC_MAX_OVERHEAD);
  if (!packed.data()) return 0;
  const int size =
      blosc_compress_ctx(static_cast<int>(kBloscLevel), BLOSC_SHUFFLE, element_bytes, bytes, *buffer,
                         packed.data(), bytes + BLOSC_MAX_OVERHEAD, BLOSC_ZSTD_COMPNAME, 0, 1);
  return size <= 0 ? 0 : packed.handOver(static_cast<std::size_t>(size), buffer_bytes, buffer);
}

std::size_t blosc(unsigned flags, std::size_t parameters, const unsigned* values, std::size_t bytes,
                  std::size_t* buffer_bytes, void** buffer) {
  if ((flags & H5Z_FLAG_REVERSE) == 0) return packBlosc(parameters, values, bytes, buffer_bytes, buffer);
  std::size_t size = 0;
  if (blosc_cbuffer_validate(*buffer, bytes, &size) != 0) return 0;
  if (size == 0 || size < expected_bytes || size > kLargestFilteredChunk_bytes) return 0;
  Memory content(size);
  if (!content.data()) return 0;
  const int unpacked = blosc_decompress_ctx(*buffer, content.data(), size, 1);
  if (unpacked < 0 || static_cast<std::size_t>(unpacked) != size) return 0;
  return content.handOver(size, buffer_bytes, buffer);
}

std::size_t lzf(unsigned flags, std::size_t parameters, const unsigned* values, std::size_t bytes,
                std::size_t* buffer_bytes, void** buffer) {
  if ((flags & H5Z_FLAG_REVERSE) == 0 || bytes > kLargestFilteredChunk_bytes) return 0;
  const std::size_t largest = std::min(kLargestFilteredChunk_bytes, bytes * kLzfLargestRatio);
  std::size_t room = std::max<std::size_t>({parameters > 2 ? values[2] : 0, expected_bytes, bytes});
  if (expected_bytes > largest) return 0;
  for (room = std::min(room, largest); room > 0; room = std::min(2 * room, largest)) {
    Memory content(room);
    if (!content.data()) return 0;
    errno = 0;
    const unsigned size =
        lzf_decompress(*buffer, static_cast<unsigned>(bytes), content.data(), static_cast<unsigned>(room));
    if (size != 0 && size >= expected_bytes) return content.handOver(size, buffer_bytes, buffer);
    if (size != 0 || errno != E2BIG || room == largest) return 0;
  }
  return 0;
}

// A last chunk has fewer events than its extent; the rest is not read, or recognised by its time.
std::size_t ecf(unsigned flags, std::size_t, const unsigned*, std::size_t bytes, std::size_t* buffer_bytes,
                void** buffer) {
  std::vector<EcfEvent> events;
  if ((flags & H5Z_FLAG_REVERSE) == 0) return 0;
  if (!decodeEcf({static_cast<const char*>(*buffer), bytes}, events)) return 0;
  const std::size_t used = events.size() * sizeof(EcfEvent);
  const std::size_t room = std::max(used, expected_bytes);
  if (room == 0 || room > kLargestFilteredChunk_bytes) return 0;
  Memory content(room);
  if (!content.data()) return 0;
  EcfEvent none;
  none.t = kNoTime_us;
  events.resize(room / sizeof(EcfEvent), none);
  std::memcpy(content.data(), events.data(), events.size() * sizeof(EcfEvent));
  return content.handOver(room, buffer_bytes, buffer);
}

}  // namespace

void registerFilters() {
  static const bool once = [] {
    const H5Z_class2_t classes[] = {{H5Z_CLASS_T_VERS, kBlosc, 1, 1, "blosc", nullptr, nullptr, blosc},
                                    {H5Z_CLASS_T_VERS, kLzf, 0, 1, "lzf", nullptr, nullptr, lzf},
                                    {H5Z_CLASS_T_VERS, kEcf, 0, 1, "ecf", nullptr, nullptr, ecf}};
    for (const H5Z_class2_t& filter : classes) H5Zregister(&filter);
    return true;
  }();
  static_cast<void>(once);
}

ExpectedChunk::ExpectedChunk(std::size_t bytes) {
  expected_bytes = bytes;
}

ExpectedChunk::~ExpectedChunk() {
  expected_bytes = 0;
}

void setBlosc(hid_t creation, std::size_t element_bytes, std::size_t chunk_bytes) {
  const std::array<unsigned, 7> values{2,
                                       2,
                                       static_cast<unsigned>(element_bytes),
                                       static_cast<unsigned>(chunk_bytes),
                                       kBloscLevel,
                                       BLOSC_SHUFFLE,
                                       kBloscZstd};
  H5Pset_filter(creation, kBlosc, H5Z_FLAG_OPTIONAL, values.size(), values.data());
}

std::string filterName(H5Z_filter_t filter) {
  struct Known {
    H5Z_filter_t filter;
    const char* name;
  };
  static constexpr Known kKnown[] = {
      {H5Z_FILTER_SZIP, "szip"}, {305, "LZO"},   {307, "bzip2"},       {32004, "LZ4"},
      {32008, "bitshuffle"},     {32013, "ZFP"}, {32015, "Zstandard"}, {32026, "Blosc2"}};
  for (const Known& known : kKnown)
    if (known.filter == filter) return fmt::format("{} ({})", filter, known.name);
  return fmt::format("{}", filter);
}

}  // namespace evical::hdf5
