#include "core/recording/hdf5/hdf5_filters.h"

#include "core/recording/byte_cursor.h"

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

namespace evical::hdf5 {
namespace {

constexpr std::size_t kMaxEvents = 65'535;

// `fill` is called with a run's length.
template <class Fill>
bool takeRun(ByteCursor& cursor, std::size_t& done, std::size_t total, std::size_t count, std::size_t escape,
             Fill&& fill) {
  if (count == escape) count = cursor.number<std::uint16_t>();
  if (!cursor.ok() || count > total - done) return false;
  for (std::size_t i = 0; i < count; ++i) fill(done++);
  return true;
}

bool decodeTimes(ByteCursor& cursor, std::vector<EcfEvent>& events) {
  auto time_us = static_cast<std::uint64_t>(cursor.number<std::int64_t>());
  for (std::size_t done = 0; done < events.size();) {
    auto byte = cursor.number<std::uint8_t>();
    std::uint64_t long_step = 0;
    int shift = 0;
    for (; cursor.ok() && byte >> 4 == 15; shift += 4, byte = cursor.number<std::uint8_t>()) {
      if (shift > 60) return false;
      long_step |= std::uint64_t{byte & 15U} << shift;
    }
    time_us += long_step + (byte >> 4);
    const auto fill = [&](std::size_t i) { events[i].t = static_cast<std::int64_t>(time_us); };
    if (!takeRun(cursor, done, events.size(), byte & 15U, 15, fill)) return false;
  }
  return cursor.ok();
}

// Four values of 24 bits in three words of 32, or of 12 bits in three words of 16.
template <class Word, class Store>
bool decodePacked(ByteCursor& cursor, std::size_t count, Store&& store) {
  constexpr unsigned kQuarter = sizeof(Word) * 2;  // bits of a value in the next word
  constexpr std::uint32_t kFull = sizeof(Word) == 4 ? 0xFFFFFFU : 0xFFFU;
  const auto low = [](std::uint32_t word, unsigned bits) { return word & ((1U << bits) - 1U); };
  for (std::size_t i = 0; i < count; i += 4) {
    const std::uint32_t a = cursor.number<Word>(), c = cursor.number<Word>(), d = cursor.number<Word>();
    if (!cursor.ok()) return false;
    const std::array<std::uint32_t, 4> values{
        a >> kQuarter, low(a, kQuarter) | (c >> 2 * kQuarter) << kQuarter,
        low(c, 2 * kQuarter) | (d >> 3 * kQuarter) << 2 * kQuarter, d & kFull};
    for (std::size_t k = 0; k < 4 && i + k < count; ++k) store(i + k, values[k]);
  }
  return true;
}

bool decodeRows(ByteCursor& cursor, std::vector<EcfEvent>& events) {
  for (std::size_t done = 0; done < events.size();) {
    const auto word = cursor.number<std::uint16_t>();
    const auto y = static_cast<std::uint16_t>(word >> 5);
    const auto fill = [&](std::size_t i) { events[i].y = y; };
    if (!takeRun(cursor, done, events.size(), word & 31U, 31, fill)) return false;
  }
  return true;
}

bool decodeColumns(ByteCursor& cursor, std::vector<EcfEvent>& events) {
  for (std::size_t done = 0; done < events.size();) {
    const auto word = cursor.number<std::uint16_t>();
    if (!cursor.ok()) return false;
    const unsigned x = word >> 5;
    events[done++].x = static_cast<std::uint16_t>(x);
    for (unsigned step = 1; step <= 5; ++step) {
      if ((word >> (5 - step) & 1U) == 0) continue;
      if (done == events.size()) return false;
      events[done++].x = static_cast<std::uint16_t>(x + step);
    }
  }
  return true;
}

bool decodePolarities(ByteCursor& cursor, std::vector<EcfEvent>& events) {
  for (std::size_t done = 0; done < events.size();) {
    const auto byte = cursor.number<std::uint8_t>();
    const auto fill = [&](std::size_t i) { events[i].p = static_cast<std::int16_t>(byte >> 7); };
    if (!takeRun(cursor, done, events.size(), byte & 127U, 127, fill)) return false;
  }
  return true;
}

}  // namespace

// Runs of length 0 make no progress, but each consumes bytes: every loop ends.
bool decodeEcf(std::string_view bytes, std::vector<EcfEvent>& events) {
  ByteCursor cursor(bytes);
  const auto header = cursor.number<std::uint32_t>();
  const std::size_t count = header >> 2;
  events.clear();
  if (!cursor.ok() || count > kMaxEvents) return false;
  events.resize(count);
  if (!decodeTimes(cursor, events)) return false;
  if ((header & 2U) != 0) {
    return decodePacked<std::uint32_t>(cursor, count, [&](std::size_t i, std::uint32_t value) {
      events[i].y = static_cast<std::uint16_t>(value >> 12 & 0x7FFU);
      events[i].x = static_cast<std::uint16_t>(value >> 1 & 0x7FFU);
      events[i].p = static_cast<std::int16_t>(value & 1U);
    });
  }
  if (!decodeRows(cursor, events)) return false;
  if ((header & 1U) != 0) {
    return decodePacked<std::uint16_t>(cursor, count, [&](std::size_t i, std::uint32_t value) {
      events[i].x = static_cast<std::uint16_t>(value >> 1 & 0x7FFU);
      events[i].p = static_cast<std::int16_t>(value & 1U);
    });
  }
  return decodeColumns(cursor, events) && decodePolarities(cursor, events);
}

}  // namespace evical::hdf5
