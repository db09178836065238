// Columns of numbers in arrays, read in parallel in blocks of bounded size: each column of a table may be in
// a separate array, or with others in one.
#pragma once

#include "core/recording/numpy/byte_stream.h"
#include "core/recording/numpy/npy_header.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace evical::numpy {

// An array in a file or an archive.
struct Array {
  std::string name;
  ByteRange range;
  ArrayHeader header;
};

// One number per row: at `start + row * stride + offset` after the array's header.
struct Column {
  std::string array;  // for people
  ByteRange range;
  std::uint64_t data_offset = 0, start = 0;
  std::size_t stride = 1, offset = 0;
  NumberType type;
};

class ColumnBlocks {
 public:
  ColumnBlocks(std::span<const Column> columns, std::uint64_t rows);

  // Replaces the block by the next rows, at most `most`, and returns their number; 0 at the end, which may
  // come before all rows are read: then problem() has the reason.
  std::size_t next(std::size_t most);

  std::uint64_t rowsRead() const { return read_; }

  // Calls `sink(row, number)` for each number of the block: a std::int64_t, std::uint64_t or double.
  template <class Sink>
  void forEach(std::size_t column, Sink sink) const;

  // Problem so far, with the array's name; empty if none.
  std::string problem() const;

 private:
  // Rows of one array, or of one of its columns.
  struct Source {
    std::string array;
    std::unique_ptr<ByteStream> bytes;
    std::size_t stride = 1;
    std::vector<char> block;
  };
  struct Place {
    std::size_t source = 0, offset = 0;
    NumberType type;
  };

  std::size_t fill(Source& source, std::size_t rows);

  std::vector<Source> sources_;
  std::vector<Place> places_;
  std::uint64_t rows_ = 0, read_ = 0;
  std::size_t in_block_ = 0, largest_stride_ = 1;
  std::string ended_;  // the array with too few rows
};

namespace detail {

template <class Bits>
Bits swapped(Bits bits) {
  if constexpr (sizeof(Bits) == 2) return __builtin_bswap16(bits);
  if constexpr (sizeof(Bits) == 4) return __builtin_bswap32(bits);
  if constexpr (sizeof(Bits) == 8) return __builtin_bswap64(bits);
  return bits;
}

double fromHalf(std::uint16_t bits);

// `Bits`: type in the file; `Number`: type of the value.
template <class Bits, class Number, class Sink>
void forEachNumber(const char* place, std::size_t stride, std::size_t rows, bool big_endian, Sink& sink) {
  for (std::size_t row = 0; row < rows; ++row, place += stride) {
    Bits bits{};
    std::memcpy(&bits, place, sizeof bits);
    if (big_endian) bits = swapped(bits);
    if constexpr (std::is_same_v<Number, void>) {
      sink(row, fromHalf(bits));
    } else if constexpr (std::is_floating_point_v<Number>) {
      sink(row, static_cast<double>(std::bit_cast<Number>(bits)));
    } else if constexpr (std::is_signed_v<Number>) {
      sink(row, static_cast<std::int64_t>(static_cast<Number>(bits)));
    } else {
      sink(row, static_cast<std::uint64_t>(bits));
    }
  }
}

}  // namespace detail

template <class Sink>
void ColumnBlocks::forEach(std::size_t column, Sink sink) const {
  using detail::forEachNumber;
  const Place& place = places_[column];
  const Source& source = sources_[place.source];
  const char* const first = source.block.data() + place.offset;
  const auto run = [&]<class Bits, class Number>() {
    forEachNumber<Bits, Number>(first, source.stride, in_block_, place.type.big_endian, sink);
  };
  using Kind = NumberType::Kind;
  const bool is_signed = place.type.kind == Kind::Signed, is_real = place.type.kind == Kind::Real;
  switch (place.type.bytes) {
    case 1:
      return is_signed ? run.template operator()<std::uint8_t, std::int8_t>()
                       : run.template operator()<std::uint8_t, std::uint8_t>();
    case 2:
      return is_real     ? run.template operator()<std::uint16_t, void>()
             : is_signed ? run.template operator()<std::uint16_t, std::int16_t>()
                         : run.template operator()<std::uint16_t, std::uint16_t>();
    case 4:
      return is_real     ? run.template operator()<std::uint32_t, float>()
             : is_signed ? run.template operator()<std::uint32_t, std::int32_t>()
                         : run.template operator()<std::uint32_t, std::uint32_t>();
    default:
      return is_real     ? run.template operator()<std::uint64_t, double>()
             : is_signed ? run.template operator()<std::uint64_t, std::int64_t>()
                         : run.template operator()<std::uint64_t, std::uint64_t>();
  }
}

}  // namespace evical::numpy
