#include "core/recording/numpy/python_literal.h"

#include <algorithm>
#include <charconv>

namespace evical::numpy {
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
