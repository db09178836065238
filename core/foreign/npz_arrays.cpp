#include "core/foreign/npz_arrays.h"

#include "core/base/error.h"
#include "core/foreign/read_numbers.h"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>

namespace evical {
namespace {

CalibrationError npzArraysBroken(const std::string& place, const std::string& what) {
  return badInput(place, what, "Export again");
}

template <class Number>
Number numberAt(const std::string& bytes, std::size_t at, const std::string& place) {
  static_assert(std::endian::native == std::endian::little);
  if (at > bytes.size() || bytes.size() - at < sizeof(Number)) throw npzArraysBroken(place, "ends too early");
  Number number = 0;
  std::memcpy(&number, bytes.data() + at, sizeof(Number));
  return number;
}

std::string piece(const std::string& bytes, std::size_t at, std::size_t size, const std::string& place) {
  if (at > bytes.size() || bytes.size() - at < size) throw npzArraysBroken(place, "ends too early");
  return bytes.substr(at, size);
}

// One file in the archive's directory, and the position of the next entry.
struct ArchivedArray {
  std::string name, content;
  std::size_t next;
};

ArchivedArray entryAt(const std::string& zip, std::size_t at, const std::string& place) {
  if (piece(zip, at, 4, place) != "PK\x01\x02") throw npzArraysBroken(place, "its directory is damaged");
  const auto compression = numberAt<std::uint16_t>(zip, at + 10, place);
  const std::size_t size = numberAt<std::uint32_t>(zip, at + 24, place),
                    length = numberAt<std::uint16_t>(zip, at + 28, place),
                    extra = std::size_t{numberAt<std::uint16_t>(zip, at + 30, place)} +
                            numberAt<std::uint16_t>(zip, at + 32, place),
                    own = numberAt<std::uint32_t>(zip, at + 42, place);
  ArchivedArray entry{piece(zip, at + 46, length, place), {}, at + 46 + length + extra};
  const std::string inside = place + ": " + entry.name;
  if (compression != 0) throw npzArraysBroken(inside, "is compressed");
  // Both headers must agree, as Python's zipfile requires for names.
  if (piece(zip, own, 4, inside) != "PK\x03\x04" ||
      piece(zip, own + 6, 22, inside) != piece(zip, at + 8, 22, inside) ||
      piece(zip, own + 30, length, inside) != entry.name)
    throw npzArraysBroken(inside, "is not at the position in the directory");
  entry.content =
      piece(zip, own + 30 + length + numberAt<std::uint16_t>(zip, own + 28, inside), size, inside);
  const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(entry.content.data()), entry.content.size());
  if (crc != numberAt<std::uint32_t>(zip, at + 16, inside))
    throw npzArraysBroken(inside, "its checksum is wrong");
  return entry;
}

// Value of a key in the header's dict, up to `end`.
std::string valueOf(const std::string& header, const std::string& key, char end, const std::string& place) {
  const std::size_t found = header.find("'" + key + "': ");
  const std::size_t begin = found + key.size() + 4;
  const std::size_t stop = found == std::string::npos ? found : header.find(end, begin);
  if (stop == std::string::npos) throw npzArraysBroken(place, fmt::format("its header has no {}", key));
  return header.substr(begin, stop - begin);
}

std::vector<std::size_t> shapeOf(const std::string& text, const std::string& place) {
  std::vector<std::size_t> shape;
  for (std::size_t at = text.find_first_of("0123456789"); at != std::string::npos;
       at = text.find_first_of("0123456789", at)) {
    std::size_t size = 0;
    const auto end = std::from_chars(text.data() + at, text.data() + text.size(), size);
    constexpr std::size_t kMax = 100'000;  // limits the size that a file claims
    if (end.ec != std::errc{} || size > kMax) throw npzArraysBroken(place, "is too large for a calibration");
    shape.push_back(size);
    at = static_cast<std::size_t>(end.ptr - text.data());
  }
  return shape;
}

std::string utf8Of(const std::string& utf32, const std::string& place) {
  std::string text;
  for (std::size_t at = 0; at < utf32.size(); at += 4) {
    const auto point = numberAt<std::uint32_t>(utf32, at, place);
    const auto add = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
    if (point == 0) break;
    if (point > 0x10FFFF) throw npzArraysBroken(place, "is not a text");
    if (point < 0x80) {
      add(point);
    } else if (point < 0x800) {
      add(0xC0 | point >> 6);
      add(0x80 | (point & 0x3F));
    } else {
      if (point < 0x10000) {
        add(0xE0 | point >> 12);
      } else {
        add(0xF0 | point >> 18);
        add(0x80 | (point >> 12 & 0x3F));
      }
      add(0x80 | (point >> 6 & 0x3F));
      add(0x80 | (point & 0x3F));
    }
  }
  return text;
}

// Bytes of one element: 8 for numbers, 4 per letter for texts.
std::size_t widthOf(const std::string& type, const std::string& place) {
  if (type == "'<f8'" || type == "'<i8'") return 8;
  std::size_t letters = 0;
  if (type.starts_with("'<U") && type.ends_with("'"))
    std::from_chars(type.data() + 3, type.data() + type.size() - 1, letters);
  if (letters == 0 || letters > 100'000) throw npzArraysBroken(place, fmt::format("has the type {}", type));
  return 4 * letters;
}

}  // namespace

NpzArrays::Array NpzArrays::arrayOf(const std::string& npy, const std::string& place) {
  if (piece(npy, 0, 8, place) != std::string("\x93NUMPY\x01\x00", 8))
    throw npzArraysBroken(place, "is not an .npy file of version 1");
  const std::size_t begin = 10 + std::size_t{numberAt<std::uint16_t>(npy, 8, place)};
  const std::string header = piece(npy, 10, begin - 10, place);
  if (valueOf(header, "fortran_order", ',', place) != "False")
    throw npzArraysBroken(place, "is in Fortran order");
  const std::string type = valueOf(header, "descr", ',', place);
  const std::size_t width = widthOf(type, place);
  Array array{type[2] == 'U', shapeOf(valueOf(header, "shape", ')', place), place)};
  std::size_t count = 1;
  for (const std::size_t size : array.shape) {
    count *= size;
    if (count > npy.size()) throw npzArraysBroken(place, "ends too early");
  }
  if (npy.size() - begin != count * width)
    throw npzArraysBroken(place, "does not have the length in its header");
  for (std::size_t at = begin; at < npy.size(); at += width) {
    if (array.is_text)
      array.texts.push_back(utf8Of(npy.substr(at, width), place));
    else
      array.numbers.push_back(type == "'<i8'" ? static_cast<double>(numberAt<std::int64_t>(npy, at, place))
                                              : numberAt<double>(npy, at, place));
  }
  return array;
}

NpzArrays NpzArrays::load(const std::filesystem::path& file) {
  NpzArrays loaded;
  loaded.file_ = file.string();
  const std::string zip = textOf(file);
  const std::size_t end = zip.rfind("PK\x05\x06");
  if (end == std::string::npos) throw npzArraysBroken(loaded.file_, "is not an .npz file, or is cut off");
  std::size_t at = numberAt<std::uint32_t>(zip, end + 16, loaded.file_);
  for (int left = numberAt<std::uint16_t>(zip, end + 10, loaded.file_); left > 0; --left) {
    const ArchivedArray entry = entryAt(zip, at, loaded.file_);
    const std::string inside = loaded.place(entry.name);
    if (!entry.name.ends_with(".npy")) throw npzArraysBroken(inside, "is not an array");
    const std::string name = entry.name.substr(0, entry.name.size() - 4);
    if (!loaded.arrays_.emplace(name, arrayOf(entry.content, inside)).second)
      throw npzArraysBroken(inside, "occurs twice");
    at = entry.next;
  }
  if (at != end) throw npzArraysBroken(loaded.file_, "its directory is damaged");
  return loaded;
}

const NpzArrays::Array& NpzArrays::get(const std::string& name, bool is_text, std::size_t dimensions) const {
  const auto found = arrays_.find(name);
  if (found == arrays_.end()) throw npzArraysBroken(place(name), "is missing");
  if (found->second.is_text != is_text || found->second.shape.size() != dimensions)
    throw npzArraysBroken(place(name), "has another type or shape");
  return found->second;
}

double NpzArrays::number(const std::string& name) const {
  return get(name, false, 0).numbers[0];
}

std::vector<double> NpzArrays::numbers(const std::string& name) const {
  return get(name, false, 1).numbers;
}

Eigen::MatrixXd NpzArrays::matrix(const std::string& name, std::size_t rows, std::size_t cols) const {
  const Array& array = get(name, false, 2);
  if (array.shape[0] != rows || array.shape[1] != cols)
    throw npzArraysBroken(place(name), "has another shape");
  return matrixFrom(array.numbers, static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols));
}

std::string NpzArrays::text(const std::string& name) const {
  return get(name, true, 0).texts[0];
}

std::vector<std::string> NpzArrays::texts(const std::string& name) const {
  return get(name, true, 1).texts;
}

}  // namespace evical
