#include "core/recording/numpy/npy_header.h"

#include "core/base/error.h"
#include "core/recording/byte_cursor.h"
#include "core/recording/numpy/python_literal.h"

#include <fmt/format.h>

#include <charconv>
#include <limits>

namespace evical::numpy {
namespace {

constexpr std::size_t kLongestHeader_bytes = std::size_t{1} << 18;
constexpr std::size_t kLargestElement_bytes = std::size_t{1} << 16;
constexpr int kDeepestStructure = 8;  // structures within structures

class HeaderReader {
 public:
  HeaderReader(ByteStream& bytes, const std::string& place) : bytes_(bytes), place_(place) {}

  ArrayHeader run() {
    const Literal literal = readDictionary();
    const Literal *descr = literal.value("descr"), *shape = literal.value("shape"),
                  *order = literal.value("fortran_order");
    if (!descr || !shape || !order || shape->kind != Literal::Kind::List ||
        order->kind != Literal::Kind::Truth)
      fail("the array's header does not state type, order and shape");
    takeShape(*shape);
    header_.by_columns = order->truth;
    header_.element_bytes = addType(*descr, "", 0, 0);
    if (header_.element_bytes == 0) fail("the array's elements have no bytes");
    return header_;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw badInput(place_, problem, "Save the array again with numpy.save");
  }

  std::string take(std::size_t count) {
    std::string bytes(count, '\0');
    if (bytes_.read(bytes.data(), count) != count) fail("the array's header is cut off");
    header_.data_offset += count;
    return bytes;
  }

  Literal readDictionary() {
    const std::string start = take(kArrayMagic.size() + 2);
    if (!start.starts_with(kArrayMagic)) fail("this is not a NumPy array: its first bytes are different");
    const int version = static_cast<unsigned char>(start[kArrayMagic.size()]);
    if (version < 1 || version > 3)
      fail(fmt::format("the array has NumPy's format {}; only 1 to 3 can be read", version));
    const std::string sizes = take(version == 1 ? 2 : 4);
    ByteCursor cursor(sizes);
    const std::size_t size = version == 1 ? std::size_t{cursor.number<std::uint16_t>()}
                                          : std::size_t{cursor.number<std::uint32_t>()};
    if (size > kLongestHeader_bytes) fail(fmt::format("the array's header claims {} bytes", size));
    const std::optional<Literal> literal = parseLiteral(take(size));
    if (!literal) fail("the array's header is damaged");
    return *literal;
  }

  void takeShape(const Literal& shape) {
    std::uint64_t product = 1;
    for (const Literal& side : shape.items) {
      if (side.kind != Literal::Kind::Number || __builtin_mul_overflow(product, side.number, &product) ||
          product > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()))
        fail("the array's header claims an impossible shape");
      header_.shape.push_back(side.number);
    }
  }

  // Appends the fields of a type at `offset`; returns its size.
  std::size_t addType(const Literal& type, const std::string& name, std::size_t offset, int depth) {
    if (depth > kDeepestStructure) fail("the array's type is nested too deeply");
    if (type.kind == Literal::Kind::Text) return addPlain(type.text, name, offset);
    if (type.kind != Literal::Kind::List) fail("the array's type is unknown");
    std::size_t size = 0;
    for (const Literal& member : type.items) {
      size += addMember(member, offset + size, depth);
      if (size > kLargestElement_bytes) fail("the array's elements are too large");
    }
    return size;
  }

  // ("x", "<u2") or ("xy", "<u2", (2,)); the name may be (title, name), and is empty for padding.
  std::size_t addMember(const Literal& member, std::size_t offset, int depth) {
    const std::vector<Literal>& parts = member.items;
    if (member.kind != Literal::Kind::List || parts.size() < 2 || parts.size() > 3)
      fail("the array's type is unknown");
    const bool titled = parts[0].kind == Literal::Kind::List && parts[0].items.size() == 2;
    const std::string& name = titled ? parts[0].items[1].text : parts[0].text;
    const std::size_t first = header_.fields.size();
    const std::size_t size = addType(parts[1], name, offset, depth + 1);
    if (parts.size() == 2) return size;
    std::size_t count = 1;
    const std::vector<Literal> alone = {parts[2]};
    for (const Literal& side : parts[2].kind == Literal::Kind::List ? parts[2].items : alone) {
      if (side.kind != Literal::Kind::Number || __builtin_mul_overflow(count, side.number, &count) ||
          count > kLargestElement_bytes)
        fail("the array's type is unknown");
    }
    for (std::size_t i = first; i < header_.fields.size(); ++i) header_.fields[i].count = count;
    return size * count;
  }

  // "<u2", "|b1", "<M8[us]", "|V3", "|O".
  std::size_t addPlain(const std::string& text, const std::string& name, std::size_t offset) {
    const bool ordered =
        !text.empty() && std::string_view("<>=|").find(text.front()) != std::string_view::npos;
    const std::string_view kind = std::string_view(text).substr(ordered ? 1 : 0);
    if (kind.empty()) fail("the array's type is unknown");
    Field field{name, std::nullopt, offset, 1};
    std::size_t size = 0;
    const char* const end = kind.data() + kind.size();
    const auto [behind, error] = std::from_chars(kind.data() + 1, end, size);
    if (kind.front() == 'O') {
      header_.objects = true;
      size = sizeof(std::int64_t);
    } else if (kind.front() == '?') {
      size = 1;
    } else if (error != std::errc() || size > kLargestElement_bytes) {
      fail(fmt::format("the array's type \"{}\" is unknown", text));
    }
    if (kind.front() == 'U') size *= 4;  // its letters have four bytes
    field.type = numberType(kind.front(), size, {behind, end});
    if (field.type) field.type->big_endian = text.front() == '>';
    header_.fields.push_back(std::move(field));
    return size;
  }

  static std::optional<NumberType> numberType(char kind, std::size_t size, std::string_view unit) {
    using Kind = NumberType::Kind;
    NumberType type;
    type.bytes = static_cast<int>(size);
    const bool has_size = size == 1 || size == 2 || size == 4 || size == 8;
    if (!has_size) return std::nullopt;
    switch (kind) {
      case '?':
      case 'b':
        type.kind = Kind::Truth;
        return size == 1 ? std::optional(type) : std::nullopt;
      case 'i':
        type.kind = Kind::Signed;
        return type;
      case 'u':
        type.kind = Kind::Unsigned;
        return type;
      case 'f':
        type.kind = Kind::Real;
        return size > 1 ? std::optional(type) : std::nullopt;
      case 'M':
      case 'm':
        type.unit_ns = unit == "[ns]"   ? 1
                       : unit == "[us]" ? 1000
                       : unit == "[ms]" ? 1'000'000
                       : unit == "[s]"  ? 1'000'000'000
                                        : 0;
        return size == 8 && type.unit_ns > 0 ? std::optional(type) : std::nullopt;
      default:
        return std::nullopt;
    }
  }

  ByteStream& bytes_;
  const std::string& place_;
  ArrayHeader header_;
};

}  // namespace

std::uint64_t ArrayHeader::elements() const {
  std::uint64_t product = 1;
  for (const std::uint64_t side : shape) product *= side;
  return product;
}

ArrayHeader readArrayHeader(ByteStream& bytes, const std::string& place) {
  return HeaderReader(bytes, place).run();
}

}  // namespace evical::numpy
