// Strict YAML reader: every error has file, key and line; an unknown key is an error that suggests the
// nearest known one. Hides yaml-cpp.
#pragma once

#include "core/base/error.h"

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace evical {

// A place in a YAML document. Cheap to copy. All methods throw CalibrationError (BadInput).
class YamlNode {
 public:
  static YamlNode load(const std::filesystem::path& file);
  static YamlNode parse(const std::string& text, const std::string& file);

  bool isMap() const;
  bool isSequence() const;
  bool isScalar() const;
  bool isNull() const;
  bool isQuoted() const;  // a value in quotes, which is a text even if it looks like a number

  // Maps. All throw if this is not a map, or if a key occurs twice; keys() also if one has a control
  // character.
  std::vector<std::string> keys() const;
  void allowOnly(std::initializer_list<const char*> known) const;
  void allowOnly(const std::vector<std::string>& known) const;
  bool has(const std::string& key) const;
  YamlNode operator[](const std::string& key) const;  // throws if it is missing
  std::optional<YamlNode> find(const std::string& key) const;

  // Sequences
  std::vector<YamlNode> items() const;

  // Values
  std::string text() const;     // throws if it has a control character (plain_text.h)
  std::string anyText() const;  // for paths, and for texts that are shown only
  double real() const;          // finite
  double real(double minimum, double maximum, const char* unit) const;
  int integer(int minimum, int maximum) const;
  std::int64_t nanoseconds() const;  // any integer
  std::vector<double> reals() const;
  std::vector<double> reals(std::size_t count) const;
  std::size_t choice(std::initializer_list<const char*> words) const;
  std::size_t choice(std::span<const char* const> words) const;

  const std::string& key() const { return key_; }  // "board.rows"
  std::string place() const;                       // "session.yaml: board.rows (line 5)"
  CalibrationError error(std::string problem, std::string advice = {}) const;

 private:
  struct Entry;  // a value and its line; wraps YAML::Node
  struct Node;   // an entry with those of a map by their keys
  YamlNode(std::shared_ptr<const Node> node, std::string file, std::string key);
  YamlNode child(const std::string& name, const Entry& entry) const;
  const Entry* entry(const std::string& name) const;  // null if it is missing

  std::shared_ptr<const Node> node_;
  std::string file_, key_;
};

// A string as a YAML scalar, in double quotes if necessary.
std::string yamlText(std::string_view text);
// The same of a text for people, whose control characters are written visibly, so that text() accepts it.
std::string yamlLine(std::string_view text);

}  // namespace evical
