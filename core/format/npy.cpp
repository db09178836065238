#include "core/format/npy.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>

namespace evical {
namespace {

template <class Number>
void append(std::string& bytes, Number number) {
  static_assert(std::endian::native == std::endian::little);
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof(Number));
  bytes.append(raw, sizeof(Number));
}

// The header is padded so that the numbers begin at a multiple of 64 bytes.
std::string npy(const std::string& type, const std::string& shape, const std::string& numbers) {
  constexpr std::size_t kAlignment = 64, kPrefix = 10;
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", type, shape);
  const std::size_t used = kPrefix + header.size() + 1;
  header.append((kAlignment - used % kAlignment) % kAlignment, ' ');
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  append(bytes, static_cast<std::uint16_t>(header.size()));
  return bytes + header + numbers;
}

template <class Numbers>
std::string bytesOf(const Numbers& numbers) {
  std::string bytes;
  for (const auto number : numbers) append(bytes, number);
  return bytes;
}

// Code points; invalid UTF-8 becomes a replacement character, as in Python.
std::u32string codePoints(const std::string& text) {
  std::u32string points;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    const int more = first < 0x80 ? 0 : first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : first >= 0xC0 ? 1 : -1;
    char32_t point = more <= 0 ? first : first & (0x3FU >> more);
    bool whole = more >= 0;
    for (int k = 0; k < more && whole; ++k) {
      whole = i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80;
      if (whole) point = point << 6 | (static_cast<unsigned char>(text[i++]) & 0x3FU);
    }
    points += whole && point <= 0x10FFFF ? point : U'\uFFFD';
  }
  return points;
}

// NumPy's str arrays are UTF-32, padded to the longest text.
std::string npyTexts(const std::vector<std::string>& texts, const std::string& shape) {
  std::vector<std::u32string> all;
  std::size_t longest = 1;
  for (const std::string& text : texts)
    longest = std::max(longest, all.emplace_back(codePoints(text)).size());
  std::string bytes;
  for (std::u32string& text : all) {
    text.resize(longest, U'\0');
    bytes += bytesOf(text);
  }
  return npy(fmt::format("<U{}", longest), shape, bytes);
}

struct ZipEntry {
  std::string name;
  std::uint32_t crc, size, place;
};

// Common part of a file's own header and its entry in the directory: from the required version to the name's
// length.
void appendCommon(std::string& bytes, const ZipEntry& entry) {
  constexpr std::uint16_t kVersion = 20, kNoFlags = 0, kStored = 0, kMidnight = 0, kFirstOf1980 = 0x21;
  for (const std::uint16_t field : {kVersion, kNoFlags, kStored, kMidnight, kFirstOf1980})
    append(bytes, field);
  append(bytes, entry.crc);
  append(bytes, entry.size);
  append(bytes, entry.size);
  append(bytes, static_cast<std::uint16_t>(entry.name.size()));
}

std::string directoryEntry(const ZipEntry& entry) {
  std::string bytes = "PK\x01\x02";
  append(bytes, std::uint16_t{20});
  appendCommon(bytes, entry);
  bytes.append(12, '\0');  // no extra field, no comment, disk 0, no attributes
  append(bytes, entry.place);
  return bytes + entry.name;
}

}  // namespace

std::string npyMatrix(const Eigen::MatrixXd& matrix) {
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = matrix;
  return npy("<f8", fmt::format("({}, {})", rows.rows(), rows.cols()),
             bytesOf(std::span(rows.data(), static_cast<std::size_t>(rows.size()))));
}

std::string npyList(std::span<const double> numbers) {
  return npy("<f8", fmt::format("({},)", numbers.size()), bytesOf(numbers));
}

std::string npyList(std::span<const std::int64_t> numbers) {
  return npy("<i8", fmt::format("({},)", numbers.size()), bytesOf(numbers));
}

std::string npyList(const std::vector<std::string>& texts) {
  return npyTexts(texts, fmt::format("({},)", texts.size()));
}

std::string npyNumber(double number) {
  return npy("<f8", "()", bytesOf(std::span(&number, 1)));
}

std::string npyText(const std::string& text) {
  return npyTexts({text}, "()");
}

std::string npz(std::span<const NpzArray> arrays) {
  std::string bytes, directory;
  for (const NpzArray& array : arrays) {
    const ZipEntry entry{array.name + ".npy",
                         static_cast<std::uint32_t>(
                             crc32_z(0, reinterpret_cast<const Bytef*>(array.npy.data()), array.npy.size())),
                         static_cast<std::uint32_t>(array.npy.size()),
                         static_cast<std::uint32_t>(bytes.size())};
    bytes += "PK\x03\x04";
    appendCommon(bytes, entry);
    append(bytes, std::uint16_t{0});  // no extra field
    bytes += entry.name + array.npy;
    directory += directoryEntry(entry);
  }
  const auto place = static_cast<std::uint32_t>(bytes.size()),
             size = static_cast<std::uint32_t>(directory.size());
  const auto count = static_cast<std::uint16_t>(arrays.size());
  bytes += directory + "PK\x05\x06";
  for (const std::uint16_t field : {std::uint16_t{0}, std::uint16_t{0}, count, count}) append(bytes, field);
  append(bytes, size);
  append(bytes, place);
  append(bytes, std::uint16_t{0});  // no comment
  return bytes;
}

}  // namespace evical
