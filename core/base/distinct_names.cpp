#include "core/base/distinct_names.h"

#include <cctype>
#include <set>
#include <system_error>

namespace evical {

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
