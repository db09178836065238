#include "core/foreign/xml_element.h"

#include "core/base/error.h"
#include "core/foreign/read_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>
#include <utility>

namespace evical {
namespace {

constexpr std::pair<std::string_view, char> kEntities[] = {
    {"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}};

class XmlParser {
 public:
  XmlParser(std::string text, std::string file, XmlText kept)
      : text_(std::move(text)), file_(std::move(file)), kept_(kept) {}

  XmlElement document() {
    skipBetween();
    XmlElement root = element("", 0);
    skipBetween();
    if (at_ < text_.size()) fail("continues after the root element's end");
    return root;
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) {
    throw badInput(fmt::format("{} (line {})", file_, line()), problem);
  }
  [[noreturn]] void fail(const std::string& problem) { refuse("is not XML: " + problem); }

  // Counts on from the last call.
  int line() {
    const auto begin = text_.begin();
    line_ += static_cast<int>(std::count(begin + static_cast<std::ptrdiff_t>(counted_to_),
                                         begin + static_cast<std::ptrdiff_t>(at_), '\n'));
    counted_to_ = at_;
    return line_;
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
        if (startsWith("<!DOCTYPE"))
          refuse("has a document type, which is not read: it may name other files. Remove it");
        return;
      }
    }
  }

  // Text up to the next element, with the entities of XML itself.
  std::string plainText() {
    const std::size_t end = std::min(text_.find('<', at_), text_.size());
    std::string plain;
    while (at_ < end) {
      if (text_[at_] != '&') {
        plain += text_[at_++];
        continue;
      }
      const std::string name = until(";");
      const auto* const known =
          std::ranges::find_if(kEntities, [&](const auto& entity) { return name.substr(1) == entity.first; });
      if (known == std::end(kEntities)) refuse(fmt::format("has the entity {};, which is not read", name));
      plain += known->second;
    }
    return plain;
  }

  std::string word() {
    const std::size_t begin = at_;
    const auto goes_on = [](unsigned char c) {
      return std::isalnum(c) || c == '_' || c == '-' || c == '.' || c == ':';
    };
    while (at_ < text_.size() && goes_on(static_cast<unsigned char>(text_[at_]))) ++at_;
    constexpr std::size_t kLongestName = 200;
    if (at_ == begin) fail("a name is missing");
    if (at_ - begin > kLongestName) fail("a name is too long");
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
    constexpr int kMaxElements = 100'000;
    if (depth > kDeepest) refuse("is nested too deeply");
    if (++elements_ > kMaxElements) refuse("has too many elements");
    expect("<");
    XmlElement element;
    element.name = word();
    constexpr std::size_t kLongestPath = 300;
    const bool root = above.empty() || above.size() > kLongestPath;
    const std::string path = root ? element.name : above + "." + element.name;
    element.line = line();
    element.place = fmt::format("{}: {} (line {})", file_, path, element.line);
    attributesOf(element);
    if (take("/>")) return element;
    expect(">");
    for (skipBetween(); !startsWith("</"); skipBetween()) {
      if (kept_ == XmlText::Kept && at_ < text_.size() && !startsWith("<"))
        element.text += plainText();
      else
        element.children.push_back(this->element(path, depth + 1));
    }
    expect("</");
    if (word() != element.name) fail(fmt::format("{} does not end", element.name));
    expect(">");
    return element;
  }

  std::string text_, file_;
  XmlText kept_;
  std::size_t at_ = 0, counted_to_ = 0;
  int line_ = 1, elements_ = 0;
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

XmlElement readXml(const std::filesystem::path& file, XmlText text) {
  return XmlParser(textOf(file), file.string(), text).document();
}

}  // namespace evical
