// Writes .npy and .npz files like NumPy, or with false headers: for tests, the benchmark of formats, and
// fuzzing.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace evical::test {

template <class Number>
std::string rawNumber(Number number, bool big_endian = false) {
  std::string bytes(reinterpret_cast<const char*>(&number), sizeof number);
  return big_endian ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

// `header` is the text of the dictionary; version 1 has its length in two bytes, 2 and 3 in four.
inline std::string npyFile(const std::string& header, const std::string& data, int version = 1) {
  const std::size_t length_bytes = version == 1 ? 2 : 4, start = 8 + length_bytes;
  const std::size_t size = (start + header.size() + 1 + 63) / 64 * 64 - start;
  std::string bytes = "\x93NUMPY";
  bytes += static_cast<char>(version);
  bytes += '\0';
  bytes += rawNumber(static_cast<std::uint32_t>(size)).substr(0, length_bytes);
  return bytes + header + std::string(size - header.size() - 1, ' ') + '\n' + data;
}

// `descr` in Python's notation: "'<u2'" or "[('x', '<u2'), ...]".
inline std::string npyHeader(const std::string& descr, const std::string& shape, bool by_columns = false) {
  return "{'descr': " + descr + ", 'fortran_order': " + (by_columns ? "True" : "False") +
         ", 'shape': " + shape + ", }";
}

inline std::string npyArray(const std::string& descr, const std::string& shape, const std::string& data,
                            bool by_columns = false) {
  return npyFile(npyHeader(descr, shape, by_columns), data);
}

struct ZipFile {
  std::string name, content;
  bool deflated = false, in_64 = false;  // sizes in zip64's fields
  // Sizes stated in the archive; 0: the true ones.
  std::uint64_t claimed_bytes = 0;
  std::uint32_t claimed_checksum = 0;
  std::size_t left_out_bytes = 0;  // of the packed bytes, at the end
};

inline std::string deflated(const std::string& content) {
  z_stream state{};
  deflateInit2(&state, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&state, static_cast<uLong>(content.size())), '\0');
  std::string copy = content;
  state.next_in = reinterpret_cast<Bytef*>(copy.data());
  state.avail_in = static_cast<uInt>(copy.size());
  state.next_out = reinterpret_cast<Bytef*>(packed.data());
  state.avail_out = static_cast<uInt>(packed.size());
  deflate(&state, Z_FINISH);
  packed.resize(state.total_out);
  deflateEnd(&state);
  return packed;
}

// With a comment behind it, as archives may have.
inline std::string zipArchive(const std::vector<ZipFile>& files, bool end_in_64 = false,
                              const std::string& comment = {}) {
  const auto word16 = [](std::uint64_t value) { return rawNumber(static_cast<std::uint16_t>(value)); };
  const auto word32 = [](std::uint64_t value) { return rawNumber(static_cast<std::uint32_t>(value)); };
  const auto word64 = [](std::uint64_t value) { return rawNumber(value); };
  std::string bytes, directory;
  for (const ZipFile& file : files) {
    std::string packed = file.deflated ? deflated(file.content) : file.content;
    packed.resize(packed.size() - file.left_out_bytes);
    const std::uint64_t size = file.claimed_bytes > 0 ? file.claimed_bytes : file.content.size();
    const std::uint32_t checksum =
        file.claimed_checksum > 0
            ? file.claimed_checksum
            : static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(file.content.data()),
                                               static_cast<uInt>(file.content.size())));
    const std::uint64_t at = bytes.size(), all = 0xFFFFFFFF;
    const std::string common = word16(0) + word16(file.deflated ? 8 : 0) + word32(0x21 << 16) +
                               word32(checksum) + word32(file.in_64 ? all : packed.size()) +
                               word32(file.in_64 ? all : size) + word16(file.name.size());
    const std::string local_64 =
        file.in_64 ? word16(1) + word16(16) + word64(size) + word64(packed.size()) : "";
    const std::string entry_64 =
        file.in_64 ? word16(1) + word16(24) + word64(size) + word64(packed.size()) + word64(at) : "";
    bytes += "PK\3\4" + word16(45) + common + word16(local_64.size()) + file.name + local_64 + packed;
    directory += "PK\1\2" + word16(45) + word16(45) + common + word16(entry_64.size()) + word16(0) +
                 word16(0) + word16(0) + word32(0) + word32(file.in_64 ? all : at) + file.name + entry_64;
  }
  const std::uint64_t directory_at = bytes.size();
  bytes += directory;
  if (end_in_64) {
    const std::uint64_t end_at = bytes.size();
    bytes += "PK\6\6" + word64(44) + word16(45) + word16(45) + word32(0) + word32(0) + word64(files.size()) +
             word64(files.size()) + word64(directory.size()) + word64(directory_at);
    bytes += "PK\6\7" + word32(0) + word64(end_at) + word32(1);
  }
  bytes += "PK\5\6" + word16(0) + word16(0) + word16(end_in_64 ? 0xFFFF : files.size()) +
           word16(end_in_64 ? 0xFFFF : files.size()) + word32(directory.size()) +
           word32(end_in_64 ? 0xFFFFFFFF : directory_at) + word16(comment.size()) + comment;
  return bytes;
}

}  // namespace evical::test
