// Sinks for texts that are too large for memory: passed on piece by piece.
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
