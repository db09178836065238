#include "core/recording/ros/message_layout.h"

#include "core/base/trimmed.h"

#include <array>
#include <map>
#include <vector>

namespace evical::ros {
namespace {

constexpr int kDeepestNesting = 8;            // of types; ends recursive definitions
constexpr std::size_t kLongestLayout = 8192;  // characters; limits nested definitions

struct FieldLine {
  std::string_view type, array, name;  // array: "", "[]" or "[9]"
};
// By the last part of a type's name; "" for the message itself.
using TypeTable = std::map<std::string_view, std::vector<FieldLine>>;

// "float64[9] name # comment" is a field; "uint8 LIMIT=3" a constant, which is not serialised.
bool parseFieldLine(std::string_view line, FieldLine& field) {
  line = trimmed(line.substr(0, line.find('#')));
  const std::size_t blank = line.find_first_of(" \t");
  if (blank == std::string_view::npos || line.find('=') != std::string_view::npos) return false;
  field.name = trimmed(line.substr(blank));
  const std::string_view type = line.substr(0, blank);
  const std::size_t bracket = type.find('[');
  field.array = bracket == std::string_view::npos ? std::string_view() : type.substr(bracket);
  field.type = lastPart(type.substr(0, bracket));
  return true;
}

TypeTable parseDefinition(std::string_view definition) {
  TypeTable types;
  std::string_view current;
  types[current];
  while (!definition.empty()) {
    const std::size_t end = definition.find('\n');
    const std::string_view line = trimmed(definition.substr(0, end));
    definition = end == std::string_view::npos ? std::string_view() : definition.substr(end + 1);
    FieldLine field;
    if (line.starts_with("MSG:")) {
      current = lastPart(trimmed(line.substr(4)));
      types[current];
    } else if (parseFieldLine(line, field)) {
      types[current].push_back(field);
    }
  }
  return types;
}

// Empty except for built-in types.
std::string_view builtIn(std::string_view type) {
  if (type == "bool" || type == "byte" || type == "char") return "uint8";  // one byte, all of them
  constexpr std::array<std::string_view, 13> kKnown = {"uint8",  "int8",   "uint16",  "int16",   "uint32",
                                                       "int32",  "uint64", "int64",   "float32", "float64",
                                                       "string", "time",   "duration"};
  for (const std::string_view name : kKnown)
    if (type == name) return name;
  return {};
}

bool appendLayout(const TypeTable& types, std::string_view type, int depth, std::string& layout) {
  const auto entry = types.find(type);
  if (entry == types.end() || depth > kDeepestNesting) return false;
  for (const FieldLine& field : entry->second) {
    if (layout.size() > kLongestLayout) return false;
    if (const std::string_view simple = builtIn(field.type); !simple.empty()) {
      layout.append(simple);
    } else {
      layout += '(';
      if (!appendLayout(types, field.type, depth + 1, layout)) return false;
      layout += ')';
    }
    layout.append(field.array).append(" ").append(field.name).append(",");
  }
  return true;
}

}  // namespace

std::optional<std::string> messageLayout(std::string_view definition) {
  std::string layout;
  if (!appendLayout(parseDefinition(definition), "", 0, layout)) return std::nullopt;
  return layout;
}

}  // namespace evical::ros
