#include "core/base/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace evical {

int editDistance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int change = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

std::string nearestName(std::string_view name, std::span<const std::string> known) {
  std::string nearest;
  int least = 0;
  for (const std::string& candidate : known) {
    const int distance = editDistance(name, candidate);
    if (2 * distance > static_cast<int>(std::max(name.size(), candidate.size()))) continue;
    if (nearest.empty() || distance < least) {
      nearest = candidate;
      least = distance;
    }
  }
  return nearest;
}

std::string nameAdvice(std::string_view name, std::span<const std::string> known) {
  if (known.empty()) return {};
  const std::string nearest = nearestName(name, known);
  if (!nearest.empty()) return fmt::format("Did you mean '{}'?", nearest);
  return fmt::format("Known names: {}", joined(known));
}

std::string joined(std::span<const std::string> words) {
  std::string text;
  for (const std::string& word : words) text += text.empty() ? word : ", " + word;
  return text;
}

}  // namespace evical
