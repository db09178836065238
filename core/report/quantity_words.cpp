#include "core/report/quantity_words.h"

#include "core/data/quantity.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace evical {
namespace {

struct KnownName {
  std::string name, title;
};

// Longer names first: "slow_edge_lead" before "edge_lead".
const std::vector<KnownName>& knownNames() {
  static const std::vector<KnownName> known = [] {
    std::vector<KnownName> names = {{"focal_length", "focal length"},
                                    {"principal_point", "principal point"},
                                    {"distortion", "distortion"},
                                    {"direction", "direction"},
                                    {"norm", "norm"}};
    const auto add = [&](const auto& row) {
      const bool matrix = row.info.shape == QuantityShape::UpperTriangle;
      names.push_back(
          {row.info.name, std::string(row.info.title) + (matrix ? " scale and misalignment" : "")});
    };
    forEachQuantity(kCameraQuantities, add);
    forEachQuantity(kImuQuantities, add);
    forEachQuantity(kBoardQuantities, add);
    std::stable_sort(names.begin(), names.end(),
                     [](const KnownName& a, const KnownName& b) { return a.name.size() > b.name.size(); });
    return names;
  }();
  return known;
}

std::string spaced(std::string_view text) {
  std::string words(text);
  for (char& letter : words)
    if (letter == '_' || letter == '.') letter = ' ';
  return words;
}

// Where `quantity` stands in `name`: behind a dot, and at the end or before another one.
std::size_t placeOf(const std::string& quantity, const std::string& name) {
  const std::string behind_dot = "." + quantity;
  const std::size_t at = name.rfind(behind_dot);
  if (at == std::string::npos) return at;
  const std::size_t end = at + behind_dot.size();
  return end == name.size() || name[end] == '.' ? at : std::string::npos;
}

}  // namespace

QuantityWords quantityWords(const std::string& name) {
  const std::string bare = name.substr(0, name.find(" ["));
  for (const KnownName& known : knownNames()) {
    const std::size_t at = placeOf(known.name, bare);
    if (at == std::string::npos) continue;
    const std::size_t end = at + 1 + known.name.size();
    return {bare.substr(0, at), known.title, end < bare.size() ? spaced(bare.substr(end + 1)) : ""};
  }
  const std::size_t dot = bare.find('.');
  if (dot == std::string::npos) return {"", spaced(bare), ""};
  return {bare.substr(0, dot), spaced(bare.substr(dot + 1)), ""};
}

std::string quantitySentence(const QuantityWords& words) {
  std::string text = words.sensor.empty() ? words.quantity : words.sensor + ": " + words.quantity;
  return words.part.empty() ? text : text + " " + words.part;
}

}  // namespace evical
