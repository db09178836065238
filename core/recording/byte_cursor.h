// Little-endian numbers and strings out of untrusted bytes: no read goes past the end; a failed one makes
// ok() false permanently and yields zeros.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace evical {

static_assert(std::endian::native == std::endian::little,
              "the readers copy little-endian numbers without conversion");

class ByteCursor {
 public:
  ByteCursor() = default;
  explicit ByteCursor(std::string_view bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  bool atEnd() const { return position_ == bytes_.size(); }
  std::size_t position() const { return position_; }
  std::size_t remaining() const { return bytes_.size() - position_; }

  std::string_view take(std::uint64_t count) {
    if (!ok_ || count > remaining()) {
      ok_ = false;
      return {};
    }
    const std::string_view taken = bytes_.substr(position_, static_cast<std::size_t>(count));
    position_ += taken.size();
    return taken;
  }

  template <class Number>
  Number number() {
    Number value{};
    const std::string_view taken = take(sizeof(Number));
    if (!taken.empty()) std::memcpy(&value, taken.data(), sizeof(Number));
    return value;
  }

  // u32 length and that many bytes.
  std::string_view sized() { return take(number<std::uint32_t>()); }

 private:
  std::string_view bytes_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

}  // namespace evical
