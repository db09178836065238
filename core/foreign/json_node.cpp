#include "core/foreign/json_node.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/foreign/read_numbers.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>

namespace evical {
namespace {

// Characters of a document; counts its lines while it is read.
struct CountedText {
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  const char* at;
  int* line;

  reference operator*() const { return *at; }
  CountedText& operator++() {
    *line += *at == '\n' ? 1 : 0;
    ++at;
    return *this;
  }
  bool operator==(const CountedText& other) const { return at == other.at; }
};

// The library keeps the last of two values of one key, and has no limits of memory and time.
class JsonChecks {
 public:
  JsonChecks(std::string file, const int& line) : file_(std::move(file)), line_(line) {}

  template <class Json>
  bool operator()(int depth, nlohmann::detail::parse_event_t event, const Json& parsed) {
    using Event = nlohmann::detail::parse_event_t;
    constexpr int kDeepest = 100;
    constexpr std::size_t kMaxValues = 1'000'000, kMaxKeys = 1000;
    if (depth > kDeepest) refuse("is nested too deeply");
    if (++values_ > kMaxValues) refuse("has too many values");
    if (event == Event::object_start) keys_.emplace_back();
    if (event == Event::object_end) keys_.pop_back();
    if (event != Event::key) return true;
    const auto [first, is_new] = keys_.back().emplace(parsed.template get<std::string>(), line_);
    if (!is_new)
      refuse(fmt::format("{} occurs twice, first in line {}", first->first, first->second),
             "Remove one of them");
    if (keys_.back().size() > kMaxKeys) refuse("has too many keys in one object");
    return true;
  }

 private:
  [[noreturn]] void refuse(const std::string& problem,
                           const char* advice = "Check that it is the right file") const {
    throw badInput(fmt::format("{} (line {})", file_, line_), problem, advice);
  }

  std::string file_;
  const int& line_;
  std::vector<std::map<std::string, int>> keys_;  // of the objects that are open, with their lines
  std::size_t values_ = 0;
};

}  // namespace

JsonNode::JsonNode(std::shared_ptr<const Json> document, const Json* value, std::string file, std::string key)
    : document_(std::move(document)), value_(value), file_(std::move(file)), key_(std::move(key)) {}

JsonNode JsonNode::load(const std::filesystem::path& file) {
  try {
    const std::string text = textOf(file);
    int line = 1;
    const CountedText begin{text.data(), &line}, end{text.data() + text.size(), &line};
    const auto document =
        std::make_shared<const Json>(Json::parse(begin, end, JsonChecks(file.string(), line)));
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
