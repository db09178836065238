#include "core/base/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <system_error>
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

std::string fitForFolder(std::string name) {
  for (char& letter : name)
    if (std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '-' && letter != '_' &&
        letter != '.')
      letter = '_';
  return name.empty() || name.find_first_not_of('.') == std::string::npos ? "recording" : name;
}

namespace {

void number(std::vector<std::string>& names) {
  std::set<std::string> taken;
  for (std::string& name : names) {
    const std::string stem = name;
    for (int k = 2; !taken.insert(name).second; ++k) name = stem + "_" + std::to_string(k);
  }
}

}  // namespace

std::vector<std::string> foldersOfNames(std::span<const std::string> names) {
  std::vector<std::string> folders(names.begin(), names.end());
  for (std::string& folder : folders)
    if (folder.empty() || folder == "." || folder == ".." || folder.find('/') != std::string::npos)
      folder = fitForFolder(folder);
  number(folders);
  return folders;
}

std::vector<std::string> distinctNames(std::span<const std::filesystem::path> paths) {
  std::vector<std::string> by_file, by_folder;
  for (const std::filesystem::path& given : paths) {
    std::error_code error;
    std::filesystem::path path = std::filesystem::weakly_canonical(given, error);
    if (error || path.empty()) path = given;
    by_file.push_back(fitForFolder(path.stem().string()));
    by_folder.push_back(fitForFolder(path.parent_path().filename().string()));
  }
  const auto differ = [](const std::vector<std::string>& names) {
    return std::set<std::string>(names.begin(), names.end()).size() == names.size();
  };
  std::vector<std::string> names = differ(by_file) || !differ(by_folder) ? by_file : by_folder;
  number(names);
  return names;
}

}  // namespace evical
