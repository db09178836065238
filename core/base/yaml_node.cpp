#include "core/base/yaml_node.h"

#include "core/base/file_places.h"
#include "core/base/how_to.h"
#include "core/base/nearest_name.h"
#include "core/base/option_table.h"
#include "core/base/plain_text.h"

#include <fmt/format.h>
#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <sstream>
#include <unordered_map>
#include <utility>

namespace evical {

struct YamlNode::Entry {
  YAML::Node yaml;
  int line = 0;  // from 1; 0 if unknown
};

struct YamlNode::Node : Entry {
  // Made when the first key is looked up, since yaml-cpp searches from the first one on.
  mutable std::optional<std::unordered_map<std::string, Entry>> entries = {};
};

YamlNode::YamlNode(std::shared_ptr<const Node> node, std::string file, std::string key)
    : node_(std::move(node)), file_(std::move(file)), key_(std::move(key)) {}

namespace {

// "Check the path", or the name of the file in this folder that was probably meant.
std::string adviceOnMissing(const std::filesystem::path& file) {
  std::vector<std::string> names;
  std::error_code error;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    names.push_back(entry.path().filename().string());
  for (const char* const ending : {".former.", ".part."})
    for (const std::string& name : names)
      if (name.starts_with(file.filename().string() + ending))
        return fmt::format(
            "A run was stopped while it replaced the file. '{}' may be the former one: rename it, or run "
            "again",
            name);
  const std::string nearest = nearestName(file.filename().string(), names);
  return nearest.empty() ? "Check the path" : fmt::format("Check the path. Did you mean '{}'?", nearest);
}

// Devices, pipes and files of a recording's size are rejected before they are read into memory.
void requireText(const std::filesystem::path& file) {
  constexpr std::uintmax_t kLargest_bytes = 64 << 20;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found)
    throw badInput(file.string(), "does not exist", adviceOnMissing(file));
  if (error) throw badInput(file.string(), "cannot be reached: " + error.message(), "Check its permissions");
  if (std::filesystem::is_directory(status)) throw badInput(file.string(), "is a folder, not a YAML file");
  if (!std::filesystem::is_regular_file(status))
    throw badInput(file.string(), "is a device or a pipe, not a YAML file", "Give a file");
  const std::uintmax_t size_bytes = std::filesystem::file_size(file, error);
  if (!error && size_bytes > kLargest_bytes)
    throw badInput(file.string(), fmt::format("has {} MB, too much for a YAML file", size_bytes >> 20),
                   "Check that it is not the recording itself. If there is no session yet: " +
                       howTo(HowTo::MakeSession));
}

// True if this line, or the one before it, is indented with a tab, which YAML does not allow.
bool hasTab(const std::string& text, int line) {
  std::istringstream stream(text);
  std::string each;
  for (int k = 0; k <= line && std::getline(stream, each); ++k)
    if (k + 1 >= line && each.find_first_not_of(" -") == each.find('\t') &&
        each.find('\t') != std::string::npos)
      return true;
  return false;
}

// yaml-cpp needs half a kilobyte and some microseconds for each value. Each one has a sign before or after
// it.
void requireFewValues(const std::string& text, const std::string& file) {
  constexpr std::ptrdiff_t kMax = 200'000;  // a correlation of 400 numbers has fewer
  const auto values =
      std::count_if(text.begin(), text.end(), [](char c) { return c == ',' || c == '\n' || c == '['; });
  if (values > kMax)
    throw badInput(file, fmt::format("has more than {} values, too many for a YAML file", kMax),
                   "Check that it is the right file");
}

// Tags of YAML itself, and those that programs add to them ("!!opencv-matrix"). Others ask the reader for an
// action, such as to include another file.
void requirePlain(const YAML::Node& node, const std::string& place) {
  const std::string& tag = node.Tag();
  if (tag.empty() || tag == "?" || tag == "!" || tag.starts_with("tag:yaml.org,2002:")) return;
  throw badInput(place, fmt::format("has the tag {}, which is not read", tag),
                 "Write the value itself; other files are not included");
}

}  // namespace

YamlNode YamlNode::load(const std::filesystem::path& file) {
  requireText(file);
  const std::string text = contentOfFile(file);
  if (text.empty())
    throw badInput(file.string(), "is empty or cannot be read", "Check the file and its permissions");
  return parse(text, file.string());
}

YamlNode YamlNode::parse(const std::string& text, const std::string& file) {
  requireFewValues(text, file);
  try {
    std::vector<YAML::Node> documents = YAML::LoadAll(text);
    std::erase_if(documents, [](const YAML::Node& document) { return document.IsNull(); });
    if (documents.size() > 1)
      throw badInput(file, fmt::format("has {} YAML documents, separated by ---", documents.size()),
                     "Keep one of them");
    return {std::make_shared<const Node>(Node{{documents.empty() ? YAML::Node() : documents.front(), 1}}),
            file, ""};
  } catch (const YAML::DeepRecursion& problem) {
    throw badInput(fmt::format("{} (line {})", file, problem.mark.line + 1), "is nested too deeply",
                   "Check that it is the right file");
  } catch (const YAML::Exception& problem) {
    if (hasTab(text, problem.mark.line))
      throw badInput(fmt::format("{} (line {})", file, problem.mark.line + 1),
                     "is not valid YAML: the line, or the one before it, is indented with a tab",
                     "Indent with spaces");
    throw badInput(fmt::format("{} (line {})", file, problem.mark.line + 1),
                   fmt::format("is not valid YAML: {}", problem.msg),
                   "Correct the line, or the one before it");
  }
}

bool YamlNode::isMap() const {
  return node_->yaml.IsMap();
}
bool YamlNode::isSequence() const {
  return node_->yaml.IsSequence();
}
bool YamlNode::isScalar() const {
  return node_->yaml.IsScalar();
}
bool YamlNode::isNull() const {
  return node_->yaml.IsNull();
}

bool YamlNode::isQuoted() const {
  return isScalar() && node_->yaml.Tag() == "!";
}

std::string YamlNode::place() const {
  if (key_.empty()) return file_;
  return node_->line > 0 ? fmt::format("{}: {} (line {})", file_, key_, node_->line)
                         : fmt::format("{}: {}", file_, key_);
}

CalibrationError YamlNode::error(std::string problem, std::string advice) const {
  return badInput(place(), std::move(problem), std::move(advice));
}

YamlNode YamlNode::child(const std::string& name, const Entry& entry) const {
  const bool index = name.starts_with('[');
  YamlNode found(std::make_shared<const Node>(Node{entry}), file_,
                 key_.empty() || index ? key_ + name : key_ + "." + name);
  requirePlain(found.node_->yaml, found.place());
  return found;
}

const YamlNode::Entry* YamlNode::entry(const std::string& name) const {
  if (!isMap()) throw error("must be a map of keys and values", "Write it as 'key: value' lines");
  if (!node_->entries) {
    std::unordered_map<std::string, Entry> entries;
    for (const auto& each : node_->yaml) {
      if (!each.first.IsScalar()) continue;
      const Entry here{each.second, each.first.Mark().line + 1};
      const auto [first, is_new] = entries.try_emplace(each.first.Scalar(), here);
      if (!is_new)
        throw child(first->first, here)
            .error(fmt::format("occurs twice, first in line {}", first->second.line), "Remove one of them");
    }
    node_->entries = std::move(entries);
  }
  const auto found = node_->entries->find(name);
  return found == node_->entries->end() ? nullptr : &found->second;
}

std::vector<std::string> YamlNode::keys() const {
  entry("");
  std::vector<std::string> names;
  for (const auto& each : node_->yaml) {
    names.push_back(each.first.IsScalar() ? each.first.Scalar() : "");
    if (names.back().empty()) throw error("has a key that is not a plain word");
    requirePlain(names.back(), place(), "a key");
  }
  return names;
}

void YamlNode::allowOnly(std::initializer_list<const char*> known) const {
  allowOnly(std::vector<std::string>(known.begin(), known.end()));
}

void YamlNode::allowOnly(const std::vector<std::string>& known) const {
  for (const std::string& name : keys())
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw(*this)[name].error("unknown key", nameAdvice(name, known));
}

std::optional<YamlNode> YamlNode::find(const std::string& name) const {
  const Entry* const found = entry(name);
  return found == nullptr ? std::nullopt : std::optional(child(name, *found));
}

bool YamlNode::has(const std::string& name) const {
  return entry(name) != nullptr;
}

YamlNode YamlNode::operator[](const std::string& name) const {
  if (const auto found = find(name)) return *found;
  throw child(name, Entry{}).error("is missing", fmt::format("Add '{}'", name));
}

std::vector<YamlNode> YamlNode::items() const {
  if (!isSequence()) throw error("must be a list", "Write it as [a, b]");
  std::vector<YamlNode> all;
  for (const auto& entry : node_->yaml)
    all.push_back(child(fmt::format("[{}]", all.size()), Entry{entry, entry.Mark().line + 1}));
  return all;
}

std::string YamlNode::text() const {
  std::string text = anyText();
  requirePlain(text, place(), "the text");
  return text;
}

std::string YamlNode::anyText() const {
  if (!isScalar()) throw error(isNull() ? "has no value" : "must be one value, not a list or map");
  return node_->yaml.Scalar();
}

double YamlNode::real() const {
  constexpr double kAny = std::numeric_limits<double>::max();
  return real(-kAny, kAny, "");
}

double YamlNode::real(double minimum, double maximum, const char* unit) const {
  return detail::parseReal(place(), text(), minimum, maximum, unit);
}

int YamlNode::integer(int minimum, int maximum) const {
  return static_cast<int>(detail::parseInteger(place(), text(), minimum, maximum, ""));
}

std::int64_t YamlNode::nanoseconds() const {
  using Limits = std::numeric_limits<std::int64_t>;
  return detail::parseInteger(place(), text(), Limits::min(), Limits::max(), "ns");
}

std::vector<double> YamlNode::reals() const {
  std::vector<double> values;
  for (const YamlNode& item : items()) values.push_back(item.real());
  return values;
}

std::vector<double> YamlNode::reals(std::size_t count) const {
  std::vector<double> values = reals();
  if (values.size() != count) throw error(fmt::format("has {} numbers, {} are needed", values.size(), count));
  return values;
}

std::size_t YamlNode::choice(std::initializer_list<const char*> words) const {
  return choice(std::span<const char* const>(words.begin(), words.size()));
}

std::size_t YamlNode::choice(std::span<const char* const> words) const {
  return detail::parseChoice(place(), text(), words);
}

namespace {

// Words that YAML 1.1 or 1.2 reads as a truth value or as nothing.
bool hasOtherMeaning(std::string_view word) {
  std::string lower(word);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  constexpr std::string_view kWords[] = {"true", "false", "null", "yes", "no", "on", "off", "y", "n"};
  return std::find(std::begin(kWords), std::end(kWords), lower) != std::end(kWords);
}

}  // namespace

std::string yamlText(std::string_view text) {
  const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '/' || c == '.'; };
  const bool word = !text.empty() && std::all_of(text.begin(), text.end(), plain) &&
                    (std::isalpha(static_cast<unsigned char>(text[0])) || text[0] == '/');
  if (word && !hasOtherMeaning(text)) return std::string(text);
  std::string quoted;
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? "\\n" : std::string(1, c);
  }
  return '"' + visible(quoted) + '"';
}

std::string yamlLine(std::string_view text) {
  return yamlText(visible(text));
}

}  // namespace evical
