// The few kinds of Python literals in headers of NumPy arrays.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace evical::numpy {

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
