#include "app/option_value.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <sstream>

namespace evical {

// CLI11 combines type and checks: "TEXT:{dark,bright}", "INT:INT in [1 - 256]".
OptionValue valueOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  OptionValue value{type.substr(0, type.find(':')), "", {}};
  const std::size_t open = type.find('{'), close = type.rfind('}');
  if (open != std::string::npos && close != std::string::npos) {
    std::istringstream words(type.substr(open + 1, close - open - 1));
    for (std::string word; std::getline(words, word, ',');) value.choices.push_back(word);
    value.word = fmt::format("{}", fmt::join(value.choices, "|"));
  }
  const std::size_t begin = type.find(" in ["), middle = type.find(" - ", begin), end = type.find(']', begin);
  if (begin != std::string::npos && middle != std::string::npos && end != std::string::npos)
    value.range = fmt::format("{} to {}", type.substr(begin + 5, middle - begin - 5),
                              type.substr(middle + 3, end - middle - 3));
  return value;
}

}  // namespace evical
