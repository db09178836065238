// Texts that are too large to be held in memory as a whole: handed on piece by piece.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace evical {

using TextSink = std::function<void(std::string_view piece)>;
using TextSource = std::function<void(const TextSink& sink)>;

inline std::string wholeText(const TextSource& source) {
  std::string text;
  source([&](std::string_view piece) { text += piece; });
  return text;
}

}  // namespace evical
