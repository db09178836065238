#include "core/foreign/opencv_file.h"

#include "core/foreign/read_numbers.h"
#include "core/foreign/xml_element.h"

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/base/yaml_node.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

namespace evical {

struct OpencvNode::Value {
  enum class Kind { Nothing, Number, Text, List, Map };
  Kind kind = Kind::Nothing;
  std::string text = {};  // also a number's
  std::vector<std::pair<std::string, Value>> below = {};

  const Value* at(const std::string& key) const {
    const auto found =
        std::ranges::find_if(below, [&](const auto& each) { return kind == Kind::Map && each.first == key; });
    return found == below.end() || found->second.kind == Kind::Nothing ? nullptr : &found->second;
  }
};

namespace {

// OpenCV's types of elements, and the range of the whole ones.
struct ElementType {
  char name;
  double least, most;
};
template <class Number>
constexpr ElementType wholeType(char name) {
  using Limits = std::numeric_limits<Number>;
  return {name, static_cast<double>(Limits::min()), static_cast<double>(Limits::max())};
}
constexpr std::array kWholeTypes = {wholeType<std::uint8_t>('u'), wholeType<std::int8_t>('c'),
                                    wholeType<std::uint16_t>('w'), wholeType<std::int16_t>('s'),
                                    wholeType<std::int32_t>('i')};

bool isWhole(std::string_view number) {
  if (number.starts_with('-') || number.starts_with('+')) number.remove_prefix(1);
  return !number.empty() && number.find_first_not_of("0123456789") == std::string_view::npos;
}

// OpenCV writes ".Inf" and ".NaN"; real() refuses them.
bool looksLikeNumber(std::string_view text) {
  return realFrom(text) || text == ".Inf" || text == "-.Inf" || text == ".NaN" || isWhole(text);
}

}  // namespace

// Converts documents to values. Aliases in YAML can make a small file a large tree.
struct OpencvNode::Reading {
  static constexpr int kDeepest = 50;
  std::string file;
  std::size_t left = 200'000;

  void count(int depth) {
    if (depth > kDeepest) throw badInput(file, "is nested too deeply for a calibration");
    if (left-- == 0) throw badInput(file, "has too many values for a calibration");
  }

  static Value scalar(std::string text, bool quoted) {
    const bool number = !quoted && looksLikeNumber(text);
    return {number ? Value::Kind::Number : Value::Kind::Text, std::move(text)};
  }

  Value of(const YamlNode& node, int depth) {
    count(depth);
    if (node.isNull()) return {};
    if (node.isScalar()) return scalar(node.text(), node.isQuoted());
    Value value{node.isMap() ? Value::Kind::Map : Value::Kind::List};
    if (node.isMap())
      for (const std::string& key : node.keys()) value.below.emplace_back(key, of(node[key], depth + 1));
    else
      for (const YamlNode& item : node.items()) value.below.emplace_back("", of(item, depth + 1));
    return value;
  }

  Value of(const XmlElement& element, int depth) {
    count(depth);
    if (element.children.empty()) return ofText(element.text);
    const bool list = element.children.front().name == "_";
    Value value{list ? Value::Kind::List : Value::Kind::Map};
    std::map<std::string, const XmlElement*> seen;
    for (const XmlElement& child : element.children) {
      if ((child.name == "_") != list) throw badInput(child.place, "is in a list, but has a name");
      const auto [first, is_new] = seen.emplace(child.name, &child);
      if (!list && !is_new)
        throw badInput(child.place, fmt::format("occurs twice, first in line {}", first->second->line),
                       "Remove one of them");
      value.below.emplace_back(list ? "" : child.name, of(child, depth + 1));
    }
    return value;
  }

  // Words between blanks are a list; quotes keep a text with blanks together.
  Value ofText(std::string_view text) {
    constexpr std::string_view kBlanks = " \t\r\n";
    Value list{Value::Kind::List};
    for (std::size_t at = text.find_first_not_of(kBlanks); at != std::string_view::npos;
         at = text.find_first_not_of(kBlanks, at)) {
      count(0);
      const bool quoted = text[at] == '"';
      const std::size_t begin = at + (quoted ? 1 : 0);
      const std::size_t end =
          std::min(quoted ? text.find('"', begin) : text.find_first_of(kBlanks, begin), text.size());
      list.below.emplace_back("", scalar(std::string(text.substr(begin, end - begin)), quoted));
      at = std::min(end + (quoted ? 1 : 0), text.size());
    }
    if (list.below.empty()) return {};
    return list.below.size() == 1 ? std::move(list.below.front().second) : std::move(list);
  }
};

OpencvNode::OpencvNode(std::shared_ptr<const Value> value, std::string file, std::string key)
    : value_(std::move(value)), file_(std::move(file)), key_(std::move(key)) {}

// Keeps the whole document.
std::shared_ptr<const OpencvNode::Value> OpencvNode::child(const Value& value) const {
  return {value_, &value};
}

bool OpencvNode::has(const std::string& key) const {
  return value_->at(key) != nullptr;
}

OpencvNode OpencvNode::operator[](const std::string& key) const {
  const std::string whole = key_.empty() ? key : key_ + "." + key;
  const Value* const found = value_->at(key);
  if (found == nullptr) throw badInput(fmt::format("{}: {}", file_, whole), "is missing");
  return {child(*found), file_, whole};
}

double OpencvNode::number() const {
  if (value_->kind != Value::Kind::Number) fail("is not a number for OpenCV");
  if (isWhole(value_->text)) return integer();
  const std::optional<double> value = realFrom(value_->text);
  if (!value) fail("is not a finite number");
  return *value;
}

int OpencvNode::integer() const {
  if (value_->kind != Value::Kind::Number || !isWhole(value_->text)) fail("is not a whole number for OpenCV");
  const std::string_view text = std::string_view(value_->text).substr(value_->text.starts_with('+') ? 1 : 0);
  int whole = 0;
  if (std::from_chars(text.data(), text.data() + text.size(), whole).ec != std::errc{})
    fail("does not fit in the 32 bits of OpenCV's whole numbers");
  return whole;
}

std::string OpencvNode::text() const {
  if (!isText()) fail("is not a text for OpenCV");
  return value_->text;
}

bool OpencvNode::isText() const {
  return value_->kind == Value::Kind::Text;
}

std::size_t OpencvNode::size() const {
  return value_->below.size();
}

std::vector<double> OpencvNode::numbers(std::size_t count) const {
  if (value_->kind != Value::Kind::List) fail("is not a list");
  if (size() != count) fail(fmt::format("has {} numbers, {} are needed", size(), count));
  std::vector<double> values;
  for (const auto& [name, item] : value_->below)
    values.push_back(OpencvNode(child(item), file_, key_).number());
  return values;
}

Eigen::MatrixXd OpencvNode::rows(std::size_t rows, std::size_t cols) const {
  if (value_->kind != Value::Kind::List || size() != rows)
    fail(fmt::format("is not a list of {} rows", rows));
  std::vector<double> all;
  for (const auto& [name, row] : value_->below)
    for (const double value : OpencvNode(child(row), file_, key_).numbers(cols)) all.push_back(value);
  return matrixFrom(all, static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(cols));
}

// A matrix's elements, rounded as OpenCV does. Numbers that its type cannot hold are refused: OpenCV changes
// them.
std::vector<double> OpencvNode::elements() const {
  for (const char* const key : {"rows", "cols", "dt", "data"})
    if (!has(key)) fail(fmt::format("is not a matrix for OpenCV: it has no {}", key));
  const int rows = (*this)["rows"].integer(), cols = (*this)["cols"].integer();
  const std::string type = (*this)["dt"].text();
  const auto* const whole = std::ranges::find_if(
      kWholeTypes, [&](const ElementType& each) { return type == std::string(1, each.name); });
  if (type != "f" && type != "d" && whole == kWholeTypes.end())
    (*this)["dt"].fail("is not a type of single numbers: f, d, u, c, w, s or i");
  const OpencvNode data = (*this)["data"];
  constexpr int kMax = 10'000;
  if (rows < 1 || cols < 1 || rows > kMax || cols > kMax) fail("is not a matrix of numbers");
  const auto count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
  const bool single = count == 1 && data.value_->kind == Value::Kind::Number;  // in XML
  std::vector<double> values = single ? std::vector{data.number()} : data.numbers(count);
  for (double& value : values) {
    if (type == "f") value = static_cast<double>(static_cast<float>(value));
    if (whole != kWholeTypes.end() &&
        (value != std::floor(value) || value < whole->least || value > whole->most))
      data.fail(fmt::format("has {}, which does not fit in whole numbers of the type {}", value, type));
  }
  return values;
}

Eigen::MatrixXd OpencvNode::matrix(int rows, int cols, const std::string& types) const {
  const std::vector<double> values = elements();
  if ((*this)["rows"].integer() != rows || (*this)["cols"].integer() != cols)
    fail(fmt::format("is {} x {}, but must be {} x {}", (*this)["rows"].integer(), (*this)["cols"].integer(),
                     rows, cols));
  if (types.find((*this)["dt"].text()) == std::string::npos) fail(fmt::format("must have dt {}", types));
  return matrixFrom(values, rows, cols);
}

std::vector<double> OpencvNode::matrixNumbers() const {
  return value_->kind == Value::Kind::List ? numbers(size()) : elements();
}

int OpencvNode::side_px() const {
  const double side_px = number();
  if (!isSide_px(side_px)) fail("must be a whole number of pixels above 0");
  return static_cast<int>(side_px);
}

Resolution OpencvNode::resolution() const {
  numbers(2);
  const auto side_px = [&](std::size_t i) {
    return OpencvNode(child(value_->below[i].second), file_, key_).side_px();
  };
  return {side_px(0), side_px(1)};
}

std::vector<std::string> OpencvNode::keys() const {
  std::vector<std::string> names;
  if (value_->kind == Value::Kind::Map)
    for (const auto& [name, item] : value_->below) names.push_back(name);
  return names;
}

std::string OpencvNode::place() const {
  return key_.empty() ? file_ : fmt::format("{}: {}", file_, key_);
}

void OpencvNode::fail(const std::string& problem) const {
  throw badInput(place(), problem);
}

OpencvFile::OpencvFile(const std::filesystem::path& file) : file_(file.string()) {
  const std::string text = textOf(file);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) throw badInput(file_, "is empty");
  OpencvNode::Reading reading{file_};
  const bool xml = text[begin] == '<';
  root_ = std::make_shared<const OpencvNode::Value>(xml ? reading.of(readXml(file, XmlText::Kept), 0)
                                                        : reading.of(YamlNode::parse(text, file_), 0));
}

namespace {

bool sameNumbers(CameraIntrinsics a, const CameraIntrinsics& b) {
  a.resolution_px = b.resolution_px;
  return a == b;
}

// Adds metres and radians: it only distinguishes cameras.
double distance(const RigidTransform& a, const RigidTransform& b) {
  return (a.translation_m - b.translation_m).norm() + a.rotation.angularDistance(b.rotation);
}

ReadCamera placed(const ReadCamera& camera, const CameraIntrinsics& lens,
                  const RigidTransform& left_from_camera) {
  ReadCamera read;
  read.name = camera.name;
  read.lens = lens;
  read.frame_from_camera = left_from_camera;
  return read;
}

}  // namespace

ReadFile pairAmong(std::span<const ReadCamera> cameras, const PairAsRead& pair,
                   const std::filesystem::path& path) {
  const ReadCamera* best_left = nullptr;
  const ReadCamera* best_right = nullptr;
  double nearest = std::numeric_limits<double>::infinity();
  for (const ReadCamera& left : cameras)
    for (const ReadCamera& right : cameras) {
      if (&left == &right || !sameNumbers(*left.lens, pair.left) || !sameNumbers(*right.lens, pair.right))
        continue;
      const double off =
          distance(inverse(*right.frame_from_camera) * *left.frame_from_camera, pair.right_from_left);
      if (!(off < nearest)) continue;
      nearest = off;
      best_left = &left;
      best_right = &right;
    }
  if (best_left == nullptr)
    throw badInput(path.string(), "left or right has a lens that no camera's own file has");
  ReadFile file{
      path,
      {placed(*best_left, pair.left, {}), placed(*best_right, pair.right, inverse(pair.right_from_left))}};
  file.about_first_camera = true;
  return file;
}

}  // namespace evical
