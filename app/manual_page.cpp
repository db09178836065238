#include "app/manual_page.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace evical {
namespace {

// Escapes the special characters of roff; hyphens become minus signs, so that options can be copied.
std::string escaped(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    switch (letter) {
      case '\\':
        result += "\\e";
        break;
      case '-':
        result += "\\-";
        break;
      case '`':
        result += "\\(ga";
        break;
      case '\'':
        result += "\\(aq";
        break;
      case '^':
        result += "\\(ha";
        break;
      case '~':
        result += "\\(ti";
        break;
      default:
        result += letter;
    }
  }
  return result;
}

// A line of text; a leading full stop is escaped, as it would begin a request.
std::string textLine(std::string_view line) {
  return (line.starts_with('.') ? "\\&" : "") + escaped(line) + "\n";
}

std::string upperCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return std::toupper(letter); });
  return text;
}

// Lines that begin with a blank are a table and are not filled; others are.
std::string paragraphs(std::string_view text) {
  std::string result;
  bool in_table = false;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    const bool is_table = line.starts_with(' ');
    if (is_table != in_table) result += is_table ? ".PP\n.nf\n" : ".fi\n.PP\n";
    in_table = is_table;
    result += line.empty() ? ".PP\n" : textLine(line);
  }
  return result + (in_table ? ".fi\n" : "");
}

std::string entry(const ManualEntry& entry) {
  std::string names = escaped(entry.names);
  for (std::size_t comma = names.find(','); comma != std::string::npos; comma = names.find(',', comma + 2))
    names.replace(comma, 1, ", ");
  std::string text = ".TP\n\\fB" + names + "\\fR";
  if (!entry.value.empty()) text += " \\fI" + escaped(entry.value) + "\\fR";
  return text + "\n" + (entry.text.empty() ? "\\&\n" : paragraphs(entry.text));
}

std::string seeAlso(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names)
    text += ".BR " + escaped(name) + " (1)" + (&name == &names.back() ? "" : ",") + "\n";
  return text;
}

}  // namespace

std::string sentence(std::string text) {
  if (!text.empty() && text.back() != '.' && text.back() != ':') text += '.';
  return text;
}

std::string manualPage(const ManualPage& page, const std::string& version) {
  std::string text = ".TH " + upperCase(escaped(page.name)) + " 1 \"\" \"evical " + version + "\"\n";
  text += ".SH NAME\n" + escaped(page.name) + " \\- " + escaped(page.summary) + "\n";
  text += ".SH SYNOPSIS\n" + textLine(page.synopsis);
  for (const ManualSection& section : page.sections) {
    text += ".SH " + upperCase(section.title) + "\n" + paragraphs(section.text);
    for (const ManualEntry& option : section.entries) text += entry(option);
  }
  if (!page.see_also.empty()) text += ".SH SEE ALSO\n" + seeAlso(page.see_also);
  return text;
}

}  // namespace evical
