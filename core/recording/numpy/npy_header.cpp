#include "core/recording/numpy/npy_header.h"

#include "core/base/error.h"
#include "core/recording/byte_cursor.h"

#include <fmt/format.h>

#include <algorithm>
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

namespace {

constexpr int kDeepestLiteral = 32;

class Parser {
 public:
  explicit Parser(std::string_view text) : rest_(text) {}

  bool parseAll(Literal& literal) {
    if (!parse(literal, 0)) return false;
    skipBlanks();
    return rest_.empty();
  }

 private:
  void skipBlanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size())); }

  bool take(char wanted) {
    skipBlanks();
    if (rest_.empty() || rest_.front() != wanted) return false;
    rest_.remove_prefix(1);
    return true;
  }

  bool take(std::string_view word) {
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }

  bool parse(Literal& literal, int depth) {
    skipBlanks();
    if (rest_.empty() || depth > kDeepestLiteral) return false;
    const char first = rest_.front();
    if (take('[')) return parseItems(literal, Literal::Kind::List, ']', depth);
    if (take('(')) return parseItems(literal, Literal::Kind::List, ')', depth);
    if (take('{')) return parseItems(literal, Literal::Kind::Dictionary, '}', depth);
    if (first >= '0' && first <= '9') return parseNumber(literal);
    if (take(std::string_view("None"))) return true;
    literal.kind = Literal::Kind::Truth;
    if (take(std::string_view("False"))) return true;
    literal.truth = true;
    if (take(std::string_view("True"))) return true;
    return parseText(literal);
  }

  bool parseItems(Literal& literal, Literal::Kind kind, char end, int depth) {
    literal.kind = kind;
    while (!take(end)) {
      if (!parse(literal.items.emplace_back(), depth + 1)) return false;
      if (kind == Literal::Kind::Dictionary &&
          (!take(':') || !parse(literal.items.emplace_back(), depth + 1)))
        return false;
      if (!take(',')) return take(end);
    }
    return true;
  }

  bool parseNumber(Literal& literal) {
    literal.kind = Literal::Kind::Number;
    const char* const end = rest_.data() + rest_.size();
    const auto [behind, error] = std::from_chars(rest_.data(), end, literal.number);
    if (error != std::errc()) return false;
    rest_.remove_prefix(static_cast<std::size_t>(behind - rest_.data()));
    if (rest_.starts_with('L')) rest_.remove_prefix(1);  // as Python 2 wrote them
    return true;
  }

  // In single or double quotes; a backslash keeps the next character.
  bool parseText(Literal& literal) {
    literal.kind = Literal::Kind::Text;
    if (rest_.size() > 1 && (rest_[0] == 'u' || rest_[0] == 'b') && (rest_[1] == '\'' || rest_[1] == '"'))
      rest_.remove_prefix(1);
    const char quote = rest_.front();
    if (quote != '\'' && quote != '"') return false;
    for (std::size_t i = 1; i < rest_.size(); ++i) {
      if (rest_[i] == quote) {
        rest_.remove_prefix(i + 1);
        return true;
      }
      if (rest_[i] == '\\' && ++i == rest_.size()) return false;
      literal.text.push_back(rest_[i]);
    }
    return false;
  }

  std::string_view rest_;
};

}  // namespace

const Literal* Literal::value(std::string_view key) const {
  if (kind != Kind::Dictionary) return nullptr;
  for (std::size_t i = 0; i + 1 < items.size(); i += 2)
    if (items[i].kind == Kind::Text && items[i].text == key) return &items[i + 1];
  return nullptr;
}

std::optional<Literal> parseLiteral(std::string_view text) {
  Literal literal;
  if (!Parser(text).parseAll(literal)) return std::nullopt;
  return literal;
}

}  // namespace evical::numpy
