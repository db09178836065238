// Google's FlatBuffers, parsed without a library from untrusted bytes: size prefix, offset of the root table,
// four letters that name the type, tables. Nothing is read past the end; any failure makes ok() false
// permanently and yields zeros. Fields that equal their default are absent. Source: flatbuffers.dev,
// "Internals".
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace evical::aedat {

struct FlatTable {
  std::size_t position = 0;  // in the buffer
  std::size_t vtable = 0;
  std::size_t fields = 0;
};

struct FlatVector {
  std::size_t position = 0;  // of the first element
  std::size_t count = 0;
};

class FlatBuffer {
 public:
  explicit FlatBuffer(std::string_view bytes);  // with the size prefix

  bool ok() const { return ok_; }
  std::string_view identifier() const { return identifier_; }
  const char* data() const { return bytes_.data(); }  // origin of positions

  FlatTable root() { return tableAt(0); }
  FlatTable tableAt(std::size_t position);  // position of the offset to the table

  // Position of a field of `size` bytes; 0 if it is absent.
  std::size_t field(const FlatTable& table, std::size_t index, std::size_t size);

  template <class Number>
  Number number(const FlatTable& table, std::size_t index, Number absent = {}) {
    const std::size_t position = field(table, index, sizeof(Number));
    return position == 0 ? absent : read<Number>(position);
  }
  FlatVector vector(const FlatTable& table, std::size_t index, std::size_t element_bytes);
  std::string_view text(const FlatTable& table, std::size_t index);

  template <class Number>
  Number read(std::size_t position) {
    Number value{};
    if (position > bytes_.size() || bytes_.size() - position < sizeof(Number)) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, bytes_.data() + position, sizeof(Number));
    return value;
  }

 private:
  std::string_view bytes_;  // after the size prefix
  std::string_view identifier_;
  bool ok_ = false;
};

}  // namespace evical::aedat
