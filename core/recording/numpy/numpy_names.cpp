#include "core/recording/numpy/numpy_names.h"

#include "core/recording/column_guess.h"

#include <algorithm>
#include <cctype>
#include <iterator>

namespace evical::numpy {
namespace {

struct Spelling {
  std::string_view name;
  Part part;
};
constexpr Spelling kSpellings[] = {
    {"x", Part::X},
    {"xs", Part::X},
    {"x_pos", Part::X},  // N-ImageNet
    {"x_px", Part::X},
    {"x_coords", Part::X},
    {"y", Part::Y},
    {"ys", Part::Y},
    {"y_pos", Part::Y},
    {"y_px", Part::Y},
    {"y_coords", Part::Y},
    {"t", Part::Time},
    {"ts", Part::Time},
    {"timestamp", Part::Time},  // dv
    {"timestamps", Part::Time},
    {"time", Part::Time},
    {"times", Part::Time},
    {"stamp", Part::Time},
    {"stamps", Part::Time},
    {"p", Part::Polarity},
    {"ps", Part::Polarity},
    {"pol", Part::Polarity},
    {"pols", Part::Polarity},
    {"polarity", Part::Polarity},
    {"polarities", Part::Polarity},
    {"on", Part::Polarity},  // Event Stream
    {"xy", Part::Xy},        // EVIMO2
    {"xyp", Part::Xyp},
    {"t_offset", Part::TimeOffset},  // DSEC
    {"width", Part::Width},
    {"height", Part::Height},
};

bool takePart(std::string_view name, NamedPart& found) {
  const auto spelling = std::find_if(std::begin(kSpellings), std::end(kSpellings),
                                     [&](const Spelling& candidate) { return candidate.name == name; });
  if (spelling == std::end(kSpellings)) return false;
  found.part = spelling->part;
  found.rank = static_cast<std::size_t>(spelling - std::begin(kSpellings));
  return true;
}

// The whole name, or the part after one of its separators; the longest first.
bool takeName(std::string_view name, NamedPart& found) {
  if (takePart(name, found)) return true;
  for (std::size_t at = name.find_first_of("/_.- "); at != std::string_view::npos;
       at = name.find_first_of("/_.- ", at + 1)) {
    if (!takePart(name.substr(at + 1), found)) continue;
    found.group = name.substr(0, at);
    return true;
  }
  return false;
}

}  // namespace

NamedPart partNamed(std::string_view name) {
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  NamedPart found;
  if (const std::optional<std::int64_t> unit_ns = timeUnitOf(lower)) {
    std::string_view stem = std::string_view(lower).substr(0, lower.find_last_of("[(_ "));
    while (stem.ends_with(' ') || stem.ends_with('_')) stem.remove_suffix(1);
    if (takeName(stem, found) && found.part == Part::Time) {
      found.unit_ns = unit_ns;
      return found;
    }
    found = {};
  }
  takeName(lower, found);
  return found;
}

}  // namespace evical::numpy
