#include "core/foreign/json_node.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/foreign/read_numbers.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace evical {

JsonNode::JsonNode(std::shared_ptr<const Json> document, const Json* value, std::string file, std::string key)
    : document_(std::move(document)), value_(value), file_(std::move(file)), key_(std::move(key)) {}

JsonNode JsonNode::load(const std::filesystem::path& file) {
  try {
    const auto document = std::make_shared<const Json>(Json::parse(textOf(file)));
    return {document, document.get(), file.string(), ""};
  } catch (const nlohmann::json::exception& error) {
    throw badInput(file.string(), "is not JSON: " + std::string(error.what()));
  }
}

JsonNode JsonNode::child(const Json& value, const std::string& name) const {
  const bool index = name.starts_with('[');
  return {document_, &value, file_, key_.empty() || index ? key_ + name : key_ + "." + name};
}

bool JsonNode::has(const std::string& key) const {
  return value_->is_object() && value_->contains(key);
}

JsonNode JsonNode::operator[](const std::string& key) const {
  if (!has(key)) throw badInput(child(*value_, key).place(), "is missing");
  return child((*value_)[key], key);
}

std::vector<JsonNode> JsonNode::items() const {
  if (!value_->is_array()) fail("must be a list");
  std::vector<JsonNode> all;
  for (const Json& item : *value_) all.push_back(child(item, fmt::format("[{}]", all.size())));
  return all;
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::entries() const {
  if (!value_->is_object()) fail("must be an object");
  std::vector<std::pair<std::string, JsonNode>> all;
  for (const auto& [key, value] : value_->items()) all.emplace_back(key, child(value, key));
  return all;
}

double JsonNode::number() const {
  if (!value_->is_number()) fail("must be a number");
  return value_->get<double>();
}

std::int64_t JsonNode::integer() const {
  if (!value_->is_number_integer()) fail("must be a whole number");
  return value_->get<std::int64_t>();
}

std::string JsonNode::text() const {
  if (!value_->is_string()) fail("must be a text");
  return value_->get<std::string>();
}

std::vector<double> JsonNode::numbers(std::size_t count) const {
  std::vector<double> values;
  for (const JsonNode& item : items()) values.push_back(item.number());
  if (values.size() != count) fail(fmt::format("has {} numbers, {} are needed", values.size(), count));
  return values;
}

std::string JsonNode::treeText() const {
  if (value_->is_structured()) fail("must be one value");
  return value_->is_string() ? value_->get<std::string>() : value_->dump();
}

double JsonNode::treeNumber() const {
  const std::string value = treeText();
  const std::optional<double> number = realFrom(value);
  if (!number) fail(fmt::format("'{}' is not a number", value));
  return *number;
}

std::int64_t JsonNode::treeInteger() const {
  const std::string value = treeText();
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (error != std::errc{} || end != value.data() + value.size())
    fail(fmt::format("'{}' is not a whole number", value));
  return number;
}

std::vector<double> JsonNode::treeNumbers(std::size_t count) const {
  std::vector<double> values;
  for (const JsonNode& item : items()) values.push_back(item.treeNumber());
  if (values.size() != count) fail(fmt::format("has {} numbers, {} are needed", values.size(), count));
  return values;
}

std::string JsonNode::place() const {
  return key_.empty() ? file_ : fmt::format("{}: {}", file_, key_);
}

void JsonNode::fail(const std::string& problem) const {
  throw badInput(place(), problem);
}

}  // namespace evical
