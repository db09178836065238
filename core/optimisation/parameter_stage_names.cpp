#include "core/optimisation/parameter_stage_names.h"

#include <algorithm>
#include <string_view>

namespace evical {
namespace {

std::string wordsOf(const QuantityInfo& info) {
  std::string_view title = info.title;
  if (info.shape == QuantityShape::UpperTriangle) return std::string(title) + " scale and misalignment";
  constexpr std::string_view kAsNumbers = " vector";
  if (title.ends_with(kAsNumbers)) title.remove_suffix(kAsNumbers.size());
  switch (info.owner) {
    case QuantityOwner::Camera:
      return "camera " + std::string(title);
    case QuantityOwner::Imu:
      // The title without the name of one of the two sensors.
      if (title.starts_with("gyroscope") || title.starts_with("accelerometer")) return std::string(title);
      return "IMU " + std::string(title);
    case QuantityOwner::Board:
      return "board " + std::string(title);
    case QuantityOwner::Rig:
      break;
  }
  return std::string(title);
}

}  // namespace

std::vector<std::string> quantityWords(const std::vector<Quantity>& quantities) {
  std::vector<std::string> words;
  for (const Quantity& quantity : quantities) {
    std::string word = wordsOf(*quantity.info);
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(std::move(word));
  }
  return words;
}

std::vector<std::string> releasedWords(const std::vector<std::string>& now,
                                       const std::vector<std::string>& before) {
  std::vector<std::string> released;
  for (const std::string& word : now)
    if (std::find(before.begin(), before.end(), word) == before.end()) released.push_back(word);
  return released;
}

}  // namespace evical
