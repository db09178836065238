#include "core/foreign/xml_element.h"

#include "core/base/error.h"
#include "core/foreign/read_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>

namespace evical {
namespace {

class XmlParser {
 public:
  XmlParser(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

  XmlElement document() {
    skipBetween();
    XmlElement root = element("", 0);
    skipBetween();
    if (at_ < text_.size()) fail("continues after the root element's end");
    return root;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    const auto lines = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    throw badInput(fmt::format("{} (line {})", file_, lines + 1), "is not XML: " + problem);
  }

  bool startsWith(std::string_view what) const {
    return std::string_view(text_).substr(at_).starts_with(what);
  }

  bool take(std::string_view what) {
    if (!startsWith(what)) return false;
    at_ += what.size();
    return true;
  }

  void expect(std::string_view what) {
    if (!take(what)) fail(fmt::format("'{}' is missing", what));
  }

  void skipBlanks() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  }

  // Text up to `end`, which is skipped.
  std::string until(std::string_view end) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string::npos) fail(fmt::format("'{}' is missing", end));
    std::string taken = text_.substr(at_, found - at_);
    at_ = found + end.size();
    return taken;
  }

  // Skips blanks, comments and the declaration.
  void skipBetween() {
    for (skipBlanks();; skipBlanks()) {
      if (take("<!--")) {
        if (until("-->").find("--") != std::string::npos) fail("a comment has two hyphens");
      } else if (take("<?")) {
        until("?>");
      } else {
        return;
      }
    }
  }

  std::string word() {
    const std::size_t begin = at_;
    const auto goes_on = [](unsigned char c) {
      return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == ':';
    };
    while (at_ < text_.size() && goes_on(static_cast<unsigned char>(text_[at_]))) ++at_;
    if (at_ == begin) fail("a name is missing");
    return text_.substr(begin, at_ - begin);
  }

  void attributesOf(XmlElement& element) {
    for (skipBlanks(); at_ < text_.size() && !startsWith("/") && !startsWith(">"); skipBlanks()) {
      const std::string name = word();
      expect("=");
      const char quote = at_ < text_.size() ? text_[at_++] : ' ';
      if (quote != '"' && quote != '\'') fail("an attribute has no quotes");
      if (!element.attributes.emplace(name, until(std::string_view(&quote, 1))).second)
        fail(fmt::format("{} occurs twice", name));
    }
  }

  XmlElement element(const std::string& above, int depth) {
    constexpr int kDeepest = 100;
    if (depth > kDeepest) fail("is nested too deeply");
    expect("<");
    XmlElement element;
    element.name = word();
    const std::string path = above.empty() ? element.name : above + "." + element.name;
    const auto lines = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(at_), '\n');
    element.place = fmt::format("{}: {} (line {})", file_, path, lines + 1);
    attributesOf(element);
    if (take("/>")) return element;
    expect(">");
    for (skipBetween(); !startsWith("</"); skipBetween())
      element.children.push_back(this->element(path, depth + 1));
    expect("</");
    if (word() != element.name) fail(fmt::format("{} does not end", element.name));
    expect(">");
    return element;
  }

  std::string text_, file_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<const XmlElement*> XmlElement::all(const std::string& called) const {
  std::vector<const XmlElement*> found;
  for (const XmlElement& child : children)
    if (child.name == called) found.push_back(&child);
  return found;
}

const XmlElement& XmlElement::one(const std::string& called) const {
  const std::vector<const XmlElement*> found = all(called);
  if (found.empty()) throw badInput(place, fmt::format("has no element {}", called));
  return *found.front();
}

const std::string& XmlElement::attribute(const std::string& called) const {
  const auto found = attributes.find(called);
  if (found == attributes.end()) throw badInput(place, fmt::format("has no attribute {}", called));
  return found->second;
}

XmlElement readXml(const std::filesystem::path& file) {
  return XmlParser(textOf(file), file.string()).document();
}

}  // namespace evical
