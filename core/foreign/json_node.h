// JSON with the file and key in its error messages.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace evical {

// A value in a document. All methods throw CalibrationError (BadInput) if the key is missing or of another
// type.
class JsonNode {
 public:
  static JsonNode load(const std::filesystem::path& file);

  bool has(const std::string& key) const;
  JsonNode operator[](const std::string& key) const;
  std::vector<JsonNode> items() const;                            // of a list
  std::vector<std::pair<std::string, JsonNode>> entries() const;  // of an object, in the file's order

  // Values as in rapidjson, where a text is not a number.
  double number() const;
  std::int64_t integer() const;
  std::string text() const;
  std::vector<double> numbers(std::size_t count) const;

  // Values as in boost's property tree, where every value is a text.
  std::string treeText() const;
  double treeNumber() const;
  std::int64_t treeInteger() const;
  std::vector<double> treeNumbers(std::size_t count) const;

  std::string place() const;  // "calibration.json: cameras.C0.name"
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  using Json = nlohmann::ordered_json;
  JsonNode(std::shared_ptr<const Json> document, const Json* value, std::string file, std::string key);
  JsonNode child(const Json& value, const std::string& name) const;

  std::shared_ptr<const Json> document_;
  const Json* value_;
  std::string file_, key_;
};

}  // namespace evical
