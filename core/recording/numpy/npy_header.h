// Header of a .npy file or member: the format of NumPy's numpy/lib/format.py, versions 1 to 3.
#pragma once

#include "core/recording/numpy/byte_stream.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical::numpy {

inline constexpr std::string_view kArrayMagic = "\x93NUMPY";

struct NumberType {
  enum class Kind { Truth, Signed, Unsigned, Real };
  Kind kind = Kind::Signed;
  int bytes = 1;  // 1, 2, 4, 8; real numbers 2, 4, 8
  bool big_endian = false;
  std::int64_t unit_ns = 0;  // of NumPy's dates and time spans; 0: none
};

// Field of each element.
struct Field {
  std::string name;                // empty if elements are plain numbers
  std::optional<NumberType> type;  // nullopt: cannot be read
  std::size_t offset = 0;          // in the element
  std::size_t count = 1;           // a list of numbers
};

struct ArrayHeader {
  std::vector<Field> fields;
  std::size_t element_bytes = 0;     // never 0
  std::vector<std::uint64_t> shape;  // as claimed; the product is below 2^63
  bool by_columns = false;           // the first index varies fastest
  bool objects = false;              // pickled Python objects
  std::uint64_t data_offset = 0;     // after the header

  std::uint64_t elements() const;
  bool isStructured() const { return fields.size() != 1 || !fields.front().name.empty(); }
};

// Throws CalibrationError (BadInput) at `place` if it is invalid or damaged.
ArrayHeader readArrayHeader(ByteStream& bytes, const std::string& place);

// The few kinds of Python literals in headers of NumPy arrays.
struct Literal {
  enum class Kind { None, Truth, Number, Text, List, Dictionary };
  Kind kind = Kind::None;
  bool truth = false;
  std::uint64_t number = 0;
  std::string text;
  std::vector<Literal> items;  // of lists and tuples; of dictionaries keys and values in turn

  const Literal* value(std::string_view key) const;  // of a dictionary; null if absent
};

// nullopt unless the text is a single literal, except for blanks around it. Numbers are whole and not
// negative.
std::optional<Literal> parseLiteral(std::string_view text);

}  // namespace evical::numpy
