#include "core/report/csv_text.h"

namespace evical {

std::string quotedCsv(const std::string& text) {
  std::string safe = "\"";
  for (const char c : text) {
    if (c == '"') safe += '"';
    safe += c == '\n' || c == '\r' ? ' ' : c;
  }
  return safe + "\"";
}

std::string csvWord(const std::string& text) {
  return text.find_first_of(",\"\n\r") == std::string::npos ? text : quotedCsv(text);
}

}  // namespace evical
